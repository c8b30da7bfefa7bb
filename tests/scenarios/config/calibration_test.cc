#include "scenarios/config/calibration.h"

#include <gtest/gtest.h>

#include <fstream>

#include "robot/base/error.h"
#include "tests/support/temporary_folder.h"

namespace merlin {
namespace {

constexpr char kGood[] =
    "straights:\n"
    "  - {encoder_counts: 74112, distance_m: 5.003}\n"
    "circles:\n"
    "  - {steering_rad: 0.25, diameter_m: 2.6}\n"
    "  - {steering_rad: -0.25, diameter_m: 2.6}\n";

class File {
 public:
  explicit File(const std::string& text) : path_(folder_.path() / "f.yaml") { std::ofstream(path_) << text; }
  const std::filesystem::path& path() const { return path_; }

 private:
  TemporaryFolder folder_;
  std::filesystem::path path_;
};

template <class Read>
std::string ReadComplaint(Read read, const std::string& text) {
  const File file(text);
  try {
    read(file.path());
  } catch (const InputError& error) {
    return error.what();
  }
  return "no complaint";
}

void ExpectSays(const std::string& said, const std::string& part) {
  EXPECT_NE(said.find(part), std::string::npos) << "'" << part << "' is not in: " << said;
}

std::string Replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

TEST(Drives, AreReadAsTheyAreWritten) {
  const MeasuredDrives drives = ReadDrives(File(kGood).path());
  ASSERT_EQ(drives.straights.size(), 1u);
  ASSERT_EQ(drives.circles.size(), 2u);
  EXPECT_EQ(drives.straights[0].encoder_counts, 74112);
  EXPECT_EQ(drives.straights[0].distance_m, 5.003);
  EXPECT_EQ(drives.circles[1].steering_rad, -0.25);
  EXPECT_EQ(drives.circles[1].diameter_m, 2.6);
}

TEST(Drives, NameWhatIsWrongWithThem) {
  const auto said = [](const std::string& from, const std::string& to) {
    return ReadComplaint(ReadDrives, Replaced(kGood, from, to));
  };
  ExpectSays(said("distance_m", "distanz_m"),
             "f.yaml:2: straights[0].distanz_m: unknown key; did you mean 'distance_m'?");
  ExpectSays(said("5.003", "-5.003"), "straights[0].distance_m: expected a number in [0.5, 1000], got '-5.003'");
  ExpectSays(said("2.6", ".nan"), "circles[0].diameter_m");
  ExpectSays(said("74112", "12.5"), "expected a whole number");
  ExpectSays(said(", distance_m: 5.003", ""), "f.yaml:2: straights[0]: missing key 'distance_m'");
  ExpectSays(said("steering_rad: -0.25, ", ""), "f.yaml:5: circles[1]: missing key 'steering_rad'");
  ExpectSays(said("circles", "circels"), "missing key 'circles'");
  ExpectSays(said("{encoder", "encoder"), "f.yaml:");
  ExpectSays(ReadComplaint(ReadDrives, ""), "a file of measured drives");
  EXPECT_THROW(ReadDrives("/no/such/file.yaml"), InputError);
}

TEST(Calibration, SurvivesBeingWrittenOut) {
  const CarCalibration written{.wheel_radius_m = 0.0541, .wheelbase_m = 0.3333, .steering_offset_rad = -0.0123};
  const CarCalibration read = ReadCalibration(File(ToYaml(written)).path());
  EXPECT_EQ(read.wheel_radius_m, written.wheel_radius_m);
  EXPECT_EQ(read.wheelbase_m, written.wheelbase_m);
  EXPECT_EQ(read.steering_offset_rad, written.steering_offset_rad);
}

TEST(Calibration, NamesWhatIsWrongWithIt) {
  const std::string good = ToYaml(CarCalibration{});
  const auto said = [&](const std::string& from, const std::string& to) {
    return ReadComplaint(ReadCalibration, Replaced(good, from, to));
  };
  ExpectSays(said("wheelbase_m", "wheelbase"), "missing key 'wheelbase_m'");
  ExpectSays(said("wheelbase_m", "wheelbase"), "did you mean 'wheelbase_m'?");
  ExpectSays(said("0.33", "-0.33"), "wheelbase_m: expected a number in");
  ExpectSays(said("0.055", "inf"), "wheel_radius_m");
}

}  // namespace
}  // namespace merlin
