#include "robot/emulated/compass_3dm_emulator.h"

#include <cmath>
#include <utility>

namespace merlin {

using namespace compass_3dm;

void Compass3dmEmulator::Receive(Time now, BytesView bytes) {
  for (const std::uint8_t byte : bytes) {
    if (byte == kPollMode) poll_mode_ = now;
    if (byte != kSendAngles || !poll_mode_ || now - *poll_mode_ < FromSeconds(config_.settling_s)) continue;
    const CompassReading body = read_();
    const Attitude attitude{body.roll_rad, body.pitch_rad, config_.north_yaw_rad - body.yaw_rad};
    reply_ = EncodeReply(ToCounts(attitude), config_.with_checksum);
    reply_at_ = now + FromSeconds(config_.reply_delay_s);
  }
}

Bytes Compass3dmEmulator::Send(Time now) {
  if (now < reply_at_) return {};
  reply_at_ = Time::max();
  return std::exchange(reply_, {});
}

}  // namespace merlin
