// Runs a fuzz target without libFuzzer, always in the same way: driver COUNT [--expect-finding]. It tries COUNT inputs:
// random bytes, and mutations of the target's seeds. Each input ends at a page that cannot be read, so that reading one
// byte too far is found without a sanitizer. With --expect-finding the target must crash.
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <random>
#include <string>

#include "tests/fuzz/target.h"

namespace {

using merlin::Bytes;

constexpr std::size_t kLongest_bytes = 256;

// Memory that ends where a page begins that cannot be read.
class GuardedMemory {
 public:
  GuardedMemory() : page_(static_cast<std::size_t>(sysconf(_SC_PAGESIZE))) {
    void* memory = mmap(nullptr, 2 * page_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) std::abort();
    end_ = static_cast<std::uint8_t*>(memory) + page_;
    if (mprotect(end_, page_, PROT_NONE) != 0) std::abort();
  }
  const std::uint8_t* Place(const Bytes& bytes) {
    std::copy(bytes.begin(), bytes.end(), end_ - bytes.size());
    return end_ - bytes.size();
  }

 private:
  std::size_t page_;
  std::uint8_t* end_;
};

class Inputs {
 public:
  Bytes Next() {
    Bytes bytes = seeds_.empty() || Below(4) == 0 ? RandomBytes(Below(64)) : seeds_[Below(seeds_.size())];
    for (std::size_t i = Below(6); i-- > 0;) Mutate(bytes);
    if (bytes.size() > kLongest_bytes) bytes.resize(kLongest_bytes);
    return bytes;
  }

 private:
  std::size_t Below(std::size_t limit) { return generator_() % limit; }

  Bytes RandomBytes(std::size_t size) {
    Bytes bytes(size);
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(generator_());
    return bytes;
  }

  void Insert(Bytes& bytes, const Bytes& more) {
    bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(Below(bytes.size() + 1)), more.begin(), more.end());
  }

  void Mutate(Bytes& bytes) {
    switch (Below(6)) {
      case 0:
        return Insert(bytes, RandomBytes(1 + Below(4)));
      case 1:
        return Insert(bytes, Bytes(1 + Below(120), static_cast<std::uint8_t>(generator_())));
      case 2:
        return seeds_.empty() ? void() : Insert(bytes, seeds_[Below(seeds_.size())]);
      default:
        break;
    }
    if (bytes.empty()) return;
    const std::size_t at = Below(bytes.size());
    switch (Below(3)) {
      case 0:
        bytes[at] ^= static_cast<std::uint8_t>(1u << Below(8));
        break;
      case 1:
        bytes[at] = static_cast<std::uint8_t>(generator_());
        break;
      default:
        bytes.erase(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                    bytes.begin() + static_cast<std::ptrdiff_t>(at + 1 + Below(bytes.size() - at)));
    }
  }

  std::mt19937 generator_{20110501};
  std::vector<Bytes> seeds_ = merlin::fuzz::Seeds();
};

int RunAll(long count) {
  GuardedMemory memory;
  Inputs inputs;
  for (long i = 0; i < count; ++i) {
    const Bytes input = inputs.Next();
    LLVMFuzzerTestOneInput(memory.Place(input), input.size());
  }
  return 0;
}

// Runs in a child process, whose crash is the finding.
int ExpectFinding(long count) {
  const pid_t child = fork();
  if (child < 0) return 3;
  if (child == 0) {
    std::freopen("/dev/null", "w", stderr);
    std::_Exit(RunAll(count));
  }
  int status = 0;
  if (waitpid(child, &status, 0) != child) return 3;
  const bool found = WIFSIGNALED(status) || (WIFEXITED(status) && WEXITSTATUS(status) != 0);
  std::puts(found ? "the planted bug was found" : "the planted bug was NOT found");
  return found ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  const long count = argc > 1 ? std::strtol(argv[1], nullptr, 10) : 0;
  if (count <= 0) {
    std::fputs("usage: fuzz_TARGET COUNT [--expect-finding]\n", stderr);
    return 2;
  }
  return argc > 2 && std::string(argv[2]) == "--expect-finding" ? ExpectFinding(count) : RunAll(count);
}
