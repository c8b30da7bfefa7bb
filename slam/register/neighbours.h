// Nearest neighbours in a cloud, found by nanoflann's k-d tree. The result depends on the geometry alone: of points at
// the same distance the one with the lowest index comes first.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace merlin {

struct Neighbour {
  double squared_m2 = 0.0;
  std::uint32_t index = 0;
  auto operator<=>(const Neighbour&) const = default;
};

class Neighbours {
 public:
  static constexpr double kAnywhere_m = 1e150;  // its square is still finite
  // Keeps a reference: the positions must outlive this, and be finite.
  explicit Neighbours(std::span<const Eigen::Vector3d> positions);
  ~Neighbours();
  Neighbours(const Neighbours&) = delete;
  Neighbours& operator=(const Neighbours&) = delete;

  // The nearest, not farther than reach_m.
  std::optional<Neighbour> Nearest(const Eigen::Vector3d& query, double reach_m) const;
  // Fills `found` with the nearest, near to far, none farther than reach_m. Returns how many there are.
  std::size_t Nearest(const Eigen::Vector3d& query, std::span<Neighbour> found, double reach_m = kAnywhere_m) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace merlin
