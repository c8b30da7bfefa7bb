#include "robot/hardware/operator/joystick_device.h"

#include <fcntl.h>
#include <linux/joystick.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <string>

#include "robot/base/error.h"

namespace merlin {
namespace {

constexpr std::size_t kEvents_bytes = 64 * joystick::kEvent_bytes;  // as many as the kernel keeps
constexpr int kReadsMax = 16;  // in a row: a pipe that is never empty must not hold up the car

int Open(const std::filesystem::path& device) {
  return open(device.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY);
}

bool IsPipe(int fd) {
  struct stat about {};
  return fstat(fd, &about) == 0 && S_ISFIFO(about.st_mode);
}

bool IsJoystick(int fd) {
  std::uint8_t axes = 0;
  return ioctl(fd, JSIOCGAXES, &axes) >= 0;
}

}  // namespace

JoystickDevice::JoystickDevice(const std::filesystem::path& device) : device_(device), fd_(Open(device)) {
  if (fd_ < 0) throw MachineError(device_.string() + ": this joystick cannot be opened: " + std::strerror(errno));
  if (IsPipe(fd_) || IsJoystick(fd_)) return;
  Close();
  throw InputError(device_.string(), "no joystick", "a device such as /dev/input/js0, or a named pipe with its events");
}

JoystickDevice::~JoystickDevice() { Close(); }

void JoystickDevice::Close() {
  if (fd_ >= 0) close(fd_);
  fd_ = -1;
}

bool JoystickDevice::Read() {
  if (fd_ < 0) {
    fd_ = Open(device_);
    if (fd_ < 0) return false;
    decoder_ = {};  // the kernel sends the state of all axes and buttons to a new reader
  }
  std::array<std::uint8_t, kEvents_bytes> buffer;
  for (int reads = 0; reads < kReadsMax; ++reads) {
    const ssize_t size = read(fd_, buffer.data(), buffer.size());
    if (size > 0) {
      decoder_.Feed(BytesView(buffer.data(), static_cast<std::size_t>(size)));
      continue;
    }
    if (size < 0 && (errno == EAGAIN || errno == EINTR)) return true;
    if (size < 0) Close();  // unplugged
    return false;
  }
  return true;
}

}  // namespace merlin
