#include "tools/drive/radio_hand.h"

#include "robot/protocol/one_byte.h"

namespace merlin {
namespace {

constexpr Duration kValid = std::chrono::seconds(1);  // not part of the byte; the arbiter limits the age

}  // namespace

ManualCommand RadioHand::Send(const ManualCommand& at_station, Time now) {
  const OneByteLimits limits{limits_.speed_m_s, limits_.steering_rad};
  if (at_station.heard == now) {
    const DriveCommand command{at_station.speed_m_s, at_station.steering_rad, kValid};
    radio_.Put(Side::kHost, now,
               operator_link::Encode({.command = EncodeOneByte(command, limits),
                                      .held = at_station.held,
                                      .override_stop = at_station.override_stop,
                                      .autonomy = at_station.autonomy},
                                     sequence_++));
  }
  if (const auto message = decoder_.Feed(radio_.Take(Side::kDevice, now))) {
    const DriveCommand command = DecodeOneByte(message->command, limits, kValid);
    heard_ = {.heard = now,
              .held = message->held,
              .speed_m_s = command.speed_m_s,
              .steering_rad = command.steering_rad,
              .override_stop = message->override_stop,
              .autonomy = message->autonomy};
  }
  heard_.quit = at_station.quit;
  return heard_;
}

}  // namespace merlin
