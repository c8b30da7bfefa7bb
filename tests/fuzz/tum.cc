// Text of TUM files: it is rejected, each fault in one sentence, or accepted completely, with finite poses and
// ascending stamps.
#include <algorithm>
#include <functional>

#include "scenarios/judge/tum_file.h"
#include "tests/fuzz/text.h"

namespace merlin {
namespace {

void Check(std::string_view text) {
  const auto file = fuzz::TakenOrRefused(ParseTum, text);
  if (!file) return;
  const Trajectory& trajectory = file->trajectory;
  fuzz::Expect(!trajectory.empty(), "there are poses");
  fuzz::Expect(std::ranges::adjacent_find(trajectory, std::greater(), &StampedPose::stamp) == trajectory.end(),
               "stamps ascend");
  for (const StampedPose& pose : trajectory) fuzz::Expect(pose.T.matrix().allFinite(), "poses are finite");
  fuzz::Expect(PairAtNearestStamps(trajectory, trajectory, Duration(0)).size() == trajectory.size(),
               "each pose is nearest to itself");
}

}  // namespace

std::vector<Bytes> fuzz::Seeds() {
  std::vector<Bytes> seeds{ToBytes("# stamp x y z qx qy qz qw\n1.5 1 2 3 0 0 0.6 0.8\n2 4 5 6 0 0 0 1\n"),
                           ToBytes("1 0 0 0 0 0 1.2 1.6\n"), ToBytes("-3e2 0 0 0 0 1 0 0\r\n")};
  AddWords(seeds);
  return seeds;
}

}  // namespace merlin

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  merlin::Check(merlin::fuzz::ToText(data, size));
  return 0;
}
