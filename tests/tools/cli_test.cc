// The program as users run it: exit codes, messages of one sentence, no half-written files.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/support/temporary_folder.h"
#include "tests/tools/command.h"

namespace merlin {
namespace {

void ExpectRefused(const std::string& arguments, const std::string& part, const std::filesystem::path& folder) {
  const Outcome outcome = Merlin(arguments, folder);
  EXPECT_EQ(outcome.code, 2) << arguments << "\n" << outcome.said;
  EXPECT_NE(outcome.said.find(part), std::string::npos) << arguments << "\n" << outcome.said;
  EXPECT_TRUE(!std::filesystem::exists(folder / "runs")) << arguments;
}

TEST(Cli, HelpFitsAScreen) {
  const TemporaryFolder folder;
  for (const char* arguments :
       {"--help", "run --help", "drive --help", "list --help", "calibrate odometry --help", "doctor --help",
        "register --help", "camera --help", "bench --help", "optimize --help", "eval --help"}) {
    const Outcome outcome = Merlin(arguments, folder.path());
    EXPECT_EQ(outcome.code, 0) << arguments;
    EXPECT_LE(std::ranges::count(outcome.said, '\n'), 40) << arguments;
    for (std::size_t begin = 0, end; (end = outcome.said.find('\n', begin)) != std::string::npos; begin = end + 1)
      EXPECT_LE(end - begin, 80u) << arguments << "\n" << outcome.said.substr(begin, end - begin);
  }
}

TEST(Cli, RefusesBadUsageWithExitTwo) {
  const TemporaryFolder folder;
  ExpectRefused("", "subcommand", folder.path());
  ExpectRefused("run", "scenario", folder.path());
  ExpectRefused("run coridor_loop", "corridor_loop", folder.path());
  ExpectRefused("run corridor_short --seed x", "--seed", folder.path());
  ExpectRefused("run corridor_short --seed -1", "--seed", folder.path());
  ExpectRefused("run corridor_short --threads 0", "--threads", folder.path());
  ExpectRefused("run corridor_short --gl vulkan", "--gl", folder.path());
  ExpectRefused("run corridor_short --pace slow", "--pace", folder.path());
  ExpectRefused("run corridor_short --duration nan", "duration_s", folder.path());
  ExpectRefused("run corridor_short --robot moon", "--robot", folder.path());
  ExpectRefused("run corridor_short --robot hardware:", "--robot", folder.path());
  ExpectRefused("run corridor_short --robot hardware:none.yaml", "none.yaml", folder.path());
  ExpectRefused("doctor --robot twin", "hardware:FILE", folder.path());
  ExpectRefused("doctor --move", "--robot", folder.path());
  ExpectRefused("run corridor_short --out ''", "--out", folder.path());
  ExpectRefused("run corridor_short --duration ''", "--duration", folder.path());
  ExpectRefused("run corridor_short --duration -1", "--set: duration_s", folder.path());
  ExpectRefused("run ./" + std::string(300, 'x'), "scenario", folder.path());
  ExpectRefused("list planets", "planets", folder.path());
}

TEST(Cli, RefusesBadScenariosRoomsAndCamerasWithExitTwo) {
  const TemporaryFolder folder;
  ExpectRefused("run corridor_short --set room=corridor_26x22", "corridor_26x21", folder.path());
  ExpectRefused("run corridor_short --set sensors.depth.camera=pmd_3k", "pmd_3k_s", folder.path());
  ExpectRefused("run corridor_short --set sensors.depth.effects=nois", "noise", folder.path());
  ExpectRefused("run corridor_short --set sensors.depth.integration_us=9000", "integration", folder.path());
  ExpectRefused("run corridor_short --set sensors.depth.frequency_mhz=25", "frequency", folder.path());
  ExpectRefused("run corridor_short --set sensors.depth.rate_hz=121", "120 Hz", folder.path());
  ExpectRefused("run corridor_short --set 'obstacles=[{material: dark_boks}]'", "dark_box", folder.path());
  ExpectRefused("run corridor_short --set 'obstacles=[{appear_s: 8, disappear_s: 2}]'", "obstacles", folder.path());
  const auto refuse_actor = [&](const std::string& rest, const std::string& says) {
    ExpectRefused("run corridor_short --set 'actors=[{name: it, " + rest + "}]'", says, folder.path());
  };
  refuse_actor("shape: spere, size_m: [1], path: [[0, 4, -9.5]]", "sphere");
  refuse_actor("model: persn, path: [[0, 4, -9.5]]", "person");
  refuse_actor("shape: sphere, size_m: [.4], material: dark_boks, path: [[0, 4, -9.5]]", "dark_box");
  refuse_actor("model: person, path: [[0, 4, -9.5], [8, 40, -9.5]]", "path leaves the room");
  refuse_actor("model: person, path: [[0, 4, -9.5], [8, .nan, -9.5]]", "path[1][1]");
  refuse_actor("model: person, path: [[0, 0, -9.5]]", "touches the car");
  refuse_actor("model: person, pth: []", "path");
  ExpectRefused("run corridor_short --set car.start.y_m=-8.5", "start", folder.path());
  ExpectRefused("run corridor_short --set car.start.y_m=-10.6", "start", folder.path());
  std::ofstream(folder.path() / "broken.xml")
      << "<mujoco>\n<worldbody>\n<geom type='ball'/>\n</worldbody>\n</mujoco>\n";
  ExpectRefused("run corridor_short --set room=broken.xml", "broken.xml:3", folder.path());
  std::ofstream(folder.path() / "nan.xml") << "<mujoco><worldbody><geom name='floor' type='plane' size='9 9 1'/><geom "
                                              "type='box' size='1 1 1' pos='nan 0 0'/></worldbody></mujoco>";
  ExpectRefused("run corridor_short --set car.start.y_m=0 --set room=nan.xml", "nan.xml", folder.path());
  std::ofstream(folder.path() / "bare.xml")
      << "<mujoco><worldbody><geom name='floor' type='plane' size='9 9 1'/></worldbody></mujoco>";
  ExpectRefused("run corridor_short --set car.start.y_m=0 --set room=bare.xml --set checks.laps_min=1", "plan_xy_m",
                folder.path());
  std::ofstream(folder.path() / "broken.urdf") << "<robot name='x'>\n<link name='base_link'>\n</robot>\n";
  ExpectRefused("run corridor_short --set car.model=broken.urdf", "broken.urdf:", folder.path());
  std::ofstream(folder.path() / "mapped.urdf") << "<robot name='x'><link name='base_link'/></robot>\n";
  std::ofstream(folder.path() / "mapped.mapping.yaml") << "compas_frame: base_link\n";
  ExpectRefused("run corridor_short --set car.model=mapped.urdf", "did you mean 'compass_frame'", folder.path());
  std::ofstream(folder.path() / "body.stl") << "no mesh";
  std::ofstream(folder.path() / "meshed.urdf")
      << "<robot name='x'><link name='base_link'><visual><geometry><mesh filename='body.stl'/>"
         "</geometry></visual></link></robot>\n";
  ExpectRefused("run corridor_short --set car.model=meshed.urdf", "body.stl: not a mesh", folder.path());
  std::ofstream(folder.path() / "broken.yaml") << "room: hall\nsensors: {depth: {camera: pmd_3k_s}\n";
  ExpectRefused("run broken.yaml", "broken.yaml:", folder.path());
}

TEST(Cli, SaysWhatACameraIsThatIsOfTheOtherKind) {
  const TemporaryFolder folder;
  for (const char* scenario : {"run corridor_short", "run corridor_short --robot emulated"}) {
    const std::string command = scenario + std::string(" --set sensors.");
    ExpectRefused(command + "depth.camera=ccd", "ccd: this is a colour camera; expected a time-of-flight camera",
                  folder.path());
    ExpectRefused(command + "color.camera=pmd_a2",
                  "pmd_a2: this is a time-of-flight camera; expected a colour camera, such as ccd", folder.path());
  }
}

TEST(Cli, NamesTheNearestOfWhatItDoesNotKnow) {
  const TemporaryFolder folder;
  ExpectRefused("rum corridor_short", "unknown subcommand 'rum'; did you mean 'run'?", folder.path());
  ExpectRefused("calibrate odometri", "unknown subcommand 'odometri'; did you mean 'odometry'?", folder.path());
  ExpectRefused("run corridor_short --sed 3", "unknown option '--sed'; did you mean '--seed'?", folder.path());
  ExpectRefused("run --sed=3", "unknown option '--sed'; did you mean '--seed'?", folder.path());
  ExpectRefused("list --jason", "unknown option '--jason'", folder.path());
  ExpectRefused("doctor --licences", "did you mean '--licenses'?", folder.path());
}

TEST(Cli, KeepsTheUmlautsOfAScenario) {
  const TemporaryFolder folder;
  std::filesystem::copy(std::filesystem::path(MERLIN_SOURCE_DIR) / "scenarios/corridor_short.yaml",
                        folder.path() / "Prüfung Flur.yaml");
  const Outcome outcome = Merlin("run 'Prüfung Flur.yaml' --gl off --duration 1 --set checks={}", folder.path());
  EXPECT_EQ(outcome.code, 0) << outcome.said;
  const std::filesystem::path out = folder.path() / "runs/Prüfung Flur-1";
  EXPECT_NE(Contents(out / "junit.xml").find("classname=\"Prüfung Flur\""), std::string::npos);
  EXPECT_NE(Contents(out / "result.json").find("\"scenario\": \"Prüfung Flur\""), std::string::npos);
  std::filesystem::copy(folder.path() / "Prüfung Flur.yaml", folder.path() / "\xff.yaml");
  EXPECT_EQ(Merlin("run \xff.yaml --gl off --duration 1 --set checks={} --out o", folder.path()).code, 0);
  EXPECT_NE(Contents(folder.path() / "o/junit.xml").find("classname=\"\uFFFD\""), std::string::npos);
  EXPECT_NE(Contents(folder.path() / "o/result.json").find("\"scenario\": \"\uFFFD\""), std::string::npos);
}

TEST(Cli, KeepsWhatIsNotARunOfOurs) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "mine");
  std::ofstream(folder.path() / "mine/letter.txt") << "dear";
  const Outcome outcome = Merlin("run corridor_short --gl off --duration 1 --out mine", folder.path());
  EXPECT_EQ(outcome.code, 2) << outcome.said;
  EXPECT_NE(outcome.said.find("mine"), std::string::npos) << outcome.said;
  EXPECT_EQ(Contents(folder.path() / "mine/letter.txt"), "dear");
  std::ofstream(folder.path() / "file") << "x";
  EXPECT_EQ(Merlin("run corridor_short --gl off --duration 1 --out file", folder.path()).code, 2);
}

