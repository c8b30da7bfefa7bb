#include "tools/register/bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "robot/base/error.h"
#include "slam/register/align.h"
#include "tools/register/pairs.h"

namespace merlin {
namespace {

namespace fs = std::filesystem;

constexpr int kBlocks = 3, kRoundsABlock = 5;  // in turns, so that a busy machine slows down both alike
constexpr double kVoxels_m[] = {0.1, 0.25};

fs::path FromSources(const char* variable, const fs::path& otherwise) {
  const char* const value = std::getenv(variable);
  return value && *value ? fs::path(value) : fs::path(MERLIN_SOURCE_DIR) / otherwise;
}

// A temporary folder that is deleted in the end.
class Folder {
 public:
  Folder() {
    std::string name = (fs::temp_directory_path() / "merlin-register.XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr)
      throw MachineError("cannot make a folder in " + fs::temp_directory_path().string());
    path_ = name;
  }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

void Write(const fs::path& file, const double* numbers, std::size_t count) {
  std::ofstream out(file, std::ios::binary);
  out.write(reinterpret_cast<const char*>(numbers), static_cast<std::streamsize>(count * sizeof(double)));
  if (!out.flush()) throw MachineError("cannot write " + file.string() + "; disk full?");
}

struct Run {
  std::vector<double> times_ms;
  Pose T_target_source;
  int iterations = 0;
};

class SmallGicp {
 public:
  SmallGicp() : python_(FromSources("MERLIN_ORACLES", ".deps/oracles") / "bin/python") {
    if (std::system(("'" + python_.string() + "' -c 'import numpy, small_gicp' >/dev/null 2>&1").c_str()) != 0)
      throw MachineError("no small_gicp in " + python_.parent_path().parent_path().string() +
                         "; `tools/merlin bench register` installs it there");
  }

  void Take(const RegisterPair& pair) const {
    Write(folder_.path() / "source.f64", pair.source.positions.front().data(), 3 * pair.source.size());
    Write(folder_.path() / "target.f64", pair.target.positions.front().data(), 3 * pair.target.size());
    const Eigen::Matrix<double, 4, 4, Eigen::RowMajor> guess = pair.guess.matrix();
    Write(folder_.path() / "guess.f64", guess.data(), 16);
  }

  Run Align(double voxel_m) const {
    const fs::path script = fs::path(MERLIN_SOURCE_DIR) / "tools/register/small_gicp_bench.py";
    const std::string command = fmt::format("OMP_NUM_THREADS=1 '{}' '{}' '{}' {} {}", python_.string(), script.string(),
                                            folder_.path().string(), voxel_m, kRoundsABlock);
    std::string said;
    FILE* const pipe = popen(command.c_str(), "r");
    std::array<char, 4096> buffer;
    for (std::size_t n; pipe && (n = fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) said.append(buffer.data(), n);
    if (pipe == nullptr || pclose(pipe) != 0) throw MachineError("small_gicp failed: " + command);
    const auto json = nlohmann::json::parse(said);
    const auto numbers = json["T"].get<std::vector<double>>();
    Run run{json["times_ms"].get<std::vector<double>>(), Pose::Identity(), json["iterations"].get<int>()};
    run.T_target_source.matrix() = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(numbers.data());
    return run;
  }

 private:
  fs::path python_;
  Folder folder_;
};

double ProcessorTime_ms() { return 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

Run AlignOurs(const RegisterPair& pair, double voxel_m) {
  Run run;
  for (int i = 0; i < kRoundsABlock; ++i) {
    const double begin_ms = ProcessorTime_ms();
    const AlignResult result = Align(Thin(pair.source, voxel_m), Thin(pair.target, voxel_m), pair.guess, {});
    run.times_ms.push_back(ProcessorTime_ms() - begin_ms);
    run.T_target_source = result.T_target_source;
    run.iterations = result.iterations;
  }
  return run;
}

void Add(const Run& more, Run& all) {
  all.T_target_source = more.T_target_source;
  all.iterations = more.iterations;
  all.times_ms.insert(all.times_ms.end(), more.times_ms.begin(), more.times_ms.end());
}

RegisterBench::Figures FiguresOf(Run run, const Pose& T_target_source) {
  const auto middle = run.times_ms.begin() + static_cast<std::ptrdiff_t>(run.times_ms.size() / 2);
  std::ranges::nth_element(run.times_ms, middle);
  const Pose error = T_target_source.inverse() * run.T_target_source;
  return {*middle, 1e3 * error.translation().norm(), LogSo3(error.linear()).norm() * 180.0 / M_PI, run.iterations};
}

}  // namespace

RegisterBench BenchRegister(const std::atomic<bool>& interrupted) {
  const SmallGicp small_gicp;
  RegisterBench bench{.rounds = kBlocks * kRoundsABlock};
  const fs::path frames = FromSources("MERLIN_SHARED_DATA", "../shared/data") / "rgbd";
  std::vector<RegisterPair> pairs = RgbdPairs(frames);
  if (pairs.empty()) bench.skipped = "RGB-D frames: none in " + frames.string();
  pairs.push_back(SimulatedPair());
  for (const RegisterPair& pair : pairs) {
    small_gicp.Take(pair);
    for (const double voxel_m : kVoxels_m) {
      Run ours, theirs;
      for (int block = 0; block < kBlocks; ++block) {
        if (interrupted) return bench;
        Add(AlignOurs(pair, voxel_m), ours);
        Add(small_gicp.Align(voxel_m), theirs);
      }
      bench.rows.push_back(
          {pair.name, voxel_m, FiguresOf(ours, pair.T_target_source), FiguresOf(theirs, pair.T_target_source)});
    }
  }
  return bench;
}

std::string Table(const RegisterBench& bench) {
  std::string text = fmt::format(
      "GICP beside small_gicp, one thread each: downsampling of both clouds, normals or covariances, k-d tree, "
      "alignment\n"
      "median processor time of {} rounds; error of the pose (RGB-D: from another system's estimate)\n"
      "  {:<16} {:>7}  {:>23}  {:>23}  {:>6}\n"
      "  {:<16} {:>7}  {:>7} {:>7} {:>7}  {:>7} {:>7} {:>7}  {:>6}\n",
      bench.rounds, "", "", "ours", "small_gicp", "time", "pair", "voxel m", "ms", "mm", "deg", "ms", "mm", "deg",
      "ratio");
  for (const RegisterBench::Row& row : bench.rows) {
    const auto &a = row.ours, &b = row.theirs;
    text += fmt::format("  {:<16} {:>7.2f}  {:>7.1f} {:>7.2f} {:>7.3f}  {:>7.1f} {:>7.2f} {:>7.3f}  {:>6.2f}\n",
                        row.pair, row.voxel_m, a.median_ms, a.error_mm, a.error_deg, b.median_ms, b.error_mm,
                        b.error_deg, a.median_ms / b.median_ms);
  }
  return bench.skipped.empty() ? text : text + "skipped: " + bench.skipped + "\n";
}

std::string ToJson(const RegisterBench& bench) {
  const auto figures = [](const RegisterBench::Figures& f) {
    return nlohmann::ordered_json{
        {"median_ms", f.median_ms}, {"error_mm", f.error_mm}, {"error_deg", f.error_deg}, {"iterations", f.iterations}};
  };
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const RegisterBench::Row& row : bench.rows)
    rows.push_back({{"pair", row.pair},
                    {"voxel_m", row.voxel_m},
                    {"ours", figures(row.ours)},
                    {"small_gicp", figures(row.theirs)},
                    {"time_ratio", row.ours.median_ms / row.theirs.median_ms}});
  nlohmann::ordered_json json{{"rounds", bench.rounds}, {"rows", rows}, {"skipped", nullptr}};
  if (!bench.skipped.empty()) json["skipped"] = bench.skipped;
  return json.dump(2) + "\n";
}

}  // namespace merlin
