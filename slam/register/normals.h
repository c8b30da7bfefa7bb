// Surfaces of a free cloud, from each point's nearest neighbours.
#pragma once

#include <vector>

#include "slam/register/cloud.h"
#include "slam/register/neighbours.h"

namespace merlin {

struct Surfaces {
  // A unit normal a point, either sign: the direction in which its nearest neighbours spread least. Zero where they
  // spread along one line only, or not at all.
  std::vector<Eigen::Vector3d> normals;
  // Of the points whose neighbours lie like those on a surface: flat, and to both sides.
  double share = 0.0;
};

// From each point's `count` nearest neighbours, itself included.
Surfaces FindSurfaces(const Cloud& cloud, const Neighbours& neighbours, int count);

}  // namespace merlin
