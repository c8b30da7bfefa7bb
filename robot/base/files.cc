#include "robot/base/files.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <ios>

#include "robot/base/error.h"

namespace merlin {
namespace {

[[noreturn]] void FailToWrite(const std::filesystem::path& file, const std::filesystem::path& part, int error) {
  if (!part.empty()) ::unlink(part.c_str());
  throw MachineError(file.string() + ": cannot be written: " + std::strerror(error));
}

}  // namespace

std::string ReadFile(const std::filesystem::path& file, const std::string& what) {
  constexpr std::size_t kMost_bytes = 1'000'000'000;
  std::ifstream in(file, std::ios::binary);
  std::string text, part(1 << 20, '\0');
  if (!in) throw InputError(file.string(), "cannot be read", what);
  while (in.read(part.data(), static_cast<std::streamsize>(part.size())), in.gcount() > 0) {
    text.append(part, 0, static_cast<std::size_t>(in.gcount()));
    if (text.size() > kMost_bytes) throw InputError(file.string(), "longer than 1 GB", what);
  }
  if (!in.eof()) throw InputError(file.string(), "cannot be read", what);
  return text;
}

void WriteFile(const std::filesystem::path& file, std::string_view bytes) {
  std::filesystem::path part = file;
  part += ".part";
  const int descriptor = ::open(part.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (descriptor < 0) FailToWrite(file, {}, errno);
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) {
      const int error = written == 0 ? ENOSPC : errno;
      ::close(descriptor);
      FailToWrite(file, part, error);
    }
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  if (::close(descriptor) != 0) FailToWrite(file, part, errno);  // a network disk may report only here that it is full
  if (::rename(part.c_str(), file.c_str()) != 0) FailToWrite(file, part, errno);
}

}  // namespace merlin
