// A serial port without hardware. A program opens path() like a real port, and this end acts as the device. Close and
// Open simulate unplugging the device and plugging it in again.
#pragma once

#include <filesystem>
#include <optional>

#include "robot/protocol/bytes.h"

namespace merlin {

class PseudoTerminal {
 public:
  // Opens. The kernel chooses the port's name, and a new one each time. link, if given, is a symbolic link to the port
  // whose name stays; it exists as long as the port. Throws MachineError.
  explicit PseudoTerminal(std::filesystem::path link = {});
  ~PseudoTerminal();
  PseudoTerminal(const PseudoTerminal&) = delete;
  PseudoTerminal& operator=(const PseudoTerminal&) = delete;

  void Open();
  void Close();
  // Called after a program that claimed the port for itself (TIOCEXCL) has died: lets others open it. The kernel drops
  // the claim only when nobody has the port open, but this end always has.
  void Unclaim();

  // The path that the program must open.
  const std::filesystem::path& path() const { return link_.empty() ? port_ : link_; }

  // What the program has written; nothing while closed. Never blocks.
  Bytes Read();
  // Bytes that the program does not read in time are dropped, as by a port whose buffer is full.
  void Write(BytesView bytes);
  // The rate that the program has set; 0 if it is not a rate of SerialPort, or the port is closed.
  int baud() const;

 private:
  std::filesystem::path link_, port_;
  int master_ = -1;
  int slave_ = -1;  // held open: without it, reading fails until the program opens the port
};

}  // namespace merlin
