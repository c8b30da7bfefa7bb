// Runs work in a child process, so that a parser that crashes on a bad file cannot crash the program.
#pragma once

#include <functional>
#include <string>

namespace merlin {

struct ApartResult {
  bool finished = false;  // false: it crashed, or took more processor time than it may
  std::string bytes;      // what the work returned
};

constexpr unsigned kApartCpuMax_s = 5;
constexpr unsigned long kApartMemoryMax_bytes =
    1ul << 30;  // allocating more throws std::bad_alloc there; not under sanitizers

// Runs the work in a forked child process. The child prints nothing and leaves nothing behind but the bytes that the
// work returns. The work must not throw. Throws MachineError if no process can be started.
ApartResult RunApart(const std::function<std::string()>& work);

}  // namespace merlin
