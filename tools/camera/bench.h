// How fast the simulated cameras are: medians of wall time in corridor_26x21, the camera driving along it.
#pragma once

#include <atomic>
#include <optional>
#include <string>
#include <vector>

namespace merlin {

struct CameraBench {
  struct Depth {
    std::string model;
    std::string actor{};  // a person who crosses ahead of the camera; empty: nobody does
    int width = 0, height = 0;
    double one_thread_ms = 0.0, threads_ms = 0.0;  // a frame with all effects
    double limit_one_thread_ms = 0.0, limit_two_threads_ms = 0.0;
  };
  struct Color {
    std::string model, gl;
    int width = 0, height = 0;
    double frame_ms = 0.0, limit_ms = 0.0;
  };
  int frames = 100, threads = 2;
  std::vector<Depth> depth{};
  std::optional<Color> color{};
  std::string no_color{};                          // why there is none
  double rays_per_s = 0.0, multi_ray_per_s = 0.0;  // with normals, one thread, the same rays: ours, mj_multiRay's
};

// Ends early, and unfinished, when interrupted becomes true.
CameraBench BenchCamera(int threads, const std::atomic<bool>& interrupted);

std::string Table(const CameraBench& bench);
std::string ToJson(const CameraBench& bench);

}  // namespace merlin
