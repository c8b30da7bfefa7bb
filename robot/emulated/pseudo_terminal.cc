#include "robot/emulated/pseudo_terminal.h"

#include <fcntl.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <utility>

#include "robot/base/error.h"

namespace merlin {
namespace {

constexpr std::size_t kRead_bytes = 4096;

[[noreturn]] void FailPort(const std::string& what) {
  throw MachineError("pseudo-terminal: " + what + ": " + std::strerror(errno));
}

// Passes bytes unchanged from the start: an echo before the program opens the port would be read as a command.
void MakeRaw(int fd) {
  termios settings{};
  if (tcgetattr(fd, &settings) != 0) FailPort("its settings cannot be read");
  cfmakeraw(&settings);
  if (tcsetattr(fd, TCSANOW, &settings) != 0) FailPort("it cannot be set to raw bytes");
}

}  // namespace

PseudoTerminal::PseudoTerminal(std::filesystem::path link) : link_(std::move(link)) { Open(); }

PseudoTerminal::~PseudoTerminal() { Close(); }

void PseudoTerminal::Open() {
  Close();
  master_ = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  std::array<char, 128> name{};
  if (master_ < 0 || grantpt(master_) != 0 || unlockpt(master_) != 0 ||
      ptsname_r(master_, name.data(), name.size()) != 0)
    FailPort("cannot be opened");
  port_ = name.data();
  slave_ = open(port_.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC);
  if (slave_ < 0) FailPort("its other end cannot be opened");
  MakeRaw(slave_);
  if (link_.empty()) return;
  std::error_code error;
  std::filesystem::remove(link_, error);
  std::filesystem::create_symlink(port_, link_, error);
  if (error) throw MachineError("pseudo-terminal: cannot make the link " + link_.string() + ": " + error.message());
}

void PseudoTerminal::Close() {
  if (master_ < 0) return;
  std::error_code ignored;
  if (!link_.empty()) std::filesystem::remove(link_, ignored);
  if (slave_ >= 0) close(slave_);
  close(master_);
  master_ = slave_ = -1;
}

void PseudoTerminal::Unclaim() {
  if (slave_ >= 0) ioctl(slave_, TIOCNXCL);
}

Bytes PseudoTerminal::Read() {
  std::array<std::uint8_t, kRead_bytes> buffer;
  const ssize_t size = master_ < 0 ? 0 : read(master_, buffer.data(), buffer.size());
  return size <= 0 ? Bytes() : Bytes(buffer.begin(), buffer.begin() + size);
}

void PseudoTerminal::Write(BytesView bytes) {
  if (master_ < 0 || bytes.empty()) return;
  if (write(master_, bytes.data(), bytes.size()) < 0) return;  // buffer full
}

int PseudoTerminal::baud() const {
  termios settings{};
  if (slave_ < 0 || tcgetattr(slave_, &settings) != 0) return 0;
  switch (cfgetospeed(&settings)) {
    case B9600:
      return 9600;
    case B19200:
      return 19200;
    case B57600:
      return 57600;
    case B115200:
      return 115200;
    default:
      return 0;
  }
}

}  // namespace merlin
