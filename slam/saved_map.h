// A map that outlives its run: the file map.slam. It holds the key frames, of which all maps are made, and the graph:
// the steps between key frames, their headings and the closed loops. A map that was saved and loaded is the same bit by
// bit, and gives the same matches. Signatures of places are computed from the key frames, so the file needs none.
//
//   bytes    what
//   0 - 7    "map.slam"
//   8 - 11   version of this format (unsigned); each version is read by its own program only
//   12 - 19  size of the content in bytes (unsigned)
//   20 - 83  SHA-256 of the content, as hexadecimal digits
//   84 -     content, in the order of saved_map.cc
//
// All numbers are little-endian.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "slam/graph/pose_graph.h"
#include "slam/keyframe.h"

namespace merlin {

struct SavedMap {
  static constexpr std::uint32_t kVersion = 1;

  std::vector<Keyframe> keyframes{};  // in the order of path_m and of stamps
  std::vector<GraphEdge> loops{};     // closed loops, between key frames
  // Yaw in the map less yaw by the compass; nothing where the map was made without a compass.
  std::optional<double> heading_turn_rad{};
};

// The bytes of map.slam.
std::string ToBytes(const SavedMap& map);

// name: the file's, for the message. Throws InputError for anything but a whole map of this version with at least one
// key frame; it never takes more memory than a few times the size of the bytes.
SavedMap ParseSavedMap(std::string_view bytes, const std::string& name);

// The same from a file. Throws InputError also for one that cannot be read.
SavedMap ReadSavedMap(const std::filesystem::path& file);

}  // namespace merlin
