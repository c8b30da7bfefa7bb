#include "robot/hardware/serial/serial_port.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include "robot/base/error.h"

namespace merlin {
namespace {

constexpr std::size_t kRead_bytes = 4096;

speed_t Speed(const SerialConfig& config) {
  switch (config.baud) {
    case 9600:
      return B9600;
    case 19200:
      return B19200;
    case 57600:
      return B57600;
    case 115200:
      return B115200;
    default:
      throw InputError(config.port, "invalid baud rate", "9600, 19200, 57600 or 115200", std::to_string(config.baud));
  }
}

}  // namespace

SerialPort::SerialPort(const SerialConfig& config) : config_(config), wake_fd_(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {
  Speed(config);
  if (wake_fd_ < 0) Fail(std::strerror(errno));
}

SerialPort::~SerialPort() {
  Close();
  close(wake_fd_);
}

void SerialPort::Fail(const std::string& what) const {
  throw MachineError("serial port " + config_.port + ": " + what);
}

void SerialPort::Open() {
  Close();
  fd_ = open(config_.port.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (fd_ < 0) {
    if (errno == ENOENT || errno == ENXIO || errno == ENODEV) Fail("there is no such port; is the device plugged in?");
    if (errno == EACCES) Fail("this user may not open it; expected a member of the group that owns it (dialout)");
    if (errno == EBUSY) Fail("it belongs to another program");
    if (errno == EISDIR) Fail("this is not a serial port");
    Fail(std::strerror(errno));
  }
  try {
    SetUp();
  } catch (...) {
    Close();
    throw;
  }
}

void SerialPort::SetUp() {
  termios settings{};
  if (tcgetattr(fd_, &settings) != 0) Fail("this is not a serial port");
  // flock keeps out programs that ask for the lock; TIOCEXCL (undone in Close) keeps out all others too.
  if (flock(fd_, LOCK_EX | LOCK_NB) != 0) Fail("it belongs to another program");
  ioctl(fd_, TIOCEXCL);
  cfmakeraw(&settings);
  settings.c_cflag |= CLOCAL | CREAD;
  settings.c_cflag &= ~static_cast<tcflag_t>(CSTOPB | CRTSCTS);
  settings.c_cc[VMIN] = 1;  // 0 would make "nothing there" look like "unplugged"
  settings.c_cc[VTIME] = 0;
  cfsetspeed(&settings, Speed(config_));
  termios now{};
  if (tcsetattr(fd_, TCSANOW, &settings) != 0 || tcgetattr(fd_, &now) != 0) Fail(std::strerror(errno));
  if (cfgetospeed(&now) != Speed(config_)) Fail("it does not support " + std::to_string(config_.baud) + " baud");
  tcflush(fd_, TCIOFLUSH);
}

void SerialPort::Close() {
  if (fd_ < 0) return;
  ioctl(fd_, TIOCNXCL);
  close(fd_);
  fd_ = -1;
  tail_.clear();
}

Bytes SerialPort::Read() {
  std::array<std::uint8_t, kRead_bytes> buffer;
  const ssize_t size = fd_ < 0 ? 0 : read(fd_, buffer.data(), buffer.size());
  if (size > 0) return Bytes(buffer.begin(), buffer.begin() + size);
  const bool nothing_there = size < 0 && (errno == EAGAIN || errno == EINTR);
  if (!nothing_there) Close();
  return {};
}

BytesView SerialPort::Send(BytesView bytes) {
  if (fd_ < 0 || bytes.empty()) return {};
  const ssize_t size = write(fd_, bytes.data(), bytes.size());
  if (size >= 0) return bytes.subspan(static_cast<std::size_t>(size));
  if (errno == EAGAIN || errno == EINTR) return bytes;
  Close();
  return {};
}

void SerialPort::Write(BytesView message) {
  if (!tail_.empty()) {
    const BytesView left = Send(tail_);
    tail_ = Bytes(left.begin(), left.end());
    if (!tail_.empty()) return;
  }
  const BytesView left = Send(message);
  if (left.size() < message.size()) tail_.assign(left.begin(), left.end());
}

bool SerialPort::Wait(Duration timeout) {
  // poll ignores a negative descriptor: without a port it waits for Wake only.
  std::array<pollfd, 2> fds{{{wake_fd_, POLLIN, 0}, {fd_, POLLIN, 0}}};
  const auto ms = std::chrono::ceil<std::chrono::milliseconds>(std::max(timeout, Duration(0)));
  if (poll(fds.data(), fds.size(), static_cast<int>(ms.count())) <= 0) return false;
  std::uint64_t count = 0;
  if (fds[0].revents != 0 && read(wake_fd_, &count, sizeof count) < 0) return true;  // lets the next Wait wait again
  return true;
}

void SerialPort::Wake() {
  const std::uint64_t one = 1;
  if (write(wake_fd_, &one, sizeof one) < 0) return;  // counter full: Wait is already woken
}

}  // namespace merlin
