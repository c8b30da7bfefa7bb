// PLY in its three formats.
#include "tests/fuzz/cloud.h"

namespace merlin {

std::vector<Bytes> fuzz::Seeds() {
  const std::string elements =
      " 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\nproperty list uchar short tags\n"
      "end_header\n";
  const std::string list("\x01\x05\x00", 3), one("\x00\x00\x80\x3f", 4);
  const std::string row = one + one + one;
  std::vector<Bytes> seeds{ToBytes("ply\nformat ascii" + elements + "1 2 3 0\n4 5 6 1 7\n"),
                           ToBytes("ply\nformat binary_little_endian" + elements + row + list + row + '\0'),
                           ToBytes("ply\nformat binary_big_endian" + elements + row + list + row + '\0'),
                           ToBytes("ply\nformat ascii 1.0\nelement vertex 1\nproperty double x\nproperty double y\n"
                                   "property double z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
                                   "element face 1\nproperty list uchar int i\nend_header\n1 2 3 9 8 7\n1 0\n")};
  for (const char* word : {"vertex", "list", "property", "uint64", "end_header\n", "comment "})
    seeds.push_back(ToBytes(word));
  AddWords(seeds);
  return seeds;
}

}  // namespace merlin

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  merlin::fuzz::CheckCloud(merlin::ParsePly, merlin::fuzz::ToText(data, size), "\n7");
  return 0;
}
