#include "scenarios/judge/output_path.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>

#include "robot/base/error.h"

namespace merlin {
namespace {

namespace fs = std::filesystem;

// Tries to open the file that WriteFile opens first, and removes it unless it existed before.
void TryPart(const fs::path& file, const std::string& option) {
  fs::path part = file;
  part += ".part";
  int descriptor = ::open(part.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
  const bool made = descriptor >= 0;
  if (!made && errno == EEXIST) descriptor = ::open(part.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) RefuseOutput(file, "cannot be written", errno, option);
  ::close(descriptor);
  if (made) ::unlink(part.c_str());
}

}  // namespace

void CheckOutputFile(const fs::path& file, const std::string& option) {
  if (file.empty()) throw InputError(option, "is empty", "a file's path");
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  const std::string expected = "a new file, or one to replace";
  if (fs::is_directory(status)) RefuseOutput(file, expected, "a folder", option);
  if (fs::is_symlink(fs::symlink_status(file, error)) && !fs::exists(status))
    RefuseOutput(file, expected, "a link that leads nowhere", option);
  if (fs::exists(status) && ::access(file.c_str(), W_OK) != 0) RefuseOutput(file, "cannot be written", errno, option);
  if (fs::exists(status) && !fs::is_regular_file(status)) RefuseOutput(file, expected, "a device or a pipe", option);
  TryPart(file, option);
}

void RefuseOutput(const fs::path& path, const std::string& what, int error, const std::string& option) {
  const std::string reason = fmt::format("{}: {}: {}", path.string(), what, std::strerror(error));
  if (error == ENOSPC || error == EDQUOT || error == EIO) throw MachineError(reason);
  throw InputError(option + " " + reason);
}

void RefuseOutput(const fs::path& path, const std::string& expected, const std::string& got,
                  const std::string& option) {
  throw InputError(option + " " + path.string(), "cannot be used", expected, got);
}

}  // namespace merlin
