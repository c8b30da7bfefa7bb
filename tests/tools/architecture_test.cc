// Who may know whom: reads every #include and every CMake link line of the tree and finds the wrong arrows.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;
using Strings = std::vector<std::string>;

// Longer names first: a path belongs to the first of these that it starts with.
const std::vector<std::pair<std::string, Strings>> kRoomsAndWhatTheyKnow{
    {"robot/base/", {"robot/base/"}},
    {"robot/types/", {"robot/types/", "robot/base/"}},
    {"robot/kinematics/", {"robot/kinematics/", "robot/types/", "robot/base/"}},
    {"robot/hal/", {"robot/hal/", "robot/types/", "robot/base/"}},
    {"robot/protocol/", {"robot/protocol/", "robot/types/", "robot/base/"}},
    {"robot/description/", {"robot/description/", "robot/types/", "robot/base/"}},
    {"robot/hardware/",
     {"robot/hardware/", "robot/hal/", "robot/kinematics/", "robot/types/", "robot/base/", "robot/protocol/",
      "robot/description/"}},
    {"robot/emulated/",
     {"robot/emulated/", "robot/twin/", "robot/hal/", "robot/kinematics/", "robot/types/", "robot/base/",
      "robot/protocol/", "sim/"}},
    {"robot/twin/", {"robot/twin/", "robot/hal/", "robot/kinematics/", "robot/types/", "robot/base/", "sim/"}},
    {"sim/", {"sim/", "robot/kinematics/", "robot/types/", "robot/base/"}},
    {"perception/", {"perception/", "robot/kinematics/", "robot/types/", "robot/base/"}},
    {"slam/", {"slam/", "perception/", "robot/kinematics/", "robot/types/", "robot/base/"}},
    {"autonomy/", {"autonomy/", "slam/", "perception/", "robot/kinematics/", "robot/types/", "robot/base/"}},
    {"scenarios/judge/", {"scenarios/judge/", "slam/", "perception/", "robot/types/", "robot/base/"}},
    {"scenarios/", {"scenarios/", "autonomy/", "slam/", "perception/", "sim/", "robot/"}},
    {"tools/", {"tools/", "scenarios/", "autonomy/", "slam/", "perception/", "sim/", "robot/"}},
    {"docs/", {"docs/", "autonomy/", "slam/", "perception/", "robot/"}},
    {"tests/", {"tests/", "docs/", "tools/", "scenarios/", "autonomy/", "slam/", "perception/", "sim/", "robot/"}},
};
const Strings kEngineHeaders{"mujoco/", "embree3/", "embree4/", "EGL/", "GL/"};
const Strings kEngineTargets{"mujoco::mujoco", "Embree::embree"};
const Strings kEngineRooms{"sim/", "robot/twin/", "robot/emulated/", "scenarios/", "tools/", "tests/"};
// The stack does not see the truth, not even as data.
const Strings kBlindRooms{"perception/", "slam/", "autonomy/"};
const std::string kTruth = "robot/types/ground_truth.h";
const Strings kEigenOnlyRooms{"robot/types/", "robot/kinematics/", "robot/hal/"};

bool Contains(const Strings& list, const std::string& item) {
  return std::find(list.begin(), list.end(), item) != list.end();
}

bool StartsWithAny(const std::string& path, const Strings& prefixes) {
  return std::any_of(prefixes.begin(), prefixes.end(),
                     [&](const std::string& prefix) { return path.starts_with(prefix); });
}

std::string RoomOf(const std::string& path) {
  for (const auto& [room, known] : kRoomsAndWhatTheyKnow)
    if (path.starts_with(room)) return room;
  return "";
}

bool Knows(const std::string& from, const std::string& to) {
  for (const auto& [room, known] : kRoomsAndWhatTheyKnow)
    if (from.starts_with(room)) return StartsWithAny(to, known);
  return false;
}

Strings Matches(const std::string& text, const std::string& pattern) {
  Strings found;
  const std::regex regex(pattern);
  for (std::sregex_iterator match(text.begin(), text.end(), regex), end; match != end; ++match)
    found.push_back((*match)[1]);
  return found;
}

