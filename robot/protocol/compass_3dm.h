// The attitude sensor MicroStrain 3DM, RS-232 9600 8N1. The host sends 0x74 (poll mode), waits 35 ms, sends 0xC0 (send
// the angles), waits 35 ms, and reads 0x44 and roll, pitch, yaw as 16-bit words, big-endian, 360/65536 deg a count, all
// three as aircraft have them: x ahead, y right, z down. Hence not more than 13 readings a second.
#pragma once

#include <cstdint>
#include <optional>

#include "robot/base/config.h"
#include "robot/protocol/bytes.h"
#include "robot/types/time.h"

namespace merlin::compass_3dm {

inline constexpr std::uint8_t kPollMode = 0x74, kSendAngles = 0xC0, kReply = 0x44;
inline constexpr Duration kWait = std::chrono::milliseconds(35);

struct Counts {
  std::uint16_t roll = 0, pitch = 0, yaw = 0;
  bool operator==(const Counts&) const = default;
};

struct Attitude {
  double roll_rad = 0.0;     // of our body (x ahead, y left, z up), in [-pi, pi)
  double pitch_rad = 0.0;    // likewise, in (-pi, pi]; positive: nose down
  double heading_rad = 0.0;  // clockwise from magnetic north seen from above, in [0, 2 pi)
};

// How counts become angles.
enum class Arithmetic {
  kExact,
  kThesis,  // as MERLIN's own software did: 0.0055 deg a count and 361 deg a turn; up to 1 deg off
};

Attitude ToAttitude(const Counts& counts, Arithmetic arithmetic = Arithmetic::kExact);
Counts ToCounts(const Attitude& attitude);  // exact; the angles finite

// with_checksum: one more byte, the sum of the seven before it modulo 256 (some firmware; a guess, off by default).
Bytes EncodeReply(const Counts& counts, bool with_checksum);
std::optional<Counts> DecodeReply(BytesView reply, bool with_checksum);

struct PollerConfig {
  double period_s = 0.08;  // from poll to poll, [0.0775, 10]; 12.5 Hz: below it the reply does not fit in
  bool with_checksum = false;
  double patience_s = 0.03;  // how late a reply may be, [0, 1], before the poll has failed (guess)
};

template <class Visitor>
void Visit(Visitor& v, PollerConfig& c) {
  v("period_s", c.period_s, Range{0.0775, 10.0});
  v("with_checksum", c.with_checksum);
  v("patience_s", c.patience_s, Range{0.0, 1.0});
}

// The host's side: decides what to send and when. The reply has no frame that separates it from garbage. But it answers
// a question: only what arrives between the question and the reading counts, and each poll starts afresh.
class Poller {
 public:
  struct Reading {
    Counts counts;
    Time asked{0};  // when 0xC0 was sent
  };

  explicit Poller(const PollerConfig& config) : config_(config) {}

  void Receive(Time now, BytesView bytes);
  // Call when next() has come, and after Receive.
  Bytes Send(Time now);
  Time next() const;
  // The reading of the last poll, once.
  std::optional<Reading> Take();

  std::uint64_t failed_polls() const { return failed_polls_; }
  std::uint64_t garbage_bytes() const { return garbage_bytes_; }

 private:
  enum class Phase { kIdle, kSettling, kReading };
  std::size_t reply_bytes() const { return config_.with_checksum ? 8 : 7; }
  void Judge();

  PollerConfig config_;
  Phase phase_ = Phase::kIdle;
  Time started_{0};  // start of this poll; in kIdle, of the next
  Time asked_{0};
  Bytes received_;
  std::optional<Reading> reading_;
  std::uint64_t failed_polls_ = 0;
  std::uint64_t garbage_bytes_ = 0;
};

}  // namespace merlin::compass_3dm
