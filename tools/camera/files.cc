#include "tools/camera/files.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgcodecs.hpp>

#include "robot/base/error.h"
#include "scenarios/judge/writers.h"
#include "tools/camera/npy.h"
#include "tools/camera/stage.h"

namespace merlin {
namespace {

std::string RangePng(const DepthFrame& frame) {
  cv::Mat millimetres(frame.height, frame.width, CV_16UC1);
  for (std::size_t p = 0; p < frame.size(); ++p) {
    const bool valid = (frame.flags[p] & kInvalid) == 0;
    millimetres.at<std::uint16_t>(static_cast<int>(p) / frame.width, static_cast<int>(p) % frame.width) =
        valid ? static_cast<std::uint16_t>(std::clamp(std::lround(1e3 * frame.range_m[p]), 0L, 65535L))
              : std::uint16_t{0};
  }
  std::vector<std::uint8_t> bytes;
  if (!cv::imencode(".png", millimetres, bytes)) throw MachineError("OpenCV has no PNG encoder");
  return {bytes.begin(), bytes.end()};
}

std::string CloudPly(const DepthFrame& frame, const CameraModel& camera) {
  const float brightest = std::max(1.0f, *std::ranges::max_element(frame.amplitude));
  const Eigen::Matrix3d R_body_optical = BodyOptical().linear();
  std::vector<MapPoint> points;
  for (std::size_t p = 0; p < frame.size(); ++p) {
    if ((frame.flags[p] & kInvalid) != 0) continue;
    const Eigen::Vector3d ray = camera.Ray(static_cast<double>(static_cast<int>(p) % frame.width),
                                           static_cast<double>(static_cast<int>(p) / frame.width));
    // The square root: near surfaces are so much brighter that far ones would be black.
    const auto grey =
        static_cast<std::uint8_t>(std::lround(255.0f * std::sqrt(std::max(0.0f, frame.amplitude[p]) / brightest)));
    points.push_back({(frame.range_m[p] * (R_body_optical * ray)).cast<float>(), {grey, grey, grey}});
  }
  return ToPly(points);
}

std::vector<double> Poses(const std::vector<Pose>& poses) {
  std::vector<double> rows;
  for (const Pose& pose : poses)
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) rows.push_back(pose.matrix()(i, j));
  return rows;
}

}  // namespace

std::map<std::string, std::string> FrameFiles(const Measurement& m, const CameraModel& camera) {
  const DepthFrame& frame = m.last;
  const sim::TofTruth& truth = m.truth;
  const auto width = static_cast<std::size_t>(frame.width), height = static_cast<std::size_t>(frame.height);
  const std::vector<std::size_t> image{height, width};
  const auto sub_frames = static_cast<std::size_t>(frame.settings.sub_frames());
  std::map<std::string, std::string> files{
      {"phase_images.npy", ToNpy(frame.phase_images, {sub_frames, 2, height, width})},
      {"range.npy", ToNpy(frame.range_m, image)},
      {"amplitude.npy", ToNpy(frame.amplitude, image)},
      {"intensity.npy", ToNpy(frame.intensity, image)},
      {"flags.npy", ToNpy(frame.flags, image)},
      {"truth_range.npy", ToNpy(truth.range_m, image)},
      {"truth_depth.npy", ToNpy(truth.depth_m, image)},
      {"truth_geom.npy", ToNpy(truth.geom, image)},
      {"truth_material.npy", ToNpy(truth.material, image)},
      {"truth_sigma.npy", ToNpy(truth.sigma_m, image)},
      {"truth_mixed.npy", ToNpy(truth.mixed, image)},
      {"truth_T_world_optical.npy", ToNpy(Poses(truth.T_world_camera), {truth.T_world_camera.size(), 4, 4})},
      {"range.png", RangePng(frame)},
      {"cloud.ply", CloudPly(frame, camera)},
  };
  for (const sim::TofTruth::Bias& bias : truth.bias) files["bias_" + bias.effect + ".npy"] = ToNpy(bias.range_m, image);
  return files;
}

}  // namespace merlin