// A header of the standard library: a single word.
bool IsStandard(const std::string& header) { return header.find_first_of("/.") == std::string::npos; }

// The wrong #includes of one source file, each "file: header".
Strings WrongIncludes(const std::string& file, const std::string& text) {
  Strings wrong;
  for (const std::string& header : Matches(text, "(?:^|\n)[ \t]*#[ \t]*include[ \t]*\"([^\"]+)\""))
    if (!Knows(file, header) || (header == kTruth && Contains(kBlindRooms, RoomOf(file))))
      wrong.push_back(file + ": \"" + header + "\"");
  for (const std::string& header : Matches(text, "(?:^|\n)[ \t]*#[ \t]*include[ \t]*<([^>]+)>")) {
    const bool engine = StartsWithAny(header, kEngineHeaders) && !Contains(kEngineRooms, RoomOf(file));
    const bool heavy = Contains(kEigenOnlyRooms, RoomOf(file)) && !IsStandard(header) && !header.starts_with("Eigen/");
    const bool ours = !RoomOf(header).empty() && !Knows(file, header);
    if (engine || heavy || ours) wrong.push_back(file + ": <" + header + ">");
  }
  return wrong;
}

// The merlin:: libraries and where they are made: {"sim": "sim/CMakeLists.txt"}.
std::map<std::string, std::string> Libraries(const std::map<std::string, std::string>& cmake_lists) {
  std::map<std::string, std::string> libraries;
  for (const auto& [file, text] : cmake_lists)
    for (const std::string& name : Matches(text, "merlin_library\\(([a-z_]+)")) libraries[name] = file;
  return libraries;
}

// The wrong links in the CMakeLists.txt files (path to text), each as "file: target".
Strings WrongLinks(const std::map<std::string, std::string>& cmake_lists) {
  const std::map<std::string, std::string> libraries = Libraries(cmake_lists);
  Strings wrong;
  for (const auto& [file, text] : cmake_lists) {
    if (RoomOf(file).empty()) continue;  // the files of folders that only add other folders
    for (const std::string& name : Matches(text, "merlin(?:::|_)([a-z_]+)")) {
      const auto library = libraries.find(name);
      if (library != libraries.end() && !Knows(file, library->second)) wrong.push_back(file + ": merlin::" + name);
    }
    for (const std::string& target : kEngineTargets)
      if (!Contains(kEngineRooms, RoomOf(file)) &&
          !Matches(text, "[^A-Za-z0-9_](" + target + ")(?![A-Za-z0-9_])").empty())
        wrong.push_back(file + ": " + target);
  }
  return wrong;
}

// Text without comments, because a header that is only mentioned is not a dependency.
std::string WithoutHashComments(const std::string& text) { return std::regex_replace(text, std::regex("#[^\n]*"), ""); }

// The files of the tree that pass the filter: from path (relative to the root) to text.
template <class Wanted>
std::map<std::string, std::string> Read(Wanted wanted) {
  std::map<std::string, std::string> files;
  const fs::path root = MERLIN_SOURCE_DIR;
  for (const char* top : {"robot", "sim", "perception", "slam", "autonomy", "scenarios", "tools", "docs", "tests"})
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / top)) {
      if (!entry.is_regular_file() || !wanted(entry.path())) continue;
      std::stringstream text;
      text << std::ifstream(entry.path()).rdbuf();
      files[fs::relative(entry.path(), root).generic_string()] = text.str();
    }
  return files;
}

TEST(Architecture, NoIncludePointsBack) {
  const auto sources = Read([](const fs::path& path) { return path.extension() == ".h" || path.extension() == ".cc"; });
  ASSERT_GT(sources.size(), 30u);
  for (const auto& [file, text] : sources) EXPECT_EQ(WrongIncludes(file, text), Strings{}) << file;
}

TEST(Architecture, NoCMakeLinkPointsBack) {
  auto lists = Read([](const fs::path& path) { return path.filename() == "CMakeLists.txt"; });
  ASSERT_GT(lists.size(), 8u);
  for (auto& [file, text] : lists) text = WithoutHashComments(text);
  EXPECT_EQ(WrongLinks(lists), Strings{});
}

