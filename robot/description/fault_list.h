// The faults of one file, gathered so that a person mends them in one go.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "robot/types/error.h"

namespace merlin {

class FaultList {
 public:
  void Add(const InputError& fault) {
    if (++count_ <= kShown) text_ += (text_.empty() ? "" : "\n") + std::string(fault.what());
  }
  // Does the work; the InputError that ends it is one fault more.
  template <class Work>
  void Try(Work work) {
    try {
      work();
    } catch (const InputError& fault) {
      Add(fault);
    }
  }
  std::size_t count() const { return count_; }
  // Throws one InputError with a line of text for each fault, the first twenty of them.
  void ThrowIfAny() const {
    if (count_ == 0) return;
    const std::string rest = count_ > kShown ? "\nand " + std::to_string(count_ - kShown) + " faults more" : "";
    throw InputError(text_ + rest);
  }

 private:
  static constexpr std::size_t kShown = 20;
  std::string text_;
  std::size_t count_ = 0;
};

}  // namespace merlin
