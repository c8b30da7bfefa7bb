// Surfaces of a free cloud: a normal per point, by principal components of its nearest neighbours.
#pragma once

#include <vector>

#include "slam/register/cloud.h"
#include "slam/register/neighbours.h"

namespace merlin {

struct Surfaces {
  // A unit normal per point, of either sign: the direction in which its nearest neighbours spread least. Zero where
  // they spread along one line only, or not at all.
  std::vector<Eigen::Vector3d> normals;
  // Share of the points whose neighbours spread like those on a surface: flat, but in two directions.
  double share = 0.0;
};

// From each point's `count` nearest neighbours, itself included.
Surfaces FindSurfaces(const Cloud& cloud, const Neighbours& neighbours, int count);

}  // namespace merlin
