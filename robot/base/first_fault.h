// Runs one action after the other, whatever fails, and keeps the first failure. For the end of a run, where the car
// must be stopped and as many files as possible must be written.
#pragma once

#include <exception>

namespace merlin {

class FirstFault {
 public:
  // Calls action. Returns false if it threw. The first exception, of any type, is kept.
  template <class Action>
  bool Try(const Action& action) {
    try {
      action();
      return true;
    } catch (...) {
      if (!fault_) fault_ = std::current_exception();
      return false;
    }
  }
  // Null: nothing failed.
  const std::exception_ptr& get() const { return fault_; }

 private:
  std::exception_ptr fault_;
};

}  // namespace merlin
