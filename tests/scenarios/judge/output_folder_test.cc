#include "scenarios/judge/output_folder.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <set>

#include "robot/base/error.h"
#include "scenarios/judge/writers.h"
#include "tests/support/temporary_folder.h"

namespace merlin {
namespace {

namespace fs = std::filesystem;

const fs::path kMarker = OutputFolder::kMarker;

std::set<std::string> Names(const fs::path& path) {
  std::set<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(path)) names.insert(entry.path().filename().string());
  return names;
}

// Expects an InputError, and that nothing in the folder has changed.
void ExpectRefused(const fs::path& path, const std::string& reason) {
  const bool is_folder = fs::is_directory(path);
  const std::set<std::string> before = is_folder ? Names(path) : std::set<std::string>{};
  try {
    const OutputFolder folder(path);
    FAIL() << path << " was taken";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("--out"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
  }
  if (is_folder) {
    EXPECT_EQ(Names(path), before);
  }
}

TEST(OutputFolder, MakesAFolderWithItsParentsAndMarksItFirst) {
  const TemporaryFolder temporary;
  const fs::path path = temporary.path() / "a" / "b";
  OutputFolder folder(path);
  EXPECT_EQ(Names(path), std::set<std::string>{kMarker});
  EXPECT_EQ(Contents(path / kMarker), "merlin run: running \n");
  folder.Write("map.ply", "points");
  folder.Finish("{}");
  EXPECT_EQ(Names(path), (std::set<std::string>{kMarker, "map.ply", "result.json"}));
  EXPECT_EQ(Contents(path / "map.ply"), "points");
  EXPECT_EQ(Contents(path / "result.json"), "{}");
  EXPECT_EQ(Contents(path / kMarker), "merlin run: complete\n");
}

TEST(OutputFolder, UsesAnEmptyFolder) {
  const TemporaryFolder temporary;
  const OutputFolder folder(temporary.path());
  EXPECT_EQ(Names(temporary.path()), std::set<std::string>{kMarker});
}

TEST(OutputFolder, LeavesNoResultWhenARunBreaksOff) {
  const TemporaryFolder temporary;
  { OutputFolder(temporary.path()).Write("map.ply", "points"); }
  EXPECT_FALSE(fs::exists(temporary.path() / "result.json"));
  EXPECT_EQ(Contents(temporary.path() / kMarker), "merlin run: running \n");
}

TEST(OutputFolder, ReplacesAnOlderRunWhole) {
  const TemporaryFolder temporary;
  const fs::path outside = temporary.path() / "outside", path = temporary.path() / "run";
  fs::create_directory(outside);
  WriteFile(outside / "precious", "kept");
  {
    OutputFolder older(path);
    older.Write("map.ply", "old");
    fs::create_directories(path / "frames" / "deep");
    WriteFile(path / "frames" / "deep" / "1.png", "old");
    fs::create_directory_symlink(outside, path / "link");
    older.Finish("{}");
  }
  const OutputFolder newer(path);
  EXPECT_EQ(Names(path), std::set<std::string>{kMarker});
  EXPECT_EQ(Contents(path / kMarker), "merlin run: running \n");
  EXPECT_EQ(Contents(outside / "precious"), "kept");  // files behind a link do not belong to the run
}

TEST(OutputFolder, ReplacesARunThatBrokeOffEvenBeforeItsMarkWasWritten) {
  const TemporaryFolder temporary;
  WriteFile(temporary.path() / kMarker, "");
  WriteFile(temporary.path() / "map.ply.part", "half");
  const OutputFolder folder(temporary.path());
  EXPECT_EQ(Names(temporary.path()), std::set<std::string>{kMarker});
}

TEST(OutputFolder, ChecksWithoutChangingAnything) {
  const TemporaryFolder temporary;
  const fs::path path = temporary.path() / "a" / "b";
  OutputFolder::Check(path);
  EXPECT_TRUE(fs::is_empty(temporary.path()));
  OutputFolder::Check(temporary.path());
  EXPECT_TRUE(fs::is_empty(temporary.path()));
  {
    OutputFolder folder(path);
    EXPECT_THROW(OutputFolder::Check(path), InputError);  // in use by a run
    folder.Write("map.ply", "points");
    folder.Finish("{}");
  }
  OutputFolder::Check(path);
  EXPECT_EQ(Names(path), (std::set<std::string>{kMarker, "map.ply", "result.json"}));
  EXPECT_EQ(Contents(path / kMarker), "merlin run: complete\n");
}

TEST(OutputFolder, RefusesAFolderOfSomeoneElse) {
  const TemporaryFolder temporary;
  WriteFile(temporary.path() / "thesis.tex", "years of work");
  ExpectRefused(temporary.path(), "a folder with other files in it");
  EXPECT_EQ(Contents(temporary.path() / "thesis.tex"), "years of work");
}

TEST(OutputFolder, RefusesAFolderThatOnlyHoldsRuns) {
  const TemporaryFolder temporary;
  { const OutputFolder inner(temporary.path() / "corridor-1"); }
  ExpectRefused(temporary.path(), "a folder with other files in it");
}

TEST(OutputFolder, DoesNotTakeAFolderOrALinkForAMarker) {
  const TemporaryFolder temporary;
  fs::create_directories(temporary.path() / "a" / kMarker);
  ExpectRefused(temporary.path() / "a", "a folder with other files in it");
  fs::create_directory(temporary.path() / "b");
  fs::create_symlink("/etc/hostname", temporary.path() / "b" / kMarker);
  ExpectRefused(temporary.path() / "b", "a folder with other files in it");
}

TEST(OutputFolder, RejectsAPathThatIsNotAFolder) {
  const TemporaryFolder temporary;
  WriteFile(temporary.path() / "file", "x");
  ExpectRefused(temporary.path() / "file", "something that is not a folder");
  ExpectRefused(temporary.path() / "file" / "below", "Not a directory");
  fs::create_symlink(temporary.path() / "nowhere", temporary.path() / "dangling");
  ExpectRefused(temporary.path() / "dangling", "a link that leads nowhere");
  ExpectRefused("", "is empty");
  EXPECT_EQ(Contents(temporary.path() / "file"), "x");
}

TEST(OutputFolder, FollowsALinkToAFolder) {
  const TemporaryFolder temporary;
  fs::create_directory(temporary.path() / "real");
  fs::create_directory_symlink(temporary.path() / "real", temporary.path() / "link");
  OutputFolder(temporary.path() / "link").Finish("{}");
  EXPECT_TRUE(fs::exists(temporary.path() / "real" / "result.json"));
  EXPECT_TRUE(fs::is_symlink(temporary.path() / "link"));
}

TEST(OutputFolder, RefusesAFolderInWhichARunIsAtWork) {
  const TemporaryFolder temporary;
  const OutputFolder first(temporary.path());
  first.Write("map.ply", "points");
  ExpectRefused(temporary.path(), "another run is at work");
  EXPECT_EQ(Contents(temporary.path() / "map.ply"), "points");
}

TEST(OutputFolder, RefusesWhereNobodyMayWrite) {
  if (!fs::is_directory("/proc/self")) GTEST_SKIP() << "no /proc here to stand for a folder nobody may write";
  ExpectRefused("/proc/merlin-run", "cannot be made");
}

TEST(OutputFolder, RefusesAFolderWithoutPermission) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  const TemporaryFolder temporary;
  fs::permissions(temporary.path(), fs::perms::owner_read | fs::perms::owner_exec);
  ExpectRefused(temporary.path(), "cannot be written");
  ExpectRefused(temporary.path() / "below", "cannot be made");
  fs::permissions(temporary.path(), fs::perms::owner_all);
}

TEST(OutputFolder, HasNoResultWhenTheDiskFillsUpAtTheEnd) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here to stand for a full disk";
  const TemporaryFolder temporary;
  OutputFolder folder(temporary.path());
  fs::create_symlink("/dev/full", temporary.path() / "result.json.part");
  EXPECT_THROW(folder.Finish("{}"), MachineError);
  EXPECT_EQ(Names(temporary.path()), std::set<std::string>{kMarker});
  EXPECT_EQ(Contents(temporary.path() / kMarker), "merlin run: running \n");
}

}  // namespace
}  // namespace merlin
