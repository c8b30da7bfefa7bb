// The messages between PC and microcontroller, in the frames of robot/protocol/frame.h. The protocol is ours: of the
// real one no more is known than robot/protocol/one_byte.h has. Wire units: ms, um/s, 1e-4 rad, mA, mV, counts.
//
// A command is valid for valid_for from the moment it was sent, by the sender's clock. The microcontroller subtracts
// the command's delay (LeastDelay), so that neither a slow radio nor a duplicate prolongs it. A Hello makes it forget
// the old sender's clock. When no command has come for 150 ms, it brakes, whatever is valid.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "robot/protocol/frame.h"
#include "robot/types/time.h"

namespace merlin::microcontroller {

inline constexpr Duration kWatchdog = std::chrono::milliseconds(150);
inline constexpr double kStateRate_hz = 50.0;  // at which it sends a State unasked; 26 bytes each

// Asks for a HelloReply.
struct Hello {
  bool operator==(const Hello&) const = default;
};

// Values beyond the wire's range (2147 m/s, 3.2767 rad, 65.535 s) are clamped: the car's limits lie far within it, and
// a command that must hold longer is sent again. A number that is not finite, or a valid_for below 1 ms, is encoded as
// "expire now": all zero.
struct Command {
  std::uint32_t host_time_ms = 0;
  double speed_m_s = 0.0;
  double steering_rad = 0.0;
  Duration valid_for{0};
  bool operator==(const Command&) const = default;
};

// Turns the cameras. An angle that is not finite is refused (InputError); clamped to 3.2767 rad.
struct PanCommand {
  double angle_rad = 0.0;
  bool operator==(const PanCommand&) const = default;
};

// At most 87 characters of printable ASCII; longer is cut, others become '?'.
struct HelloReply {
  std::uint8_t version = kProtocolVersion;
  std::string firmware{};
  bool operator==(const HelloReply&) const = default;
};

// Clamped to +-3.2767 rad, +-32.767 A, 0 to 65.535 V; a number that is not finite is refused (InputError).
struct State {
  std::uint32_t micro_time_ms = 0;  // since it was switched on, at the sampling instant
  std::int32_t encoder_counts = 0;  // wraps
  double steering_rad = 0.0;
  double current_a = 0.0;
  double battery_v = 0.0;
  bool expired = false;  // the command has: the motor is braked
  bool low_battery = false;
  bool watchdog = false;                  // braked because no command came, not because one ended
  std::uint8_t last_command = 0;          // sequence number of the last command taken
  std::optional<double> pan_angle_rad{};  // none: there is no pan unit
  bool operator==(const State&) const = default;
};

using ToMicro = std::variant<Hello, Command, PanCommand>;
using ToHost = std::variant<HelloReply, State>;

Bytes Encode(const ToMicro& message, std::uint8_t sequence);
Bytes Encode(const ToHost& message, std::uint8_t sequence);

template <class Message>
struct Received {
  std::uint8_t sequence = 0;
  Message message;
};

// One direction of the line: Message is ToMicro or ToHost.
template <class Message>
class Decoder {
 public:
  std::vector<Received<Message>> Feed(BytesView bytes);
  const LinkCounters& counters() const { return frames_.counters(); }
  std::uint8_t other_version() const { return frames_.other_version(); }

 private:
  FrameDecoder frames_;
};

}  // namespace merlin::microcontroller
