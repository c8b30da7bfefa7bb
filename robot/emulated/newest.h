// A slot that holds the latest item: one thread puts items, others wait for a newer one.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <utility>

namespace merlin {

template <class Item>
class Newest {
 public:
  struct Numbered {
    std::uint64_t number = 0;          // the first is 1
    std::shared_ptr<const Item> item;  // null: none was put in time
  };

  void Put(Item item) {
    {
      const std::lock_guard lock(mutex_);
      newest_ = {newest_.number + 1, std::make_shared<const Item>(std::move(item))};
    }
    changed_.notify_all();
  }
  // The number of items put so far.
  std::uint64_t count() const {
    const std::lock_guard lock(mutex_);
    return newest_.number;
  }
  // Waits for an item after that number and returns the newest; null if none is put in time, or after Close.
  Numbered WaitAfter(std::uint64_t number, std::chrono::milliseconds limit) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, limit, [&] { return closed_ || newest_.number > number; });
    return closed_ || newest_.number <= number ? Numbered{number, nullptr} : newest_;
  }
  bool closed() const {
    const std::lock_guard lock(mutex_);
    return closed_;
  }
  void Close() {
    {
      const std::lock_guard lock(mutex_);
      closed_ = true;
    }
    changed_.notify_all();
  }

 private:
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  Numbered newest_;
  bool closed_ = false;
};

}  // namespace merlin
