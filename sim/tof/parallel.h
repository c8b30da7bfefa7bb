// One loop, several threads: for work that gives the same bits in any order.
#pragma once

#include <algorithm>
#include <atomic>
#include <exception>
#include <functional>
#include <mutex>

namespace merlin::sim {

// Calls work on this thread and, as far as they are free, on up to others threads that wait for such calls (they stay for
// the process' life: to start one takes as long as a small loop). Returns when all have returned. work must not throw.
void OnSeveralThreads(int others, const std::function<void()>& work);

// Calls work(i) once for each i in [0, count), on this thread and threads - 1 others. An exception of a call is rethrown here.
template <class Work>
void ParallelFor(int count, int threads, const Work& work) {
  if (threads <= 1 || count <= 1) {
    for (int i = 0; i < count; ++i) work(i);
    return;
  }
  std::atomic<int> next{0};
  std::exception_ptr thrown;
  std::mutex thrown_mutex;
  OnSeveralThreads(std::min(threads, count) - 1, [&] {
    try {
      for (int i = next++; i < count; i = next++) work(i);
    } catch (...) {
      const std::lock_guard lock(thrown_mutex);
      thrown = std::current_exception();
      next = count;
    }
  });
  if (thrown) std::rethrow_exception(thrown);
}

}  // namespace merlin::sim
