// A pair of radio modems WIZ-434-SML-IA in place of the cable: 433.92 MHz, half duplex, 100 kbit/s on air. Incoming
// bytes are cut into packets: a packet ends after 1.5 byte times of silence, at least 0.5 ms, or when it has 96 bytes.
// Then the modem switches to sending (5 ms), sends the packet with 6 bytes of its own, and the other one hands it out
// at its baud rate: n bytes take 10 n / baud + silence + 5 ms + 8 (n + 6) / 100 kbit/s + 10 n / baud. Bytes that arrive
// between the packet's end and the end of its sending are lost. Only one can send: the other's packet waits for the air
// (guess).
#pragma once

#include <array>
#include <deque>

#include "robot/base/config.h"
#include "robot/emulated/channel.h"
#include "robot/emulated/serial_line.h"

namespace merlin {

struct RadioConfig {
  int baud = 9600;              // of both modems: 9600, 19200, 57600 or 115200
  double turnaround_s = 0.005;  // [0, 0.1] data sheet
  double air_bit_s = 1e5;       // [1e3, 1e6] bits a second on air, data sheet
  double packet_loss = 0.0;     // share of packets that get lost, [0, 1]
};

template <class Visitor>
void Visit(Visitor& v, RadioConfig& c) {
  v("baud", c.baud, Range{9600, 115200});
  v("turnaround_s", c.turnaround_s, Range{0.0, 0.1});
  v("air_bit_s", c.air_bit_s, Range{1e3, 1e6});
  v("packet_loss", c.packet_loss, Range{0.0, 1.0});
}

class Radio : public Channel {
 public:
  static constexpr std::size_t kPacketMax_bytes = 96;

  Radio(const RadioConfig& config, std::uint64_t seed);

  void Put(Side from, Time now, BytesView bytes) override;
  Bytes Take(Side at, Time now) override;

  std::uint64_t lost_packets() const { return lost_packets_; }  // in the air
  std::uint64_t lost_bytes() const { return lost_bytes_; }      // to a modem that was sending

 private:
  struct Modem {
    explicit Modem(int baud) : out(baud) {}

    std::deque<std::uint8_t>
        coming;  // bytes on the cable to the modem, in order; each arrives a byte time after the other
    std::deque<Time> arrivals;
    Bytes packet;
    Time packet_end{Time::max()};  // if no more bytes come
    Time deaf_until{Time::min()};
    Time cable_free{Time::min()};
    SerialWire out;
  };

  Modem& at(Side side) { return modems_[static_cast<std::size_t>(side)]; }
  static Time NextEvent(const Modem& modem);
  void Advance(Time now);
  void TakeByte(Modem& modem);
  void SendPacket(Modem& from, Modem& to);

  RadioConfig config_;
  std::uint64_t seed_;
  Duration silence_;
  std::array<Modem, 2> modems_;
  Time air_free_{Time::min()};
  std::uint64_t packets_ = 0, lost_packets_ = 0, lost_bytes_ = 0;
};

}  // namespace merlin
