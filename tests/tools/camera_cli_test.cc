// `merlin camera` and `merlin bench` as users run them.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "tests/support/temporary_folder.h"
#include "tests/tools/command.h"

namespace merlin {
namespace {

// Expects exit code 2, one sentence with this part, and no file.
void ExpectRefused(const std::string& arguments, const std::string& part, const std::filesystem::path& folder) {
  const Outcome outcome = Merlin("camera " + arguments, folder);
  EXPECT_EQ(outcome.code, 2) << arguments << "\n" << outcome.said;
  EXPECT_NE(outcome.said.find(part), std::string::npos) << arguments << "\n" << outcome.said;
  EXPECT_EQ(std::ranges::count(outcome.said, '\n'), 1) << arguments << "\n" << outcome.said;
  EXPECT_FALSE(std::filesystem::exists(folder / "runs")) << arguments;
}

nlohmann::json Json(const std::string& arguments, const std::filesystem::path& folder) {
  const Outcome outcome = Merlin("camera " + arguments + " --json", folder, "2>said");
  EXPECT_EQ(outcome.code, 0) << arguments << "\n" << outcome.said << Contents(folder / "said");
  return nlohmann::json::parse(outcome.said, nullptr, false);
}

// The header of an array file up to the data.
std::string NpyHeader(const std::filesystem::path& file) {
  const std::string bytes = Contents(file);
  return bytes.substr(0, bytes.find('\n'));
}

TEST(CameraCli, RefusesBadInputWithOneSentenceAndNoFile) {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& arguments, const std::string& part) {
    ExpectRefused(arguments, part, folder.path());
  };
  refused("pmd_3k --wall 2", "pmd_3k_s");
  refused("pmd_3k_s", "neither");
  refused("pmd_3k_s --wall 2 --room hall --pose 0,0,1,0,0,0", "both");
  refused("pmd_3k_s --wall 2 --effects nois", "noise");
  refused("pmd_3k_s --wall 2 --albedo 1.01", "--albedo");
  refused("pmd_3k_s --wall 2 --albedo -0.1", "--albedo");
  refused("pmd_3k_s --wall 2 --albedo nan", "--albedo");
  for (const char* distance : {"0", "-1", "nan", "inf"}) refused(std::string("pmd_3k_s --wall ") + distance, "--wall");
  for (const char* tilt : {"90", "-89.5", "nan"})
    refused(std::string("pmd_3k_s --wall 2 --tilt-deg ") + tilt, "--tilt-deg");
  for (const char* time : {"9000", "99", "0", "-5", "nan"})
    refused(std::string("pmd_3k_s --wall 2 --integration-us ") + time, "integration");
  for (const char* mhz : {"25", "20+25", "20+20"})
    refused(std::string("pmd_3k_s --wall 2 --frequency-mhz ") + mhz, "frequenc");
  for (const char* mhz : {"x", "nan", "20+", "20+30+20", "''"})
    refused(std::string("pmd_3k_s --wall 2 --frequency-mhz ") + mhz, "--frequency-mhz");
  refused("pmd_3k_s --wall 2 --sun -1", "--sun");
  refused("pmd_3k_s --wall 2 --frames 0", "--frames");
  refused("pmd_3k_s --wall 2 --seed -1", "--seed");
  refused("pmd_3k_s --wall 2 --seed 1.5", "--seed");
  refused("pmd_3k_s --study wigling", "wiggling");
  refused("pmd_3k_s --study noise --wall 2", "--wall");
  refused("pmd_3k_s --study noise --effects all", "--effects");
}

TEST(CameraCli, SaysWhatASheetIsThatIsNoTimeOfFlightCamera) {
  const TemporaryFolder folder;
  const std::string expected = "expected a time-of-flight camera, such as ";
  ExpectRefused("ccd --wall 2", "ccd: this is a colour camera; " + expected, folder.path());
  ExpectRefused("ccd --study noise", "ccd: this is a colour camera", folder.path());
  std::ofstream(folder.path() / "webcam.yaml")
      << "name: webcam\nwidth_px: 640\nheight_px: 480\nfx_px: 500\nfy_px: 500\n";
  ExpectRefused("webcam.yaml --wall 2", "webcam.yaml: this is a colour camera; " + expected, folder.path());
  std::ofstream(folder.path() / "drive.yaml") << "name: drive\nroom: hall\nduration_s: 5\n";
  ExpectRefused("drive.yaml --wall 2", "drive.yaml: this is no camera; " + expected, folder.path());
  // A data sheet of the right kind is read key by key, as before.
  std::ofstream(folder.path() / "half.yaml") << "name: half\nwidth_px: 64\nfrequencies_mhz: [20]\n";
  const Outcome outcome = Merlin("camera half.yaml --wall 2", folder.path());
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.said.find("missing key 'height_px'"), std::string::npos) << outcome.said;
}

