#include "robot/protocol/microcontroller.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "robot/base/error.h"

namespace merlin::microcontroller {
namespace {

enum Type : std::uint8_t {
  kHello = kGreetingType,
  kCommand = 0x02,
  kPanCommand = 0x03,
  kHelloReply = 0x80 | kGreetingType,
  kState = 0x82,
};
enum Flag : std::uint8_t { kExpired = 1, kLowBattery = 2, kWatchdogFlag = 4, kHasPan = 8 };

constexpr double kUmPerM = 1e6, kStepsPerRad = 1e4, kMilli = 1e3;
constexpr std::size_t kCommand_bytes = 12, kPanCommand_bytes = 2, kState_bytes = 18;

// The nearest whole number of steps that T can hold.
template <class T>
T Steps(double value, double steps_per_unit) {
  const double steps = std::round(value * steps_per_unit);
  return static_cast<T>(std::clamp(steps, static_cast<double>(std::numeric_limits<T>::min()),
                                   static_cast<double>(std::numeric_limits<T>::max())));
}

template <class T>
T FiniteSteps(const char* name, double value, double steps_per_unit) {
  if (!std::isfinite(value)) throw InputError("microcontroller message", std::string(name) + " is not a finite number");
  return Steps<T>(value, steps_per_unit);
}

Frame Payload(const Hello&) { return {.type = kHello}; }

Frame Payload(const Command& command) {
  const bool holds = std::isfinite(command.speed_m_s) && std::isfinite(command.steering_rad);
  const auto valid_ms =
      holds ? Steps<std::uint16_t>(std::floor(Seconds(command.valid_for) * kMilli), 1.0) : std::uint16_t{0};
  Frame frame{.type = kCommand};
  Put(frame.payload, command.host_time_ms);
  Put(frame.payload, valid_ms);
  Put(frame.payload, valid_ms > 0 ? Steps<std::int32_t>(command.speed_m_s, kUmPerM) : 0);
  Put(frame.payload, valid_ms > 0 ? Steps<std::int16_t>(command.steering_rad, kStepsPerRad) : std::int16_t{0});
  return frame;
}

Frame Payload(const PanCommand& command) {
  Frame frame{.type = kPanCommand};
  Put(frame.payload, FiniteSteps<std::int16_t>("pan angle", command.angle_rad, kStepsPerRad));
  return frame;
}

Frame Payload(const HelloReply& reply) {
  Frame frame{.type = kHelloReply};
  Put(frame.payload, reply.version);
  for (const char c : reply.firmware.substr(0, kPayloadMax_bytes - 1))
    frame.payload.push_back(c >= ' ' && c <= '~' ? static_cast<std::uint8_t>(c) : '?');
  return frame;
}

Frame Payload(const State& state) {
  Frame frame{.type = kState};
  Put(frame.payload, state.micro_time_ms);
  Put(frame.payload, state.encoder_counts);
  Put(frame.payload, FiniteSteps<std::int16_t>("steering", state.steering_rad, kStepsPerRad));
  Put(frame.payload, FiniteSteps<std::int16_t>("motor current", state.current_a, kMilli));
  Put(frame.payload, FiniteSteps<std::uint16_t>("battery voltage", state.battery_v, kMilli));
  Put(frame.payload,
      static_cast<std::uint8_t>((state.expired ? kExpired : 0) | (state.low_battery ? kLowBattery : 0) |
                                (state.watchdog ? kWatchdogFlag : 0) | (state.pan_angle_rad ? kHasPan : 0)));
  Put(frame.payload, state.last_command);
  Put(frame.payload, FiniteSteps<std::int16_t>("pan angle", state.pan_angle_rad.value_or(0.0), kStepsPerRad));
  return frame;
}

template <class Message>
Bytes EncodeAny(const Message& message, std::uint8_t sequence) {
  Frame frame = std::visit([](const auto& m) { return Payload(m); }, message);
  frame.sequence = sequence;
  return EncodeFrame(frame);
}

Command ReadCommand(BytesView payload) {
  ByteReader reader(payload);
  Command command;
  command.host_time_ms = reader.Take<std::uint32_t>();
  command.valid_for = std::chrono::milliseconds(reader.Take<std::uint16_t>());
  command.speed_m_s = reader.Take<std::int32_t>() / kUmPerM;
  command.steering_rad = reader.Take<std::int16_t>() / kStepsPerRad;
  return command;
}

State ReadState(BytesView payload) {
  ByteReader reader(payload);
  State state;
  state.micro_time_ms = reader.Take<std::uint32_t>();
  state.encoder_counts = reader.Take<std::int32_t>();
  state.steering_rad = reader.Take<std::int16_t>() / kStepsPerRad;
  state.current_a = reader.Take<std::int16_t>() / kMilli;
  state.battery_v = reader.Take<std::uint16_t>() / kMilli;
  const auto flags = reader.Take<std::uint8_t>();
  state.expired = (flags & kExpired) != 0;
  state.low_battery = (flags & kLowBattery) != 0;
  state.watchdog = (flags & kWatchdogFlag) != 0;
  state.last_command = reader.Take<std::uint8_t>();
  const double pan_angle_rad = reader.Take<std::int16_t>() / kStepsPerRad;
  if ((flags & kHasPan) != 0) state.pan_angle_rad = pan_angle_rad;
  return state;
}

bool IsPrintable(BytesView text) {
  return std::all_of(text.begin(), text.end(), [](std::uint8_t c) { return c >= ' ' && c <= '~'; });
}

// Leaves message empty if the payload does not fit the type, or the type belongs to the other direction.
void Read(const Frame& frame, std::optional<ToMicro>& message) {
  const BytesView payload = frame.payload;
  if (frame.type == kHello && payload.empty()) message = Hello{};
  if (frame.type == kCommand && payload.size() == kCommand_bytes) message = ReadCommand(payload);
  if (frame.type == kPanCommand && payload.size() == kPanCommand_bytes)
    message = PanCommand{ByteReader(payload).Take<std::int16_t>() / kStepsPerRad};
}

void Read(const Frame& frame, std::optional<ToHost>& message) {
  const BytesView payload = frame.payload;
  if (frame.type == kHelloReply && !payload.empty() && IsPrintable(payload.subspan(1)))
    message = HelloReply{payload[0], std::string(payload.begin() + 1, payload.end())};
  if (frame.type == kState && payload.size() == kState_bytes) message = ReadState(payload);
}

}  // namespace

Bytes Encode(const ToMicro& message, std::uint8_t sequence) { return EncodeAny(message, sequence); }
Bytes Encode(const ToHost& message, std::uint8_t sequence) { return EncodeAny(message, sequence); }

template <class Message>
std::vector<Received<Message>> Decoder<Message>::Feed(BytesView bytes) {
  std::vector<Received<Message>> received;
  for (const Frame& frame : frames_.Feed(bytes)) {
    std::optional<Message> message;
    Read(frame, message);
    if (message)
      received.push_back({frame.sequence, *std::move(message)});
    else
      frames_.CountBadPayload(frame);
  }
  return received;
}

template class Decoder<ToMicro>;
template class Decoder<ToHost>;

}  // namespace merlin::microcontroller
