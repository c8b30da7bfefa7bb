// The faults of one file, gathered so that a user sees them all at once: a line each.
#pragma once

#include <cstddef>
#include <string>

#include "robot/base/error.h"

namespace merlin {

class FaultList {
 public:
  // name: the file's name, for the last line, which counts the faults not shown; empty if each fault names the file
  // itself. shown: the largest number of faults shown.
  explicit FaultList(std::string name = {}, std::size_t shown = 12) : name_(std::move(name)), shown_(shown) {}

  // Runs one step of reading and keeps the InputError that it throws. Returns true if it threw none.
  template <class Step>
  bool Try(Step step) {
    try {
      step();
      return true;
    } catch (const InputError& error) {
      Add(error);
      return false;
    }
  }

  void Add(const InputError& fault) { Add(std::string(fault.what())); }
  void Add(const std::string& fault) {
    if (++count_ <= shown_) text_ += (text_.empty() ? "" : "\n") + fault;
    if (count_ > shown_)
      more_ = "\n" + name_ + (name_.empty() ? "and " : ": and ") + std::to_string(count_ - shown_) + " more";
  }

  bool empty() const { return count_ == 0; }
  std::size_t count() const { return count_; }

  // Throws one InputError with every fault, if there is any.
  void ThrowIfAny() const {
    if (!empty()) throw InputError(text_ + more_);
  }

 private:
  std::string name_, text_, more_;
  std::size_t shown_;
  std::size_t count_ = 0;
};

}  // namespace merlin
