// A serial port without hardware: a program opens path() as it would a real one, and this end speaks as the device.
// Close and Open again are the device unplugged and plugged in.
#pragma once

#include <filesystem>
#include <optional>

#include "robot/protocol/bytes.h"

namespace merlin {

class PseudoTerminal {
 public:
  // Opens. The kernel names ports as it likes; link, if given, is a symbolic link that keeps its name across Open, and
  // is there as long as the port is. Throws MachineError.
  explicit PseudoTerminal(std::filesystem::path link = {});
  ~PseudoTerminal();
  PseudoTerminal(const PseudoTerminal&) = delete;
  PseudoTerminal& operator=(const PseudoTerminal&) = delete;

  void Open();
  void Close();
  // The program that had claimed the port for itself (TIOCEXCL) has died: others may open it again. The kernel undoes the
  // claim only when nobody has the port open, and this end always has.
  void Unclaim();

  // What the program is to open.
  const std::filesystem::path& path() const { return link_.empty() ? port_ : link_; }

  // What the program has written; nothing while closed. Never blocks.
  Bytes Read();
  // What the program does not read in time is dropped, as by a port whose buffer is full.
  void Write(BytesView bytes);
  // The rate the program has set, 0 if not one of ours or closed.
  int baud() const;

 private:
  std::filesystem::path link_, port_;
  int master_ = -1;
  int slave_ = -1;  // held open: without it reading is an error until the program comes
};

}  // namespace merlin
