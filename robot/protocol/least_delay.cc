#include "robot/protocol/least_delay.h"

#include <algorithm>

namespace merlin {
namespace {

constexpr int kDriftInverse = 5000;  // 200 parts in a million: twice what two cheap quartzes differ

std::int32_t Step_ms(std::uint32_t from_ms, std::uint32_t to_ms) { return static_cast<std::int32_t>(to_ms - from_ms); }

}  // namespace

Duration LeastDelay::Lateness(std::uint32_t sent_ms, Time now) {
  if (!mark_) {
    const Duration sent = std::chrono::milliseconds(sent_ms);
    mark_ = {sent_ms, sent, now - sent, now};
    return Duration(0);
  }
  const std::int32_t step_ms = Step_ms(mark_->sent_ms, sent_ms);
  const Duration sent = mark_->sent + std::chrono::milliseconds(step_ms);
  if (step_ms > 0) {
    mark_->sent_ms = sent_ms;
    mark_->sent = sent;
  }
  mark_->least = std::min(mark_->least + (now - mark_->at) / kDriftInverse, now - sent);
  mark_->at = now;
  return now - sent - mark_->least;
}

bool LeastDelay::IsOld(std::uint32_t sent_ms) const { return mark_ && Step_ms(mark_->sent_ms, sent_ms) < 0; }

}  // namespace merlin
