// `merlin emulate`: what it rejects before the simulation starts. What it serves: two_programs_test.cc.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "tests/support/temporary_folder.h"
#include "tests/tools/command.h"

namespace merlin {
namespace {

void ExpectRefusal(const std::string& arguments, const std::string& sentence, const std::filesystem::path& folder) {
  const Outcome outcome = Merlin("emulate " + arguments, folder);
  EXPECT_EQ(outcome.code, 2) << arguments << "\n" << outcome.said;
  EXPECT_NE(outcome.said.find(sentence), std::string::npos) << arguments << "\n" << outcome.said;
}

TEST(EmulateCli, RefusesFilesThatItMayNotWriteAndTasksThatItCannotDo) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "mine.yaml") << "car: merlin\n";
  std::filesystem::create_directory(folder.path() / "folder");
  ExpectRefusal("corridor_short", "--hardware-file", folder.path());
  ExpectRefusal("corridor_short --hardware-file mine.yaml", "was not written by merlin emulate", folder.path());
  ExpectRefusal("corridor_short --hardware-file folder", "--hardware-file folder: cannot be used", folder.path());
  ExpectRefusal("corridor_short --hardware-file none/car.yaml", "--hardware-file none/car.yaml", folder.path());
  ExpectRefusal("corridor_short --hardware-file car.yaml --out folder", "--out folder", folder.path());
  ExpectRefusal("room_turn_180 --hardware-file car.yaml", "only the twin has a", folder.path());
  ExpectRefusal("corridor_shirt --hardware-file car.yaml", "corridor_short", folder.path());
  EXPECT_EQ(Contents(folder.path() / "mine.yaml"), "car: merlin\n");
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "car.yaml"));
}

}  // namespace
}  // namespace merlin
