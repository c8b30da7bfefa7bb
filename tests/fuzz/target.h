// The parts of a fuzz target: libFuzzer's function, the seeds that every driver starts with, and a check that ends the
// program.
#pragma once

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "robot/protocol/bytes.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace merlin::fuzz {

// Well-formed inputs, to be mutated.
std::vector<Bytes> Seeds();

// Also checks in builds without assert.
inline void Expect(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "broken: %s\n", what);
  std::abort();
}

}  // namespace merlin::fuzz
