// A serial port of this machine: raw bytes, 8N1, no flow control. No call blocks, except Wait.
#pragma once

#include <string>

#include "robot/base/config.h"
#include "robot/protocol/bytes.h"
#include "robot/types/time.h"

namespace merlin {

struct SerialConfig {
  std::string port;  // such as /dev/ttyUSB0; better a name that does not change: /dev/serial/by-id/...
  int baud = 9600;   // 9600, 19200, 57600 or 115200, as the device is set
};

template <class Visitor>
void Visit(Visitor& v, SerialConfig& c) {
  v("port", c.port);
  v("baud", c.baud, Range{9600, 115200});
}

class SerialPort {
 public:
  // Throws InputError for another baud rate. Opens nothing yet.
  explicit SerialPort(const SerialConfig& config);
  ~SerialPort();
  SerialPort(const SerialPort&) = delete;
  SerialPort& operator=(const SerialPort&) = delete;

  // Throws MachineError, one sentence: no such port, not a serial port, no permission, belongs to another program.
  // Bytes from before are discarded. While the port is open, other programs cannot open it.
  void Open();
  bool is_open() const { return fd_ >= 0; }

  // What has arrived, up to 4096 bytes a call. A port that is unplugged closes itself: see is_open().
  Bytes Read();
  // Once the port has taken the beginning of a message, the whole message is sent: the tail of a short write is kept,
  // and the next Write (also an empty one, Write({})) sends it first. While a tail waits, new messages are dropped,
  // because they would arrive too late.
  void Write(BytesView message);
  // Waits until something can be read or another thread calls Wake. False: the time was over first.
  bool Wait(Duration timeout);
  void Wake();

 private:
  void Close();
  void SetUp();
  // Returns the bytes that the port did not take.
  BytesView Send(BytesView bytes);
  [[noreturn]] void Fail(const std::string& what) const;

  SerialConfig config_;
  Bytes tail_;  // the rest of a message that the port has taken in part
  int fd_ = -1;
  int wake_fd_ = -1;
};

}  // namespace merlin
