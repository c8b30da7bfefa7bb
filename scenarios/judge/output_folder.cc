#include "scenarios/judge/output_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>
#include <system_error>
#include <vector>

#include "robot/base/error.h"
#include "scenarios/judge/output_path.h"
#include "scenarios/judge/writers.h"

namespace merlin {
namespace {

namespace fs = std::filesystem;

constexpr char kExpected[] = "an empty folder, a new one, or one that a run of merlin left";

// Whether the folder exists. Throws if the path is something else.
bool IsThere(const fs::path& path) {
  if (path.empty()) throw InputError("--out", "is empty", "a folder's path");
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::is_directory(status)) return true;
  if (fs::is_symlink(fs::symlink_status(path, error)) && !fs::exists(status))
    RefuseOutput(path, kExpected, "a link that leads nowhere");
  if (fs::status_known(status) && fs::exists(status)) RefuseOutput(path, kExpected, "something that is not a folder");
  return false;
}

// The folder itself or the nearest of its parents that exists.
fs::path NearestThatIsThere(const fs::path& path) {
  fs::path nearest = fs::absolute(path);
  std::error_code error;
  for (; !fs::exists(fs::status(nearest, error)) && nearest != nearest.root_path(); nearest = nearest.parent_path()) {
    if (error && error != std::errc::no_such_file_or_directory && error != std::errc::not_a_directory)
      RefuseOutput(path, "cannot be made", error.value());
  }
  return nearest;
}

// Only an attempt shows whether a folder is writable: a file system may be read-only, and in /proc even root cannot
// write.
void TryToWriteIn(const fs::path& folder, const fs::path& path) {
  std::string attempt = (folder / ".merlin-XXXXXX").string();
  if (::mkdtemp(attempt.data()) == nullptr)
    RefuseOutput(path, folder == fs::absolute(path) ? "cannot be written" : "cannot be made", errno);
  ::rmdir(attempt.c_str());
}

// Whether it is the output of an earlier run. Throws for a folder with other files.
bool IsOurs(const fs::path& path) {
  std::error_code error;
  if (fs::is_regular_file(fs::symlink_status(path / OutputFolder::kMarker, error))) return true;
  const bool is_empty = fs::is_empty(path, error);
  if (error) RefuseOutput(path, "cannot be read", error.value());
  if (!is_empty) RefuseOutput(path, kExpected, "a folder with other files in it");
  return false;
}

int OpenMarker(const fs::path& path) {
  const int marker = ::open((path / OutputFolder::kMarker).c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0644);
  if (marker < 0) RefuseOutput(path, "cannot be written", errno);
  if (::flock(marker, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {  // a file system without locks is accepted
    ::close(marker);
    RefuseOutput(path, kExpected, "a folder in which another run is at work");
  }
  return marker;
}

// Both texts have the same length, so that one can overwrite the other without leaving a mixture.
void Mark(const fs::path& path, int marker, bool complete) {
  const std::string_view text = complete ? "merlin run: complete\n" : "merlin run: running \n";
  const ssize_t written = ::pwrite(marker, text.data(), text.size(), 0);
  if (written != static_cast<ssize_t>(text.size()))
    throw MachineError(fmt::format("{}: the marker cannot be written: {}", path.string(),
                                   std::strerror(written < 0 ? errno : ENOSPC)));
}

void Empty(const fs::path& path) {
  std::error_code error;
  fs::remove(path / "result.json", error);  // first, so that a half-emptied folder does not look like a finished run
  std::vector<fs::path> entries;
  for (const fs::directory_entry& entry : fs::directory_iterator(path, error)) entries.push_back(entry.path());
  if (error) RefuseOutput(path, "cannot be read", error.value());
  for (const fs::path& entry : entries) {
    if (entry.filename() == OutputFolder::kMarker) continue;
    fs::remove_all(entry, error);
    if (error) RefuseOutput(entry, "cannot be removed", error.value());
  }
}

}  // namespace

void OutputFolder::Check(const fs::path& path) {
  if (IsThere(path) && IsOurs(path)) ::close(OpenMarker(path));
  TryToWriteIn(NearestThatIsThere(path), path);
}

OutputFolder::OutputFolder(const fs::path& path) : path_(path) {
  Check(path);
  std::error_code error;
  fs::create_directories(path, error);
  if (error) RefuseOutput(path, "cannot be made", error.value());
  const bool ours = IsOurs(path);
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
