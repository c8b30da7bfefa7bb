#include "tools/register/pairs.h"

#include <cmath>
#include <cstdint>
#include <fstream>
#include <limits>
#include <numbers>
#include <random>

namespace merlin {
namespace {

constexpr double kPi = std::numbers::pi, kNone = std::numeric_limits<double>::infinity();
constexpr int kBeams = 64, kTurns = 1500;  // directions of a scan, of which about a fifth hit nothing
constexpr std::size_t kPoints = 70'000;
constexpr double kRangeNoise_m = 0.02, kRangeMin_m = 1.0;

// Random numbers with the same bits everywhere, unlike the distributions of the standard library.
class Random {
 public:
  explicit Random(std::uint32_t seed) : bits_(seed) {}
  double Uniform(double from, double to) {
    return from + (to - from) * (static_cast<double>(bits_()) + 0.5) / 4294967296.0;
  }
  double Normal() { return std::sqrt(-2.0 * std::log(Uniform(0.0, 1.0))) * std::cos(Uniform(0.0, 2.0 * kPi)); }

 private:
  std::mt19937 bits_;
};

struct Ray {
  Eigen::Vector3d origin, direction;  // of length 1
};

// Upright on the ground: a house, or the outer walls, which are seen from inside.
struct Box {
  Eigen::Vector2d center;
  double yaw_rad;
  Eigen::Vector3d half_size;
};
struct Cylinder {  // a pole or a trunk
  Eigen::Vector2d center;
  double radius_m, height_m;
};
struct Sphere {  // a crown: a ray enters it somewhere
  Eigen::Vector3d center;
  double radius_m;
};

// The nearest distance along the ray, or kNone.
double Hit(const Ray& ray, const Box& box) {
  const Eigen::Matrix3d R = Eigen::AngleAxisd(-box.yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const Eigen::Vector3d o = R * (ray.origin - Eigen::Vector3d(box.center.x(), box.center.y(), box.half_size.z()));
  const Eigen::Vector3d d = R * ray.direction;
  double enter = -kNone, leave = kNone;
  for (int i = 0; i < 3; ++i) {
    const double a = (-box.half_size(i) - o(i)) / d(i), b = (box.half_size(i) - o(i)) / d(i);
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  if (enter > leave || leave < 0.0) return kNone;
  if (enter > 0.0) return enter;
  return (o + leave * d).z() < box.half_size.z() - 1e-9 ? leave : kNone;  // open at the top
}

double Hit(const Ray& ray, const Cylinder& cylinder) {
  const Eigen::Vector2d o = ray.origin.head<2>() - cylinder.center, d = ray.direction.head<2>();
  const double a = d.squaredNorm(), b = o.dot(d),
               root = b * b - a * (o.squaredNorm() - cylinder.radius_m * cylinder.radius_m);
  if (root < 0.0) return kNone;
  const double t = (-b - std::sqrt(root)) / a, z = ray.origin.z() + t * ray.direction.z();
  return t > 0.0 && z > 0.0 && z < cylinder.height_m ? t : kNone;
}

double Hit(const Ray& ray, const Sphere& sphere, Random& random) {
  const Eigen::Vector3d o = ray.origin - sphere.center;
  const double b = o.dot(ray.direction), root = b * b - (o.squaredNorm() - sphere.radius_m * sphere.radius_m);
  if (root < 0.0) return kNone;
  const double depth_m = -1.5 * std::log(random.Uniform(0.0, 1.0));  // the ray ends at a random leaf: 1.5 m on average
  return depth_m < 2.0 * std::sqrt(root) ? -b - std::sqrt(root) + depth_m : kNone;
}

struct Place {
  std::vector<Box> boxes{{{0.0, 0.0}, 0.0, {35.0, 30.0, 1.2}},    {{22.0, 18.0}, 0.1, {8.0, 6.0, 4.0}},
                         {{-20.0, -17.0}, -0.2, {9.0, 5.0, 3.5}}, {{-24.0, 16.0}, 0.4, {4.0, 7.0, 3.0}},
                         {{12.0, -20.0}, 0.0, {6.0, 3.0, 2.5}},   {{7.0, 5.0}, 0.7, {2.2, 0.9, 0.8}},
                         {{-6.0, 8.0}, -0.3, {2.2, 0.9, 0.8}}};
  std::vector<Cylinder> cylinders;
  std::vector<Sphere> crowns;

  explicit Place(Random& random) {
    for (int i = 0; i < 24; ++i) {
      const Eigen::Vector2d at(random.Uniform(-30.0, 30.0), random.Uniform(-25.0, 25.0));
      if (at.norm() < 4.0) continue;
      const bool tree = i % 2 == 0;
      cylinders.push_back({at, tree ? 0.2 : 0.08, tree ? 3.0 : 6.0});
      if (tree) crowns.push_back({{at.x(), at.y(), 4.5}, 2.0});
    }
  }

  double Range_m(const Ray& ray, Random& random) const {
    double range_m = ray.direction.z() < 0.0 ? -ray.origin.z() / ray.direction.z() : kNone;
    for (const Box& box : boxes) range_m = std::min(range_m, Hit(ray, box));
    for (const Cylinder& cylinder : cylinders) range_m = std::min(range_m, Hit(ray, cylinder));
    for (const Sphere& crown : crowns) range_m = std::min(range_m, Hit(ray, crown, random));
    return range_m;
  }
};

// In the lidar's frame; thinned evenly to kPoints.
Cloud Scan(const Place& place, const Pose& T_world_lidar, Random& random) {
  std::vector<Eigen::Vector3d> all;
  for (int turn = 0; turn < kTurns; ++turn)
    for (int beam = 0; beam < kBeams; ++beam) {
      const double yaw = 2.0 * kPi * turn / kTurns, pitch = (-25.0 + 33.0 * beam / (kBeams - 1)) * kPi / 180.0;
      const Eigen::Vector3d direction(std::cos(pitch) * std::cos(yaw), std::cos(pitch) * std::sin(yaw),
                                      std::sin(pitch));
      const double range_m = place.Range_m({T_world_lidar.translation(), T_world_lidar.linear() * direction}, random);
      if (range_m > kRangeMin_m && range_m < kNone)
        all.push_back((range_m + kRangeNoise_m * random.Normal()) * direction);
    }
  Cloud cloud;
  const std::size_t count = std::min(all.size(), kPoints);
  for (std::size_t i = 0; i < count; ++i) cloud.positions.push_back(all[i * all.size() / count]);
  return cloud;
}

constexpr int kWidth = 640, kHeight = 480;

// 16-bit big-endian values of 1/1000 m along the optical axis, from a camera with f 518, 519 and c 325.5, 253.5 pixels.
Cloud ReadFrame(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::string magic;
  int width = 0, height = 0, max = 0;
  in >> magic >> width >> height >> max;
  in.get();
  std::vector<unsigned char> bytes(2 * kWidth * kHeight);
  in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  Cloud cloud;
  if (!in || magic != "P5" || width != kWidth || height != kHeight) return cloud;
  for (std::size_t i = 0; 2 * i < bytes.size(); ++i) {
    const double z = (bytes[2 * i] * 256 + bytes[2 * i + 1]) / 1000.0;
    const double u = static_cast<double>(i % kWidth), v = static_cast<double>(i / kWidth);
    if (z > 0.3 && z < 6.0) cloud.positions.push_back({(u - 325.5) / 518.0 * z, (v - 253.5) / 519.0 * z, z});
  }
  return cloud;
}

Pose Away() {
  Vector6d away;
  away << 0.15 * Eigen::Vector3d(1.0, -1.0, 1.0).normalized(),
      kPi / 36.0 * Eigen::Vector3d(1.0, 1.0, -1.0).normalized();
  return Exp(away);
}

}  // namespace

RegisterPair SimulatedPair() {
  Random random(11);
  const Place place(random);
  const Pose T_world_target = Pose(Eigen::Translation3d(0.0, 0.0, 1.8));
  Vector6d motion;
  motion << 1.3, 0.5, 0.02, 0.01, -0.008, 0.1;
  const Pose T_target_source = Exp(motion);
  RegisterPair pair{.name = "simulated lidar", .source = {}, .target = {}, .T_target_source = T_target_source};
  pair.target = Scan(place, T_world_target, random);
  pair.source = Scan(place, T_world_target * T_target_source, random);
  return pair;
}

std::vector<RegisterPair> RgbdPairs(const std::filesystem::path& folder) {
  std::vector<Pose> T_world_camera;
  std::ifstream in(folder / "pose.txt");
  for (double x, y, z, qx, qy, qz, qw; in >> x >> y >> z >> qx >> qy >> qz >> qw;)
    T_world_camera.push_back(Eigen::Translation3d(x, y, z) * Eigen::Quaterniond(qw, qx, qy, qz).normalized());
  std::vector<RegisterPair> pairs;
  for (std::size_t i = 1; i + 1 < T_world_camera.size(); ++i) {
    const std::string target = std::to_string(i + 1), source = std::to_string(i + 2);
    const Pose T = T_world_camera[i].inverse() * T_world_camera[i + 1];
    pairs.push_back({"RGB-D " + target + "-" + source, ReadFrame(folder / "depth" / (source + ".pgm")),
                     ReadFrame(folder / "depth" / (target + ".pgm")), T, T * Away()});
  }
  return pairs;
}

}  // namespace merlin
