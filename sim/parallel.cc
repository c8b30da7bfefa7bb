#include "sim/parallel.h"

#include <condition_variable>
#include <list>
#include <thread>
#include <vector>

namespace merlin::sim {
namespace {

struct Call {
  const std::function<void()>* work;
  int wanted;       // threads that may still join
  int running = 0;  // that have joined and not returned
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
    }
    if (others == 1) called_.notify_one();
    else called_.notify_all();
    work();
    std::unique_lock lock(mutex_);
    calls_.remove(&call);  // whoever has not joined by now finds nothing left to do
    returned_.wait(lock, [&] { return call.running == 0; });
  }

 private:
  void Wait(const std::stop_token& stop) {
    std::unique_lock lock(mutex_);
    while (called_.wait(lock, stop, [&] { return !calls_.empty(); })) {
      Call& call = *calls_.front();
      if (--call.wanted == 0) calls_.pop_front();
      ++call.running;
      lock.unlock();
      (*call.work)();
      lock.lock();
      if (--call.running == 0) returned_.notify_all();
    }
  }

  std::mutex mutex_;
  std::condition_variable_any called_, returned_;
  std::list<Call*> calls_;
  std::vector<std::jthread> threads_;  // last: stopped before what they wait for is gone
};

}  // namespace

void OnSeveralThreads(int others, const std::function<void()>& work) {
  static Crew crew;
  crew.Work(others, work);
}

}  // namespace merlin::sim
