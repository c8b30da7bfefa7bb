#include "sim/tof/parallel.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <thread>
#include <vector>

namespace merlin::sim {
namespace {

TEST(ParallelFor, DoesEachPartOnceForAnyNumberOfThreads) {
  for (const int threads : {-1, 0, 1, 2, 3, 16})
    for (const int count : {0, 1, 2, 1000}) {
      std::vector<int> done(static_cast<std::size_t>(count), 0);
      ParallelFor(count, threads, [&](int i) { ++done[static_cast<std::size_t>(i)]; });
      EXPECT_EQ(done, std::vector<int>(static_cast<std::size_t>(count), 1)) << threads << " threads, " << count;
    }
}

TEST(ParallelFor, LetsOutWhatAPartThrows) {
  for (int round = 0; round < 100; ++round)
    EXPECT_THROW(ParallelFor(64, 4,
                             [](int i) {
                               if (i == 33) throw std::runtime_error("33");
                             }),
                 std::runtime_error);
}

TEST(ParallelFor, WorksWithinItselfAndFromSeveralThreadsAtOnce) {
  std::vector<std::vector<int>> done(4, std::vector<int>(400, 0));
  {
    std::vector<std::jthread> callers;
    for (std::vector<int>& mine : done)
      callers.emplace_back([&mine] {
        ParallelFor(20, 3,
                    [&](int i) { ParallelFor(20, 3, [&](int j) { ++mine[static_cast<std::size_t>(20 * i + j)]; }); });
      });
  }
  for (const std::vector<int>& mine : done) EXPECT_EQ(mine, std::vector<int>(400, 1));
}

}  // namespace
}  // namespace merlin::sim
