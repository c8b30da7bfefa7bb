#include "sim/tof/parallel.h"

#include <chrono>
#include <condition_variable>
#include <list>
#include <thread>
#include <vector>

namespace merlin::sim {
namespace {

// The loops of a frame follow each other closely, with a little serial work in between. A thread spins for this long
// before it sleeps, because waking takes as long as some loops and may put the thread onto the caller's core.
constexpr std::chrono::microseconds kLookOut{500};

template <class Condition>
void SpinUntil(const Condition& condition) {
  const auto end = std::chrono::steady_clock::now() + kLookOut;
  while (!condition() && std::chrono::steady_clock::now() < end) {
  }
}

struct Call {
  const std::function<void()>* work;
  int wanted;                   // threads that may still join
  std::atomic<int> running{0};  // that have joined and not returned
};

class Crew {
 public:
  void Work(int others, const std::function<void()>& work) {
    Call call{&work, others};
    {
      const std::lock_guard lock(mutex_);
      while (static_cast<int>(threads_.size()) < others)
        threads_.emplace_back([this](const std::stop_token& stop) { Wait(stop); });
      calls_.push_back(&call);
      waiting_ = static_cast<int>(calls_.size());
    }
    called_.notify_all();
    work();
    {
      const std::lock_guard lock(mutex_);
      calls_.remove(&call);  // threads that have not joined by now would find no work
      waiting_ = static_cast<int>(calls_.size());
    }
    SpinUntil([&] { return call.running == 0; });
    std::unique_lock lock(mutex_);
    returned_.wait(lock, [&] { return call.running == 0; });
  }

 private:
  void Wait(const std::stop_token& stop) {
    std::unique_lock lock(mutex_);
    while (called_.wait(lock, stop, [&] { return !calls_.empty(); })) {
      Call& call = *calls_.front();
      if (--call.wanted == 0) calls_.pop_front();
      waiting_ = static_cast<int>(calls_.size());
      ++call.running;
      lock.unlock();
      (*call.work)();
      lock.lock();
      if (--call.running == 0) returned_.notify_all();
      lock.unlock();
      SpinUntil([&] { return waiting_ > 0; });
      lock.lock();
    }
  }

  std::mutex mutex_;
  std::condition_variable_any called_, returned_;
  std::list<Call*> calls_;
  std::atomic<int> waiting_{0};        // calls that want more threads
  std::vector<std::jthread> threads_;  // last member: stopped before what they use is destroyed
};

}  // namespace

void OnSeveralThreads(int others, const std::function<void()>& work) {
  static Crew crew;
  crew.Work(others, work);
}

}  // namespace merlin::sim
