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
  // sent_ms: the sender's clock, wrapping at 2^32 (49.7 days). The mark may rise by kDrift, so that a sender whose
  // clock runs slow does not seem ever later. Below 1 ms is the sender's rounding.
  Duration Lateness(std::uint32_t sent_ms, Time now);

  // Sent before the newest so far: an old message, or a sender that started anew.
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
