// Tiny rooms with the car in them, for tests.
#pragma once

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "robot/description/description.h"
#include "sim/world/world.h"

namespace merlin::sim {

constexpr char kPlane[] = R"(<geom name="floor" type="plane" size="0 0 1"/>)";

inline const CarDescription& Merlin() {
  static const CarDescription car = ReadCar(std::filesystem::path(MERLIN_SOURCE_DIR) / "models/merlin/merlin.urdf");
  return car;
}

// A file in a temporary folder, removed with the object.
class TemporaryFile {
 public:
  TemporaryFile(const std::string& name, const std::string& text) {
    std::string pattern = (std::filesystem::temp_directory_path() / "merlin_test_XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
    std::ofstream(path_ = folder_ / name) << text;
  }
  ~TemporaryFile() { std::filesystem::remove_all(folder_); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path folder_, path_;
};

inline std::string Room(const std::string& worldbody, const std::string& rest = "") {
  return fmt::format("<mujoco>\n{}\n<worldbody>\n{}\n</worldbody>\n</mujoco>\n", rest, worldbody);
}

inline std::unique_ptr<World> MakeWorld(const std::string& room, const Pose& T_world_start = Pose::Identity(),
                                        const std::vector<ObstacleConfig>& obstacles = {},
                                        const DrivetrainConfig& drivetrain = {}) {
  const TemporaryFile file("room.xml", room);
  return std::make_unique<World>(WorldOptions{.room = file.path(),
                                              .car = Merlin(),
                                              .T_world_start = T_world_start,
                                              .drivetrain = drivetrain,
                                              .obstacles = obstacles});
}

inline std::unique_ptr<World> EmptyWorld(const DrivetrainConfig& drivetrain = {}) {
  return MakeWorld(Room(kPlane), Pose::Identity(), {}, drivetrain);
}

inline void Send(World& world, double speed_m_s, double steering_rad, double valid_for_s = 1e6) {
  world.drive().Send({.speed_m_s = speed_m_s, .steering_rad = steering_rad, .valid_for = FromSeconds(valid_for_s)},
                     world.Now());
}

inline void StepFor(World& world, double duration_s) {
  const Time end = world.Now() + FromSeconds(duration_s);
  while (world.Now() < end) world.Step();
}

inline DriveState Read(const World& world) { return world.drive().Read(world.model(), world.data(), world.Now()); }

}  // namespace merlin::sim
