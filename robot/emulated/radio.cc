#include "robot/emulated/radio.h"

#include <algorithm>
#include <utility>

#include "robot/base/random.h"
#include "robot/protocol/serial_end.h"

namespace merlin {
namespace {

constexpr double kSilence_bytes = 1.5;
constexpr double kSilenceMin_s = 0.5e-3;
constexpr std::size_t kPacketHead_bytes = 6;
constexpr std::uint16_t kLossPurpose = 434;  // purpose of the drive's random numbers for lost packets

}  // namespace

Radio::Radio(const RadioConfig& config, std::uint64_t seed)
    : config_(config),
      seed_(seed),
      silence_(FromSeconds(std::max(kSilence_bytes * 10.0 / config.baud, kSilenceMin_s))),
      modems_{Modem(config.baud), Modem(config.baud)} {}

void Radio::Put(Side from, Time now, BytesView bytes) {
  Modem& modem = at(from);
  const Time start = std::max(now, modem.cable_free);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    modem.coming.push_back(bytes[i]);
    modem.arrivals.push_back(start + WireTime(i + 1, config_.baud));
  }
  if (!bytes.empty()) modem.cable_free = modem.arrivals.back();
}

Bytes Radio::Take(Side side, Time now) {
  Advance(now);
  return at(side).out.Take(now);
}

Time Radio::NextEvent(const Modem& modem) {
  return modem.arrivals.empty() ? modem.packet_end : std::min(modem.arrivals.front(), modem.packet_end);
}

// Handles in order of time the bytes that arrive at either modem and the packets that end.
void Radio::Advance(Time now) {
  while (true) {
    const bool host_first = NextEvent(modems_[0]) <= NextEvent(modems_[1]);
    Modem& modem = modems_[host_first ? 0 : 1];
    if (NextEvent(modem) > now || NextEvent(modem) == Time::max()) return;
    if (modem.packet_end <= NextEvent(modem))
      SendPacket(modem, modems_[host_first ? 1 : 0]);
    else
      TakeByte(modem);
  }
}

void Radio::TakeByte(Modem& modem) {
  const Time now = modem.arrivals.front();
  const std::uint8_t byte = modem.coming.front();
  modem.arrivals.pop_front();
  modem.coming.pop_front();
  if (now <= modem.deaf_until || modem.packet.size() == kPacketMax_bytes) {
    ++lost_bytes_;
    return;
  }
  modem.packet.push_back(byte);
  modem.packet_end = now + silence_;
}

void Radio::SendPacket(Modem& from, Modem& to) {
  const Bytes packet = std::exchange(from.packet, {});
  const Time ended = std::exchange(from.packet_end, Time::max());
  const double air_s = 8.0 * static_cast<double>(packet.size() + kPacketHead_bytes) / config_.air_bit_s;
  air_free_ = std::max(ended, air_free_) + FromSeconds(config_.turnaround_s + air_s);
  from.deaf_until = air_free_;
  // The random number depends on the packet's number, whichever modem sends it.
  Random random(seed_, Sensor::kDrive, packets_++, 0, kLossPurpose);
  if (random.Uniform() < config_.packet_loss)
    ++lost_packets_;
  else
    to.out.Put(air_free_, packet);
}

}  // namespace merlin
