#include "scenarios/judge/output_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>
#include <vector>

#include "robot/types/error.h"
#include "scenarios/judge/writers.h"

namespace merlin {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kExpected = "an empty folder, a new one, or one that a run of merlin left";

[[noreturn]] void Refuse(const fs::path& path, const std::string& what, int error) {
  const std::string reason = fmt::format("{}: {}: {}", path.string(), what, std::strerror(error));
  if (error == ENOSPC || error == EDQUOT || error == EIO) throw MachineError(reason);
  throw InputError("--out " + reason);
}

[[noreturn]] void RefuseAs(const fs::path& path, const std::string& got) {
  throw InputError("--out " + path.string(), "cannot be used", std::string(kExpected), got);
}

void MakeFolder(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::is_directory(status)) return;
  if (fs::exists(status)) RefuseAs(path, "something that is not a folder");
  if (fs::is_symlink(fs::symlink_status(path, error))) RefuseAs(path, "a link that leads nowhere");
  fs::create_directories(path, error);
  if (error) Refuse(path, "cannot be made", error.value());
}

// Whether a run of ours left it. Refuses a folder of anyone else's.
bool IsOurs(const fs::path& path) {
  std::error_code error;
  if (fs::is_regular_file(fs::symlink_status(path / OutputFolder::kMarker, error))) return true;
  const bool is_empty = fs::is_empty(path, error);
  if (error) Refuse(path, "cannot be read", error.value());
  if (!is_empty) RefuseAs(path, "a folder with other files in it");
  return false;
}

int OpenMarker(const fs::path& path) {
  const int marker = ::open((path / OutputFolder::kMarker).c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0644);
  if (marker < 0) Refuse(path, "cannot be written", errno);
  if (::flock(marker, LOCK_EX | LOCK_NB) != 0 &&
      errno == EWOULDBLOCK) {  // a file system without locks is taken as it is
    ::close(marker);
    RefuseAs(path, "a folder in which another run is at work");
  }
  return marker;
}

// Both words have one length, so that writing one over the other never leaves half of each.
void Mark(const fs::path& path, int marker, bool complete) {
  const std::string_view text = complete ? "merlin run: complete\n" : "merlin run: running \n";
  const ssize_t written = ::pwrite(marker, text.data(), text.size(), 0);
  if (written != static_cast<ssize_t>(text.size()))
    throw MachineError(fmt::format("{}: the marker cannot be written: {}", path.string(),
                                   std::strerror(written < 0 ? errno : ENOSPC)));
}

void Empty(const fs::path& path) {
  std::error_code error;
  fs::remove(path / "result.json", error);  // first: what is half removed is no finished run
  std::vector<fs::path> entries;
  for (const fs::directory_entry& entry : fs::directory_iterator(path, error)) entries.push_back(entry.path());
  if (error) Refuse(path, "cannot be read", error.value());
  for (const fs::path& entry : entries) {
    if (entry.filename() == OutputFolder::kMarker) continue;
    fs::remove_all(entry, error);
    if (error) Refuse(entry, "cannot be removed", error.value());
  }
}

}  // namespace

OutputFolder::OutputFolder(const fs::path& path) : path_(path) {
  if (path.empty()) throw InputError("--out", "is empty", "a folder's path");
  MakeFolder(path);
  const bool ours = IsOurs(path);
  if (::access(path.c_str(), W_OK | X_OK) != 0) Refuse(path, "cannot be written", errno);
  marker_ = OpenMarker(path);
  try {
    Mark(path, marker_, false);
    if (ours) Empty(path);
  } catch (...) {
    ::close(marker_);
    throw;
  }
}

OutputFolder::~OutputFolder() { ::close(marker_); }

void OutputFolder::Write(std::string_view name, std::string_view bytes) const { WriteFile(path_ / name, bytes); }

void OutputFolder::Finish(std::string_view result_json) {
  WriteFile(path_ / "result.json", result_json);
  Mark(path_, marker_, true);
}

}  // namespace merlin