TEST(CameraCli, RefusesPosesAndRoomsThatShowNothing) {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& arguments, const std::string& part) {
    ExpectRefused(arguments, part, folder.path());
  };
  refused("pmd_3k_s --room hal --pose 0,0,1,0,0,0", "hall");
  refused("pmd_3k_s --room hall", "--pose");
  for (const char* pose : {"0,0,1,0,0", "0,0,1,0,0,0,0", "nan,0,1,0,0,0", "0,0,inf,0,0,0", "a,0,1,0,0,0", "''"})
    refused(std::string("pmd_3k_s --room hall --pose ") + pose, "--pose");
  refused("pmd_3k_s --room hall --pose 3.1,0,1,0,0,0", "'wall_east'");
  refused("pmd_3k_s --room hall --pose 1.7,1.1,0.3,0,0,0", "'ball'");
  refused("pmd_3k_s --room hall --pose 0,0,-0.5,0,0,0", "'floor'");
  refused("pmd_3k_s --room hall --pose 0,0,1,0,0,0 --curtain closed", "curtain");
  refused("pmd_3k_s --room hall --pose 0,0,1,0,0,0 --albedo 0.5", "--albedo");
  std::ofstream(folder.path() / "broken.xml")
      << "<mujoco>\n<worldbody>\n<geom type='ball'/>\n</worldbody>\n</mujoco>\n";
  refused("pmd_3k_s --room broken.xml --pose 0,0,1,0,0,0", "broken.xml:3");
  std::ofstream(folder.path() / "empty.xml")
      << "<mujoco><worldbody><geom type='sphere' size='1' rgba='0 0 0 0'/></worldbody></mujoco>";
  refused("pmd_3k_s --room empty.xml --pose 0,0,1,0,0,0", "empty room");
  std::ofstream(folder.path() / "nan.xml")
      << "<mujoco><worldbody><geom type='box' size='1 1 1' pos='nan 0 0'/></worldbody></mujoco>";
  refused("pmd_3k_s --room nan.xml --pose 0,0,1,0,0,0", "nan.xml");
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "MUJOCO_LOG.TXT"));
}

TEST(CameraCli, KeepsAFolderThatIsNotOurs) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "mine");
  std::ofstream(folder.path() / "mine/letter.txt") << "dear";
  ExpectRefused("pmd_3k_s --wall 2 --frames 1 --out mine", "mine", folder.path());
  EXPECT_EQ(Contents(folder.path() / "mine/letter.txt"), "dear");
}

TEST(CameraCli, SaysAloudWhatNearestChanged) {
  const TemporaryFolder folder;
  const auto json =
      Json("pmd_3k_s --wall 2 --frames 2 --nearest --integration-us 9000 --frequency-mhz 27", folder.path());
  EXPECT_DOUBLE_EQ(json["settings"]["integration_s"].get<double>(), 5e-3);
  EXPECT_DOUBLE_EQ(json["settings"]["frequencies_hz"][0].get<double>(), 30e6);
  const std::string said = Contents(folder.path() / "said");
  EXPECT_NE(said.find("5000 us instead of 9000 us"), std::string::npos) << said;
  EXPECT_NE(said.find("30 MHz instead of 27 MHz"), std::string::npos) << said;
}

TEST(CameraCli, JsonHasTheKeysThatToolsReadAndTheWallIsWhereItIs) {
  const TemporaryFolder folder;
  const auto json = Json("pmd_3k_s --wall 2 --effects ideal --frames 3", folder.path());
  std::set<std::string> keys;
  for (const auto& [key, value] : json.items()) keys.insert(key);
  EXPECT_EQ(keys, (std::set<std::string>{"model", "settings", "center", "middle", "valid_share", "saturated_share",
                                         "amplitude_mean", "frame_ms"}));
  EXPECT_EQ(json["center"]["samples"], 3);
  EXPECT_EQ(json["middle"]["samples"], 3 * 22 * 16);
  EXPECT_NEAR(json["center"]["range_mean_m"].get<double>(), 2.0, 1e-3);
  EXPECT_EQ(json["center"]["range_sigma_m"].get<double>(), 0.0);
  EXPECT_EQ(json["valid_share"].get<double>(), 1.0);
  EXPECT_EQ(json["saturated_share"].get<double>(), 0.0);
  EXPECT_GT(json["frame_ms"].get<double>(), 0.0);
  EXPECT_EQ(nlohmann::json::parse(Contents(folder.path() / "runs/camera-pmd_3k_s/result.json")), json);
}

