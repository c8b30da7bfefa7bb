// A named pipe that delivers events like a joystick device of the Linux kernel.
#pragma once

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <filesystem>

namespace merlin {

class JoystickPipe {
 public:
  explicit JoystickPipe(std::filesystem::path path) : path_(std::move(path)) { mkfifo(path_.c_str(), 0600); }
  ~JoystickPipe() { Close(); }
  const std::filesystem::path& path() const { return path_; }

  // As linux/joystick.h has it: u32 time, s16 value, u8 type (1 button, 2 axis), u8 number.
  void Axis(std::uint8_t number, std::int16_t value) { Write(value, 2, number); }
  void Button(std::uint8_t number, bool down) { Write(down ? 1 : 0, 1, number); }
  // Opens for writing; there must be a reader.
  void Open() {
    if (fd_ < 0) fd_ = open(path_.c_str(), O_WRONLY | O_NONBLOCK);
  }
  void Close() {
    if (fd_ >= 0) close(fd_);
    fd_ = -1;
  }

 private:
  void Write(std::int16_t value, std::uint8_t type, std::uint8_t number) {
    Open();
    const auto bits = static_cast<std::uint16_t>(value);
    const std::array<std::uint8_t, 8> event{
        0, 0, 0, 0, static_cast<std::uint8_t>(bits), static_cast<std::uint8_t>(bits >> 8), type, number};
    if (write(fd_, event.data(), event.size()) != 8) Close();
  }

  std::filesystem::path path_;
  int fd_ = -1;
};

}  // namespace merlin
