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
    std::uint64_t number = 0;          // 1: the first
    std::shared_ptr<const Item> item;  // null: none came
  };

  void Put(Item item) {
    {
      const std::lock_guard lock(mutex_);
      newest_ = {newest_.number + 1, std::make_shared<const Item>(std::move(item))};
    }
    changed_.notify_all();
  }
  // Of all that came so far, none was skipped.
  std::uint64_t count() const {
    const std::lock_guard lock(mutex_);
    return newest_.number;
  }
  // The newest after that number, once there is one; null where none comes in time or it is closed.
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
