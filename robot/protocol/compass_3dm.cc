#include "robot/protocol/compass_3dm.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

namespace merlin::compass_3dm {
namespace {

constexpr double kRadPerCount = 2.0 * std::numbers::pi / 65536.0;
constexpr double kRadPerDeg = std::numbers::pi / 180.0;
constexpr double kThesisDegPerCount = 0.0055;
constexpr std::size_t kKeep_bytes = 64;  // of bytes that arrive instead of a reply

double Signed_rad(std::uint16_t counts) { return static_cast<std::int16_t>(counts) * kRadPerCount; }

std::uint16_t NearestCount(double angle_rad) {
  return static_cast<std::uint16_t>(std::lround(std::remainder(angle_rad, 2.0 * std::numbers::pi) / kRadPerCount) &
                                    0xFFFF);
}

Attitude ThesisAttitude(const Counts& counts) {
  const auto deg = [](std::uint16_t c) { return kThesisDegPerCount * c; };
  return {.roll_rad = kRadPerDeg * (counts.roll >= 49151 ? deg(counts.roll) - 361.0 : deg(counts.roll)),
          .pitch_rad = kRadPerDeg * (counts.pitch >= 32768 ? 360.0 - deg(counts.pitch) : -deg(counts.pitch)),
          .heading_rad = kRadPerDeg * deg(counts.yaw)};  // the thesis' yaw is 360 deg minus this
}

std::uint8_t Sum(BytesView bytes) { return static_cast<std::uint8_t>(std::accumulate(bytes.begin(), bytes.end(), 0u)); }

}  // namespace

Attitude ToAttitude(const Counts& counts, Arithmetic arithmetic) {
  if (arithmetic == Arithmetic::kThesis) return ThesisAttitude(counts);
  return {.roll_rad = Signed_rad(counts.roll),
          .pitch_rad = -Signed_rad(counts.pitch),  // y points the other way
          .heading_rad = counts.yaw * kRadPerCount};
}

Counts ToCounts(const Attitude& attitude) {
  return {NearestCount(attitude.roll_rad), NearestCount(-attitude.pitch_rad), NearestCount(attitude.heading_rad)};
}

Bytes EncodeReply(const Counts& counts, bool with_checksum) {
  Bytes reply{kReply};
  for (const std::uint16_t word : {counts.roll, counts.pitch, counts.yaw}) Put(reply, word);
  if (with_checksum) reply.push_back(Sum(reply));
  return reply;
}

std::optional<Counts> DecodeReply(BytesView reply, bool with_checksum) {
  if (reply.size() != (with_checksum ? 8u : 7u) || reply[0] != kReply) return std::nullopt;
  if (with_checksum && reply[7] != Sum(reply.first(7))) return std::nullopt;
  ByteReader reader(reply.subspan(1));
  Counts counts;
  counts.roll = reader.Take<std::uint16_t>();
  counts.pitch = reader.Take<std::uint16_t>();
  counts.yaw = reader.Take<std::uint16_t>();
  return counts;
}

void Poller::Receive(Time, BytesView bytes) {
  if (phase_ != Phase::kReading) {
    garbage_bytes_ += bytes.size();
    return;
  }
  const std::size_t room = std::min(bytes.size(), kKeep_bytes - received_.size());
  received_.insert(received_.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(room));
  garbage_bytes_ += bytes.size() - room;
}

Bytes Poller::Send(Time now) {
  if (now < next()) return {};
  switch (phase_) {
    case Phase::kIdle:
      phase_ = Phase::kSettling;
      started_ = now;
      return {kPollMode};
    case Phase::kSettling:
      phase_ = Phase::kReading;
      asked_ = now;
      received_.clear();
      return {kSendAngles};
    case Phase::kReading:
      Judge();
      phase_ = Phase::kIdle;
      started_ = std::max(started_ + FromSeconds(config_.period_s), now);
      return Send(now);
  }
  return {};
}

Time Poller::next() const {
  if (phase_ == Phase::kIdle) return started_;
  if (phase_ == Phase::kSettling) return started_ + kWait;
  return asked_ + kWait + (received_.size() < reply_bytes() ? FromSeconds(config_.patience_s) : Duration(0));
}

void Poller::Judge() {
  if (const auto counts = DecodeReply(received_, config_.with_checksum)) {
    reading_ = {*counts, asked_};
    return;
  }
  ++failed_polls_;
  garbage_bytes_ += received_.size();
}

std::optional<Poller::Reading> Poller::Take() { return std::exchange(reading_, std::nullopt); }

}  // namespace merlin::compass_3dm
