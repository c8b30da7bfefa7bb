// Runs one loop on several threads. For work whose result does not depend on the order.
#pragma once

#include <algorithm>
#include <atomic>
#include <exception>
#include <functional>
#include <mutex>

namespace merlin::sim {

// Calls work on this thread and on up to `others` idle threads of a pool, and returns when all calls have returned. The
// pool's threads stay for the lifetime of the process, because starting one takes as long as a small loop. work must
// not throw.
void OnSeveralThreads(int others, const std::function<void()>& work);

// Calls work(i) once for each i in [0, count) on this thread and threads - 1 others. Rethrows an exception of a call.
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
