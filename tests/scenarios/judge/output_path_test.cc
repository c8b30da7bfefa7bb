#include "scenarios/judge/output_path.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <iterator>

#include "robot/base/error.h"
#include "tests/support/temporary_folder.h"

namespace merlin {
namespace {

namespace fs = std::filesystem;

void ExpectFileRefused(const fs::path& file, const std::string& reason) {
  try {
    CheckOutputFile(file);
    FAIL() << file << " was taken";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("--out"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
  }
}

TEST(CheckOutputFile, TakesANewFileAndOneToReplaceAndChangesNothing) {
  const TemporaryFolder folder;
  CheckOutputFile(folder.path() / "new.ply");
  EXPECT_TRUE(fs::is_empty(folder.path()));
  std::ofstream(folder.path() / "old.ply") << "old";
  std::ofstream(folder.path() / "old.ply.part") << "half";
  CheckOutputFile(folder.path() / "old.ply");
  EXPECT_EQ(Contents(folder.path() / "old.ply"), "old");
  EXPECT_EQ(Contents(folder.path() / "old.ply.part"), "half");
}

TEST(CheckOutputFile, RejectsAPathThatIsNotAFile) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "file") << "x";
  fs::create_directory(folder.path() / "folder");
  fs::create_symlink(folder.path() / "nowhere", folder.path() / "dangling");
  ASSERT_EQ(::mkfifo((folder.path() / "pipe").c_str(), 0600), 0);
  ExpectFileRefused("", "is empty");
  ExpectFileRefused(folder.path() / "folder", "a folder");
  ExpectFileRefused(folder.path() / "dangling", "a link that leads nowhere");
  ExpectFileRefused(folder.path() / "pipe", "a device or a pipe");
  ExpectFileRefused("/dev/full", "a device or a pipe");
  ExpectFileRefused(folder.path() / "file" / "below", "Not a directory");
  ExpectFileRefused(folder.path() / "none" / "below", "No such file");
  ExpectFileRefused(folder.path() / std::string(300, 'x'), "too long");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 4);
}

TEST(CheckOutputFile, RefusesWhereNobodyMayWrite) {
  if (!fs::is_directory("/proc/self")) GTEST_SKIP() << "no /proc here to stand for a folder nobody may write";
  ExpectFileRefused("/proc/a.ply", "cannot be written");
}

TEST(CheckOutputFile, RefusesWithoutPermission) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "file") << "x";
  fs::permissions(folder.path() / "file", fs::perms::owner_read);
  ExpectFileRefused(folder.path() / "file", "Permission denied");
  fs::permissions(folder.path(), fs::perms::owner_read | fs::perms::owner_exec);
  ExpectFileRefused(folder.path() / "new", "Permission denied");
  fs::permissions(folder.path(), fs::perms::owner_all);
}

}  // namespace
}  // namespace merlin
