#include "scenarios/judge/write.h"

#include "robot/base/sha256.h"
#include "scenarios/judge/map_picture.h"

namespace merlin {
namespace {

std::string HashOf(const std::string& bytes) {
  Sha256 hash;
  hash.Add(bytes);
  return hash.Hex();
}

MapPicture PictureOf(const std::string& title, const StackOutcome& outcome, const GroundTruth* truth,
                     const Measured& measured) {
  MapPicture picture{.title = title,
                     .map = outcome.map,
                     .T_world_map = measured.T_world_map,
                     .estimate = outcome.estimate,
                     .size = measured.size,
                     .ate_rmse_m = measured.metrics.ate_rmse_m};
  if (truth == nullptr) return picture;
  picture.outline = truth->outline_m;
  picture.truth = truth->path;
  return picture;
}

}  // namespace

Hashes WriteRun(const std::string& title, const StackOutcome& outcome, const GroundTruth* truth,
                const Measured& measured, const OutputFolder& folder, FirstFault& faults) {
  // Writes a file; gives the hash of what was written.
  const auto write = [&](const char* file, const auto& bytes) {
    std::optional<std::string> hash;
    faults.Try([&] {
      const std::string made = bytes();
      folder.Write(file, made);
      hash = HashOf(made);
    });
    return hash;
  };
  Hashes hashes;
  hashes.trajectory = write("trajectory_estimate.tum", [&] { return ToTum(outcome.estimate); });
  write("trajectory_online.tum", [&] { return ToTum(outcome.online); });
  if (truth != nullptr) write("trajectory_truth.tum", [&] { return ToTum(truth->path); });
  hashes.map = write("map.ply", [&] { return ToPly(outcome.map); });
  if (write("map.pgm", [&] { return ToPgm(outcome.grid); }))
    write("map.yaml", [&] { return ToMapYaml(outcome.grid, "map.pgm"); });
  write("map.png", [&] { return ToPng(PictureOf(title, outcome, truth, measured)); });
  if (!outcome.map_slam.empty()) faults.Try([&] { folder.Write("map.slam", outcome.map_slam); });
  return hashes;
}

}  // namespace merlin