TEST(Cli, ReplacesAnOlderRunWhole) {
  const TemporaryFolder folder;
  EXPECT_EQ(Merlin("run corridor_short --gl off --duration 2 --out o", folder.path()).code, 1);  // too short to pass
  std::ofstream(folder.path() / "o/stale.txt") << "old";
  EXPECT_EQ(Merlin("run corridor_short --gl off --duration 2 --seed 5 --out o", folder.path()).code, 1);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "o/stale.txt"));
  EXPECT_NE(Contents(folder.path() / "o/result.json").find("\"seed\": 5"), std::string::npos);
}

TEST(Cli, StopsWithExitThreeWhereColorIsRequiredAndGlIsOff) {
  const TemporaryFolder folder;
  const Outcome outcome = Merlin("run corridor_short --gl off --set sensors.color.required=true", folder.path());
  EXPECT_EQ(outcome.code, 3);
  EXPECT_EQ(std::ranges::count(outcome.said, '\n'), 1) << outcome.said;
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "runs"));
}

TEST(Cli, EndsWithExit130AndAnInterruptedVerdictOnCtrlC) {
  const TemporaryFolder folder;
  const pid_t child = fork();
  if (child == 0) {
    if (chdir(folder.path().c_str()) != 0 || !freopen("/dev/null", "w", stdout) || !freopen("said", "w", stderr))
      _exit(99);
    execl(MERLIN_BINARY, "merlin", "run", "corridor_short", "--gl", "off", "--pace", "10", "--out", "o", nullptr);
    _exit(98);
  }
  // The first progress line shows that it drives.
  const auto drives = [&] { return Contents(folder.path() / "said").find(" s of ") != std::string::npos; };
  int status = 0;
  while (!drives() && waitpid(child, &status, WNOHANG) == 0) sched_yield();
  kill(child, SIGINT);
  waitpid(child, &status, 0);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 130);
  EXPECT_NE(Contents(folder.path() / "o/result.json").find("interrupted"), std::string::npos);
}

