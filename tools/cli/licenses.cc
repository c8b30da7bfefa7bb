#include "tools/cli/licenses.h"

#include <assimp/version.h>
#include <fmt/core.h>
#include <gnu/libc-version.h>
#include <openssl/crypto.h>
#include <tinyxml.h>

#include <CLI/Version.hpp>
#include <Eigen/Core>
#include <nanoflann.hpp>
#include <nlohmann/json.hpp>
#include <opencv2/core/version.hpp>

#if MERLIN_TWIN
#include <mujoco/mujoco.h>

#include <boost/version.hpp>

#include "sim/rays/embree.h"
#endif

namespace merlin::cli {
namespace {

std::string Dotted(int major, int minor, int patch) { return fmt::format("{}.{}.{}", major, minor, patch); }

std::vector<LinkedWork> TwinWorks() {
#if MERLIN_TWIN
  return {
      {"MuJoCo", mj_versionString(), "Apache-2.0",
       "shared library; its own parts: licenses/LICENSES_THIRD_PARTY.md beside it"},
      {"Embree", RTC_VERSION_STRING, "Apache-2.0", "shared library"},
      {"Boost (Beast, Asio)", Dotted(BOOST_VERSION / 100000, BOOST_VERSION / 100 % 1000, BOOST_VERSION % 100),
       "BSL-1.0", "headers"},
      {"oneTBB", "", "Apache-2.0", "shared library, through Embree"},
      {"libglvnd (EGL)", "", "MIT AND BSD-1-Clause AND Apache-2.0", "loaded at run time"},
      {"Mesa (EGL, OSMesa)", "", "MIT", "loaded at run time"},
      {"LLVM (llvmpipe)", "", "Apache-2.0 WITH LLVM-exception", "loaded at run time, through Mesa"},
  };
#else
  return {};
#endif
}

}  // namespace

std::vector<LinkedWork> LinkedWorks() {
  std::vector<LinkedWork> works = TwinWorks();
  const std::vector<LinkedWork> always{
      {"Eigen", Dotted(EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION), "MPL-2.0", "headers"},
      {"nanoflann", Dotted(NANOFLANN_VERSION >> 8, NANOFLANN_VERSION >> 4 & 15, NANOFLANN_VERSION & 15), "BSD-2-Clause",
       "headers"},
      {"OpenCV (core, imgproc, imgcodecs, videoio)", CV_VERSION, "Apache-2.0", "shared libraries"},
      {"FFmpeg", "", "GPL-2.0-or-later", "shared libraries, through OpenCV's videoio; as Debian builds it"},
      {"GStreamer", "", "LGPL-2.1-or-later", "shared libraries, through OpenCV's videoio"},
      {"assimp", fmt::format("{}.{}", aiGetVersionMajor(), aiGetVersionMinor()), "BSD-3-Clause", "shared library"},
      {"urdfdom", "", "BSD-3-Clause", "shared library and headers"},
      {"TinyXML", Dotted(TIXML_MAJOR_VERSION, TIXML_MINOR_VERSION, TIXML_PATCH_VERSION), "Zlib",
       "shared library, through urdfdom"},
      {"console_bridge", "", "BSD-3-Clause", "shared library, through urdfdom"},
      {"yaml-cpp", MERLIN_YAML_CPP_VERSION, "MIT", "shared library"},
      {"nlohmann_json", Dotted(NLOHMANN_JSON_VERSION_MAJOR, NLOHMANN_JSON_VERSION_MINOR, NLOHMANN_JSON_VERSION_PATCH),
       "MIT", "headers"},
      {"CLI11", CLI11_VERSION, "BSD-3-Clause", "headers"},
      {"fmt", Dotted(FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100), "MIT", "shared library"},
      {"OpenSSL (libcrypto)", OpenSSL_version(OPENSSL_VERSION_STRING), "Apache-2.0", "shared library"},
      {"GoogleTest", "", "BSD-3-Clause", "static library, in the tests only"},
      {"GNU C Library", gnu_get_libc_version(), "LGPL-2.1-or-later", "shared library"},
      {"GCC run-time (libstdc++, libgcc)", __VERSION__, "GPL-3.0-or-later WITH GCC-exception-3.1",
       "shared libraries and headers"},
  };
  works.insert(works.end(), always.begin(), always.end());
  return works;
}

}  // namespace merlin::cli
