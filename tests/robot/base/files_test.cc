#include "robot/base/files.h"

#include <gtest/gtest.h>

#include "robot/base/error.h"
#include "tests/support/temporary_folder.h"

namespace merlin {
namespace {

TEST(Files, AreReadAsTheyWereWritten) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "f";
  for (const std::string& bytes : {std::string(), std::string("\0\n\r\xFF", 4), std::string(3'000'000, 'x')}) {
    WriteFile(file, bytes);
    EXPECT_EQ(ReadFile(file, "a file"), bytes);
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "f.part"));
  }
}

TEST(Files, WhatCannotBeReadIsNamed) {
  for (const std::string path : {"/no/such/file", "/tmp", ""}) {
    try {
      ReadFile(path, "a file");
      FAIL() << path;
    } catch (const InputError& error) {
      EXPECT_EQ(error.what(), path + ": cannot be read; expected a file");
    }
  }
}

TEST(Files, WhatCannotBeWrittenLeavesTheOldFile) {
  EXPECT_THROW(WriteFile("/no/such/folder/f", "x"), MachineError);
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "f");
  EXPECT_THROW(WriteFile(folder.path() / "f", "x"), MachineError);
  EXPECT_TRUE(std::filesystem::is_directory(folder.path() / "f"));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "f.part"));
}

}  // namespace
}  // namespace merlin