TEST(CameraCli, WallBeyondTheUnambiguousRangeReadsNear) {
  const TemporaryFolder folder;
  const auto json = Json("pmd_3k_s --wall 9 --effects ideal --frames 1 --out o", folder.path());
  EXPECT_NEAR(json["center"]["range_mean_m"].get<double>(), 9.0 - 299792458.0 / 40e6, 2e-3);
  EXPECT_TRUE(json["center"]["range_sigma_m"].is_null());  // one frame says nothing about time
  const auto two = Json("pmd_3k_s --wall 9 --effects ideal --frames 1 --frequency-mhz 20+30 --out o", folder.path());
  EXPECT_NEAR(two["center"]["range_mean_m"].get<double>(), 9.0, 2e-3);
}

TEST(CameraCli, WritesEveryFileWithTheRightShape) {
  const TemporaryFolder folder;
  const Outcome outcome = Merlin("camera pmd_3k_s --room hall --pose 0,0,1,0,0,0.3 --frames 2 --out o", folder.path());
  ASSERT_EQ(outcome.code, 0) << outcome.said;
  const std::filesystem::path o = folder.path() / "o";
  const auto shape = [&](const char* name, const char* type, const std::string& tuple) {
    const std::string header = NpyHeader(o / name);
    EXPECT_NE(header.find(type), std::string::npos) << name;
    EXPECT_NE(header.find("(" + tuple + ", )"), std::string::npos) << name << ": " << header.substr(10);
  };
  shape("phase_images.npy", "'<f4'", "4, 2, 48, 64");
  shape("range.npy", "'<f4'", "48, 64");
  shape("amplitude.npy", "'<f4'", "48, 64");
  shape("intensity.npy", "'|u1'", "48, 64");
  shape("flags.npy", "'|u1'", "48, 64");
  for (const char* name : {"truth_range.npy", "truth_depth.npy", "truth_sigma.npy"}) shape(name, "'<f4'", "48, 64");
  for (const char* name : {"truth_geom.npy", "truth_material.npy"}) shape(name, "'<i4'", "48, 64");
  shape("truth_mixed.npy", "'|u1'", "48, 64");
  shape("truth_T_world_optical.npy", "'<f8'", "4, 4, 4");
  shape("bias_multipath.npy", "'<f4'", "48, 64");
  EXPECT_EQ(Contents(o / "range.png").substr(12, 13),
            std::string("IHDR\0\0\0\x40\0\0\0\x30\x10", 13));  // 64 x 48, 16 bit
  EXPECT_EQ(Contents(o / "picture.png").substr(1, 3), "PNG");
  EXPECT_EQ(Contents(o / "cloud.ply").substr(0, 3), "ply");
  EXPECT_TRUE(std::filesystem::exists(o / "result.json"));
}

TEST(CameraCli, SameSeedSameBytesForAnyNumberOfThreads) {
  const TemporaryFolder folder;
  const std::string scene = "camera pmd_3k_s --room hall --pose 0,0,1,0,0,0.3 --frames 2 ";
  for (const char* more :
       {"--seed 7 --threads 1 --out a", "--seed 7 --threads 2 --out b", "--seed 8 --threads 2 --out c"})
    ASSERT_EQ(Merlin(scene + more, folder.path()).code, 0);
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path() / "a")) {
    const std::string name = entry.path().filename();
    if (name == "result.json") continue;  // contains the time that it took
    EXPECT_TRUE(Contents(entry.path()) == Contents(folder.path() / "b" / name)) << name;
    ++files;
  }
  EXPECT_GT(files, 14);
  EXPECT_FALSE(Contents(folder.path() / "a/phase_images.npy") == Contents(folder.path() / "c/phase_images.npy"));
}

TEST(CameraCli, DrawsAStudyWithItsNumbers) {
  const TemporaryFolder folder;
  const Outcome outcome = Merlin("camera pmd_3k_s --study motion --out o", folder.path());
  ASSERT_EQ(outcome.code, 0) << outcome.said;
  EXPECT_EQ(Contents(folder.path() / "o/study_motion.png").substr(1, 3), "PNG");
  EXPECT_NE(Contents(folder.path() / "o/study_motion.csv").find("panel,series,kind,x,y\n"), std::string::npos);
}

}  // namespace
}  // namespace merlin
