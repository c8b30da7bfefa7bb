#include "tools/cli/licenses.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>

namespace merlin::cli {
namespace {

std::string Lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

std::string ReadText(const std::string& path) {
  std::stringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

bool IsListed(const std::string& package) {
  const std::vector<LinkedWork> works = LinkedWorks();
  return std::any_of(works.begin(), works.end(), [&](const LinkedWork& work) {
    return Lower(work.name).find(Lower(package)) != std::string::npos;
  });
}

TEST(Licenses, EveryWorkNamesItsTermsAndItsWayIn) {
  for (const LinkedWork& work : LinkedWorks()) {
    EXPECT_FALSE(work.license.empty()) << work.name;
    EXPECT_FALSE(work.how.empty()) << work.name;
  }
}

// A package that someone adds to the build must be added to the table.
TEST(Licenses, EveryPackageThatCMakeFindsIsListed) {
  const std::string lists = ReadText(MERLIN_SOURCE_DIR "/CMakeLists.txt");
  const std::regex found("\n( *)find_package\\(([A-Za-z_-]+)");
  int count = 0;
  for (std::sregex_iterator match(lists.begin(), lists.end(), found), end; match != end; ++match) {
    const bool needs_twin = !(*match)[1].str().empty();
    const std::string package = std::regex_replace((*match)[2].str(), std::regex("(3|_headers)$"), "");
    if (package == "Threads" || (needs_twin && !MERLIN_TWIN)) continue;  // Threads: part of the C library
    EXPECT_TRUE(IsListed(package)) << package;
    ++count;
  }
  EXPECT_GE(count, 8);
}

TEST(Licenses, VersionsAreThoseInUse) {
  const std::vector<LinkedWork> works = LinkedWorks();
  const auto eigen =
      std::find_if(works.begin(), works.end(), [](const LinkedWork& work) { return work.name == "Eigen"; });
  ASSERT_NE(eigen, works.end());
  EXPECT_EQ(eigen->version.substr(0, 2), "3.");
#if MERLIN_TWIN
  EXPECT_EQ(works.front().name, "MuJoCo");
  EXPECT_EQ(works.front().version, "4.0.0");
#endif
}

}  // namespace
}  // namespace merlin::cli
