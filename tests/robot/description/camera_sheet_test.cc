// The data sheets of the cameras: the values of ours, and the faults that the readers report.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "tests/robot/description/description_fixture.h"

namespace merlin {
namespace {

using namespace car_text;

TEST_F(Description, DepthCameraSheetIsThePmd3kS) {
  const DepthCameraSheet sheet = ReadDepthCameraSheet(Model("cameras/pmd_3k_s.yaml"));
  EXPECT_EQ(sheet.name, "pmd_3k_s");
  EXPECT_EQ(sheet.camera.width, 64);
  EXPECT_EQ(sheet.camera.height, 48);
  // The edge of the outer pixels, half a pixel beyond their centres, is at half the field of view: 20 and 15 deg.
  EXPECT_NEAR(std::atan2(63.5 - sheet.camera.cx_px, sheet.camera.fx_px), 20.0 * std::numbers::pi / 180.0, 1e-12);
  EXPECT_NEAR(std::atan2(-0.5 - sheet.camera.cy_px, sheet.camera.fy_px), -15.0 * std::numbers::pi / 180.0, 1e-12);
  EXPECT_EQ(sheet.camera.cx_px, 31.5);
  EXPECT_EQ(sheet.camera.cy_px, 23.5);
  EXPECT_EQ(sheet.rate_max_hz, 120.0);
  EXPECT_DOUBLE_EQ(sheet.latency_s, 0.020);
  EXPECT_EQ(sheet.signal_e_m2_per_us, 2000.0);
  EXPECT_EQ(sheet.contrast_at_20mhz, 0.45);
  EXPECT_DOUBLE_EQ(sheet.contrast_corner_hz, 30e6);
  EXPECT_EQ(sheet.read_noise_e, 200.0);
  EXPECT_EQ(sheet.full_well_e, 1.5e6);
  EXPECT_DOUBLE_EQ(sheet.readout_s, 1e-3);
  EXPECT_DOUBLE_EQ(sheet.integration_min_s, 100e-6);
  EXPECT_DOUBLE_EQ(sheet.integration_max_s, 5000e-6);
  EXPECT_EQ(sheet.frequencies_hz, (std::vector<double>{20e6, 30e6}));
  EXPECT_TRUE(sheet.sbi);
  EXPECT_GT(sheet.low_signal_amplitude_e, 0.0);
}

// Table 4.2 of the thesis. SBI: suppression of background illumination.
struct Model42 {
  const char* name;
  int width, height;
  double horizontal_deg, vertical_deg, rate_hz;
  bool sbi;
};
constexpr Model42 kTable42[] = {
    {"camcube_2", 204, 204, 40, 40, 25, true},  {"camcube_3", 200, 200, 40, 40, 40, true},
    {"pmd_19k_s", 160, 120, 40, 30, 15, false}, {"pmd_1k_s", 64, 16, 45, 16, 100, true},
    {"pmd_3k_s", 64, 48, 40, 30, 120, true},    {"pmd_3k_s_narrow", 64, 48, 10, 12.5, 120, true},
    {"pmd_41k_s", 204, 204, 40, 40, 25, true},  {"pmd_a2", 64, 16, 52, 18, 100, true},
    {"pmd_o3", 64, 48, 40, 30, 25, true},       {"pmd_s3", 64, 48, 40, 30, 20, true},
};

TEST_F(Description, DepthCameraSheetsAreThoseOfTable42) {
  for (const Model42& model : kTable42) {
    SCOPED_TRACE(model.name);
    const DepthCameraSheet sheet = ReadDepthCameraSheet(Model("cameras/" + std::string(model.name) + ".yaml"));
    EXPECT_EQ(sheet.name, model.name);
    EXPECT_EQ(sheet.camera.width, model.width);
    EXPECT_EQ(sheet.camera.height, model.height);
    const double deg = 180.0 / std::numbers::pi;
    EXPECT_NEAR(2.0 * deg * std::atan2(0.5 * model.width, sheet.camera.fx_px), model.horizontal_deg, 1e-9);
    EXPECT_NEAR(2.0 * deg * std::atan2(0.5 * model.height, sheet.camera.fy_px), model.vertical_deg, 1e-9);
    EXPECT_EQ(sheet.rate_max_hz, model.rate_hz);
    EXPECT_EQ(sheet.sbi, model.sbi);
  }
}

TEST_F(Description, EverySheetInTheFolderIsListedInTheTable) {
  std::set<std::string> listed{"ccd"}, found;
  for (const Model42& model : kTable42) listed.insert(model.name);
  for (const auto& entry : fs::directory_iterator(Model("cameras"))) found.insert(entry.path().stem().string());
  EXPECT_EQ(found, listed);
}

// The default of a scenario is one millisecond at 20 MHz.
TEST_F(Description, EveryDepthCameraTakesTheCommonSettingsAtItsFullRate) {
  for (const Model42& model : kTable42) {
    SCOPED_TRACE(model.name);
    const DepthCameraSheet sheet = ReadDepthCameraSheet(Model("cameras/" + std::string(model.name) + ".yaml"));
    EXPECT_NO_THROW(CheckSettings(sheet, DepthSettings{}));
    EXPECT_LE(4.0 * (1e-3 + sheet.readout_s), 1.0 / sheet.rate_max_hz);
  }
}

TEST_F(Description, TheA2SeesFortyMetres) {
  const DepthCameraSheet sheet = ReadDepthCameraSheet(Model("cameras/pmd_a2.yaml"));
  EXPECT_NEAR(UnambiguousRange_m(sheet.frequencies_hz[0]), 40.0, 0.05);
}

// K of the data sheets by the radiometry of a Lambertian surface: E_s = rho I tau / (4 F^2 d^2) on the chip, F/1.4.
TEST_F(Description, SignalsOfTheChipsGoWithPixelAreaAndLamp) {
  const auto of = [](const std::string& name) { return ReadDepthCameraSheet(Model("cameras/" + name + ".yaml")); };
  const auto lamp_w_per_sr = [](const std::string& name) {
    return ReadDepthCameraErrors(Model("cameras/" + name + ".yaml")).lamp_w_per_sr;
  };
  const double joule = 6.62607e-34 * kSpeedOfLight_m_s / 870e-9;
  const std::map<std::string, double> area_um2{
      {"pmd_1k_s", 155.3 * 210.8}, {"pmd_a2", 155.3 * 210.8}, {"pmd_3k_s", 1e4}, {"pmd_3k_s_narrow", 1e4},
      {"pmd_19k_s", 1600},         {"pmd_41k_s", 2025},       {"pmd_s3", 1e4},   {"pmd_o3", 1e4},
      {"camcube_2", 2025},         {"camcube_3", 2025}};
  for (const auto& [name, area] : area_um2) {
    const double computed = lamp_w_per_sr(name) * 0.7 / (4.0 * 1.4 * 1.4) * area * 1e-12 * 0.3 * 0.6 / joule * 1e-6;
    EXPECT_NEAR(of(name).signal_e_m2_per_us, 1.5 * computed, 0.06 * 1.5 * computed) << name;  // as rounded in the sheet
  }
}

TEST_F(Description, ErrorsOfADepthCameraAreItsSheetsOverTheDefaults) {
  for (const Model42& model : kTable42)
    EXPECT_TRUE(Validate(ReadDepthCameraErrors(Model("cameras/" + std::string(model.name) + ".yaml"))).empty())
        << model.name;
  const DepthCameraErrors cube = ReadDepthCameraErrors(Model("cameras/camcube_3.yaml"));
  EXPECT_EQ(cube.lamp_baseline_m, 0.12);
  EXPECT_EQ(cube.lamp_w_per_sr, 3.0);
  EXPECT_EQ(cube.harmonic_3, DepthCameraErrors{}.harmonic_3);
  const fs::path file = File("camera.yaml", WithErrors("  harmonic_3: 0.07\n  warmup_m: -0.01\n"));
  EXPECT_EQ(ReadDepthCameraErrors(file).harmonic_3, 0.07);
  EXPECT_EQ(ReadDepthCameraErrors(file).warmup_m, -0.01);
  EXPECT_EQ(ReadDepthCameraErrors(file).lamp_baseline_m, 0.0);
  EXPECT_EQ(ReadDepthCameraSheet(file).name, "pmd_3k_s");
}

TEST_F(Description, ASheetWithoutErrorsHasTheDefaults) {
  for (const std::string& text : {WithErrors(""), WithErrors("  {}\n"), pmd_.substr(0, pmd_.find("errors:"))}) {
    const DepthCameraErrors errors = ReadDepthCameraErrors(File("camera.yaml", text));
    EXPECT_EQ(errors.harmonic_3, DepthCameraErrors{}.harmonic_3);
    EXPECT_EQ(errors.lamp_baseline_m, DepthCameraErrors{}.lamp_baseline_m);
  }
}

TEST_F(Description, BothReadersRefuseBadErrorsWithAllFaultsAtOnce) {
  std::string text =
      WithErrors("  harmonic_3: 0.9\n  dead_share: 0.6\n  hot_share: many\n  lamp_baselin_m: 0.1\n  warmup_m: nan\n");
  text = Replaced(text, "full_well_e: 1.5e+6", "full_well_e: -1    ");
  const std::string sheet = DepthError(text);
  EXPECT_EQ(sheet, ErrorOf([&] { ReadDepthCameraErrors(File("camera.yaml", text)); }));
  for (const std::string key : {"harmonic_3", "dead_share", "hot_share", "warmup_m"})
    ExpectSays(sheet, {"camera.yaml:" + std::to_string(LineOf(text, key + ":")) + ": errors." + key + ": expected"});
  ExpectSays(sheet, {"camera.yaml:" + std::to_string(LineOf(text, "full_well_e:")) + ": full_well_e: expected"});
  ExpectSays(sheet, {"camera.yaml:" + std::to_string(LineOf(text, "lamp_baselin_m")) +
                     ": errors.lamp_baselin_m: unknown key; did you mean 'lamp_baseline_m'?"});
  EXPECT_EQ(std::count(sheet.begin(), sheet.end(), '\n'), 5);
}

TEST_F(Description, ErrorsMustBeAMap) {
  for (const std::string errors : {"errors: none\n", "errors: [1, 2]\n"})
    ExpectSays(DepthError(pmd_.substr(0, pmd_.find("errors:")) + errors),
               {"camera.yaml:", "errors: expected a map of keys"});
}

TEST_F(Description, ColourCameraSheetIsTable43) {
  const ColorCameraSheet sheet = ReadColorCameraSheet(Model("cameras/ccd.yaml"));
  EXPECT_EQ(sheet.name, "ccd");
  EXPECT_EQ(sheet.camera.width, 640);
  EXPECT_EQ(sheet.camera.height, 480);
  EXPECT_EQ(sheet.camera.fx_px, 780.037);
  EXPECT_EQ(sheet.camera.fy_px, 777.844);
  EXPECT_EQ(sheet.camera.cx_px, 353.244);
  EXPECT_EQ(sheet.camera.cy_px, 223.784);
  EXPECT_EQ(sheet.camera.k1, 0.024);
  EXPECT_EQ(sheet.camera.k2, 0.015);
  EXPECT_EQ(sheet.camera.p1, -0.006);
  EXPECT_EQ(sheet.camera.p2, 0.0109);
  EXPECT_EQ(sheet.rate_max_hz, 30.0);
  EXPECT_DOUBLE_EQ(sheet.latency_s, 0.050);
  EXPECT_LE(sheet.exposure_min_s, sheet.exposure_nominal_s);
  EXPECT_LE(sheet.exposure_nominal_s, sheet.exposure_max_s);
  EXPECT_GT(sheet.full_well_e, sheet.read_noise_e);
}

TEST_F(Description, SheetNamesTheNearestKeyAndItsLine) {
  const std::string text = Replaced(pmd_, "latency_ms", "latncy_ms");
  ExpectSays(DepthError(text), {"camera.yaml:" + std::to_string(LineOf(text, "latncy_ms")), "latncy_ms: unknown key",
                                "did you mean 'latency_ms'", "missing key 'latency_ms'"});
}

TEST_F(Description, SheetReportsEveryFaultAtOnce) {
  std::string text = Replaced(pmd_, "contrast_at_20mhz: 0.45", "contrast_at_20mhz: 1.45");
  text = Replaced(text, "read_noise_e: 200", "read_noise_e: nan");
  text = Replaced(text, "readout_ms: 1 ", "readout_ms: soon ");
  text = Replaced(text, "frequencies_mhz: [20, 30]", "frequencies_mhz: [20, -30]");
  text = Replaced(text, "width_px: 64 ", "width_px: 64.5 ");
  const std::string error = DepthError(text);
  for (const std::string key : {"contrast_at_20mhz", "read_noise_e", "readout_ms", "frequencies_mhz[1]", "width_px"})
    ExpectSays(error, {"camera.yaml:" + std::to_string(LineOf(text, "\n" + key.substr(0, key.find('['))) + 1) + ": " +
                       key + ": expected"});
  EXPECT_EQ(std::count(error.begin(), error.end(), '\n'), 4);
}

TEST_F(Description, SheetRefusesIntegrationTimesTheWrongWayRound) {
  ExpectSays(DepthError(Replaced(pmd_, "integration_min_us: 100 ", "integration_min_us: 6000 ")),
             {"integration_min_us"});
}

TEST_F(Description, SheetRefusesValuesThatContradictEachOther) {
  const auto expect = [this](const std::string& from, const std::string& to, const std::string& what) {
    const std::string text = Replaced(pmd_, from, to), error = DepthError(text);
    ExpectSays(error, {"camera.yaml:" + std::to_string(LineOf(text, to)) + ":", what});
    EXPECT_EQ(std::count(error.begin(), error.end(), '\n'), 0) << error;
  };
  expect("frequencies_mhz: [20, 30]", "frequencies_mhz: [20, 30, 20.0]", "lists one twice");
  expect("frequencies_mhz: [20, 30]", "frequencies_mhz: []", "expected one frequency at least");
  expect("full_well_e: 1.5e+6", "full_well_e: 200", "full_well_e: is not above read_noise_e");
  // 4 x 0.1 ms and three times 1 ms of read-out are 3.4 ms: 294.1 Hz.
  expect("rate_max_hz: 120", "rate_max_hz: 295",
         "rate_max_hz: the four sub-frames of the shortest exposure take 3.4 ms");
  EXPECT_EQ(DepthError(Replaced(pmd_, "rate_max_hz: 120", "rate_max_hz: 294")), "");
  EXPECT_EQ(DepthError(Replaced(pmd_, "integration_min_us: 100 ", "integration_min_us: 1300 ")), "");
  EXPECT_EQ(DepthError(Replaced(pmd_, "full_well_e: 1.5e+6", "full_well_e: 201")), "");
}

// A value that is wrong on its own is one fault, not two.
TEST_F(Description, WrongValuesContradictNothing) {
  const std::string error = DepthError(Replaced(pmd_, "full_well_e: 1.5e+6", "full_well_e: much"));
  EXPECT_EQ(std::count(error.begin(), error.end(), '\n'), 0) << error;
}

TEST_F(Description, SheetSaysWhetherTheChipSuppressesBackgroundLight) {
  EXPECT_FALSE(ReadDepthCameraSheet(File("camera.yaml", Replaced(pmd_, "sbi: true", "sbi: false"))).sbi);
  ExpectSays(DepthError(Replaced(pmd_, "sbi: true", "sbi: 3")), {"sbi: expected true or false, got '3'"});
  ExpectSays(DepthError(Replaced(pmd_, "sbi: true", "sbi: [true]")), {"sbi: expected true or false"});
  ExpectSays(DepthError(Replaced(pmd_, "sbi: true", "# none  ")), {"missing key 'sbi'"});
}

TEST_F(Description, SheetRefusesWhatIsNoSheet) {
  ExpectSays(ErrorOf([] { ReadColorCameraSheet("/nowhere/ccd.yaml"); }), {"/nowhere/ccd.yaml", "cannot be read"});
  ExpectSays(ColorError(""), {"camera.yaml"});
  ExpectSays(ColorError("- 1\n- 2\n"), {"camera.yaml", "map"});
  ExpectSays(ColorError("name: x\nwidth_px: [1\n"), {"camera.yaml:", "YAML"});
  ExpectSays(ColorError(Replaced(ccd_, "fx_px: 780.037", "fx_px: {a: 1}")), {"fx_px: expected"});
  ExpectSays(DepthError(ccd_), {"missing key 'signal_e_m2_per_us'", "fx_px: unknown key"});
}

}  // namespace
}  // namespace merlin