TEST(Cli, EndsWithExit3WhereTheDiskIsFullAndKeepsWhatFits) {
  const TemporaryFolder folder;
  const Outcome outcome = merlin::Run(
      "ulimit -f 30 && '" MERLIN_BINARY "' run corridor_short --gl off --duration 4 --out o 2>&1", folder.path());
  EXPECT_EQ(outcome.code, 3) << outcome.said;
  EXPECT_NE(outcome.said.find("merlin: o/map.ply: cannot be written"), std::string::npos) << outcome.said;
  EXPECT_NE(Contents(folder.path() / "o/result.json").find("o/map.ply: cannot be written"), std::string::npos);
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "o/trajectory_truth.tum"));
}

TEST(Cli, EndsWithExit4InABadStateWhoeverReadsItsProgress) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "room.xml")
      << "<mujoco><worldbody><geom name='floor' type='plane' size='0 0 1'/><body pos='0 0 50'><joint type='slide' "
         "axis='0 0 1' stiffness='-132' springref='-1'/><geom size='.1' mass='1'/></body></worldbody></mujoco>";
  const Outcome outcome =
      Merlin("run corridor_short --gl off --duration 9 --set car.start.y_m=0 --set room=room.xml --out o",
             folder.path(), "2>/dev/full");
  EXPECT_EQ(outcome.code, 4) << outcome.said;
  EXPECT_NE(outcome.said.find("stopped: MuJoCo stopped at"), std::string::npos) << outcome.said;
  EXPECT_NE(Contents(folder.path() / "o/result.json").find("MuJoCo stopped at"), std::string::npos);
}

TEST(Cli, ListsWhatThereIs) {
  const TemporaryFolder folder;
  const Outcome outcome = Merlin("list", folder.path());
  EXPECT_EQ(outcome.code, 0);
  for (const char* name : {"corridor_loop", "corridor_obstacle", "corridor_short", "pmd_3k_s", "ccd", "corridor_26x21",
                           "hall", "follow_corridor"})
    EXPECT_NE(outcome.said.find(name), std::string::npos) << name;
}

}  // namespace
}  // namespace merlin
