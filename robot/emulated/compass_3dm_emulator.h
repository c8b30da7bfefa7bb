// The MicroStrain 3DM as a state machine that reports a simulated attitude: the device's side of
// robot/protocol/compass_3dm.h.
#pragma once

#include <functional>
#include <optional>

#include "robot/protocol/compass_3dm.h"
#include "robot/protocol/serial_end.h"
#include "robot/types/measurements.h"

namespace merlin {

struct Compass3dmEmulatorConfig {
  double north_yaw_rad = 0.0;  // yaw of magnetic north in the world, [-pi, pi]
  bool with_checksum = false;
  double settling_s = 0.03;      // after 0x74; until then it ignores 0xC0, [0, 0.035] (guess)
  double reply_delay_s = 0.005;  // from sampling to the reply's first bit, [0, 0.1] (guess)
};

template <class Visitor>
void Visit(Visitor& v, Compass3dmEmulatorConfig& c) {
  v("north_yaw_rad", c.north_yaw_rad, Range{-3.1416, 3.1416});
  v("with_checksum", c.with_checksum);
  v("settling_s", c.settling_s, Range{0.0, 0.035});
  v("reply_delay_s", c.reply_delay_s, Range{0.0, 0.1});
}

class Compass3dmEmulator : public SerialEnd {
 public:
  // read: returns the body's attitude now, yaw in the world, noise included. Called when 0xC0 has come.
  Compass3dmEmulator(const Compass3dmEmulatorConfig& config, std::function<CompassReading()> read)
      : config_(config), read_(std::move(read)) {}

  void Receive(Time now, BytesView bytes) override;
  Bytes Send(Time now) override;
  Time next() const override { return reply_at_; }

 private:
  Compass3dmEmulatorConfig config_;
  std::function<CompassReading()> read_;
  std::optional<Time> poll_mode_;  // since when
  Bytes reply_;
  Time reply_at_{Time::max()};
};

}  // namespace merlin