TEST(Architecture, EverySourceFileLiesInARoom) {
  for (const auto& [file, text] : Read([](const fs::path& path) { return path.extension() == ".cc"; }))
    EXPECT_NE(RoomOf(file), "") << file;
}

TEST(ArchitectureCheck, FindsEveryKindOfWrongInclude) {
  const std::vector<std::pair<std::string, std::string>> wrong{
      {"slam/slam.cc", "#include \"sim/world/world.h\"\n"},
      {"autonomy/pilot.cc", "#include \"robot/twin/twin.h\"\n"},
      {"perception/fuse.cc", "#include \"robot/hal/hal.h\"\n"},
      {"perception/fuse.cc", "\n  #  include \"slam/slam.h\"\n"},
      {"sim/world/world.cc", "#include \"robot/hal/hal.h\"\n"},
      {"sim/world/world.cc", "#include <robot/hal/hal.h>\n"},
      {"robot/types/car.h", "#include <fmt/core.h>\n"},
      {"robot/hal/hal.h", "#include <opencv2/core.hpp>\n"},
      {"slam/slam.cc", "#include <mujoco/mujoco.h>\n"},
      {"scenarios/run/run.cc", "#include \"tools/cli/doctor.h\"\n"},
      {"slam/slam.cc", "#include \"slam.h\"\n"},
      {"slam/slam.cc", "#include \"robot/types/ground_truth.h\"\n"},
      {"scenarios/judge/measure.cc", "#include \"sim/world/world.h\"\n"},
      {"scenarios/judge/measure.cc", "#include \"scenarios/run/run.h\"\n"},
      {"autonomy/pilot.cc", "#include <embree3/rtcore.h>\n"},
  };
  for (const auto& [file, text] : wrong) EXPECT_EQ(WrongIncludes(file, text).size(), 1u) << file << ": " << text;
}

TEST(ArchitectureCheck, AllowsTheArrowsOfTheDesign) {
  const std::vector<std::pair<std::string, std::string>> right{
      {"slam/slam.cc", "#include \"perception/observation.h\"\n#include <vector>\n"},
      {"robot/types/se3.h", "#include <Eigen/Core>\n#include <cmath>\n"},
      {"robot/hal/plug.h", "#include \"robot/types/ground_truth.h\"\n"},
      {"robot/twin/twin.cc", "#include \"sim/world/world.h\"\n#include <mujoco/mujoco.h>\n"},
      {"scenarios/run/run.cc", "#include \"robot/twin/twin.h\"\n#include \"autonomy/pilot.h\"\n"},
      {"perception/fuse.cc", "// as in #include \"sim/world/world.h\"\n"},
  };
  for (const auto& [file, text] : right) EXPECT_EQ(WrongIncludes(file, text), Strings{}) << file;
}

TEST(ArchitectureCheck, FindsWrongLinks) {
  const std::map<std::string, std::string> lists{
      {"sim/CMakeLists.txt", "merlin_library(sim SOURCES a.cc PUBLIC merlin::types PRIVATE Embree::embree)"},
      {"robot/types/CMakeLists.txt", "merlin_library(types PUBLIC Eigen3::Eigen)"},
      {"robot/hal/CMakeLists.txt", "merlin_library(hal PUBLIC merlin::types merlin::options)"},
      {"perception/CMakeLists.txt", "merlin_library(perception SOURCES b.cc\n  PUBLIC merlin::hal)"},
      {"slam/CMakeLists.txt", "merlin_library(slam SOURCES c.cc PRIVATE $<$<BOOL:ON>:mujoco::mujoco>)"},
      {"autonomy/CMakeLists.txt",
       "merlin_library(autonomy SOURCES d.cc)\ntarget_link_libraries(merlin_autonomy merlin_sim)"},
  };
  const Strings expected{"autonomy/CMakeLists.txt: merlin::sim", "perception/CMakeLists.txt: merlin::hal",
                         "slam/CMakeLists.txt: mujoco::mujoco"};
  EXPECT_EQ(WrongLinks(lists), expected);
}

}  // namespace
