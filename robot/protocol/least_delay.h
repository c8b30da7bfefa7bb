// How late a message is, without a clock that sender and receiver share. The message with the shortest delay so far is
// the reference; a later message is late by as much as its delay exceeds that. (The idea of NTP's clock filter: Mills,
// RFC 5905, section 10.)
#pragma once

#include <cstdint>
#include <optional>

#include "robot/types/time.h"

namespace merlin {

class LeastDelay {
 public:
  // sent_ms: the sender's clock, wrapping at 2^32 (49.7 days). The reference delay slowly rises (1 part in 5000), so
  // that a sender whose clock runs slow does not seem later and later. Less than 1 ms is rounding by the sender.
  Duration Lateness(std::uint32_t sent_ms, Time now);

  // Whether it was sent before the newest message so far: an old message, or a sender that has restarted.
  bool IsOld(std::uint32_t sent_ms) const;

  void Reset() { mark_.reset(); }

 private:
  struct Mark {
    std::uint32_t sent_ms;  // the newest
    Duration sent;          // unwrapped
    Duration least;         // of now - sent, so far
    Time at;
  };
  std::optional<Mark> mark_;
};

}  // namespace merlin
