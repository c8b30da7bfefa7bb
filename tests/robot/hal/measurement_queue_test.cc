#include "robot/hal/measurement_queue.h"

#include <gtest/gtest.h>

#include <memory>

namespace merlin {
namespace {

using std::chrono::milliseconds;

TEST(MeasurementQueue, HandsEachOutOnceInOrder) {
  MeasurementQueue<int> queue;
  EXPECT_FALSE(queue.Take());
  for (int i = 1; i <= 3; ++i) queue.Put(i);
  for (int i = 1; i <= 3; ++i) EXPECT_EQ(queue.Take(), i);
  EXPECT_FALSE(queue.Take());
  EXPECT_EQ(queue.Counted({}).delivered, 3u);
  EXPECT_EQ(queue.Counted({}).missed, 0u);
}

TEST(MeasurementQueue, KeepsTheNewestFewAndCountsWhatIsMissed) {
  MeasurementQueue<int> queue(3);
  for (int i = 1; i <= 10; ++i) queue.Put(i);
  EXPECT_EQ(queue.Counted({}).missed, 7u);
  for (int i = 8; i <= 10; ++i) EXPECT_EQ(queue.Take(), i);
  EXPECT_FALSE(queue.Take());
  EXPECT_EQ(queue.Counted({}).delivered, 3u);
}

TEST(MeasurementQueue, KeepsOneWhereThereIsOnePlace) {
  MeasurementQueue<int> queue(1);
  queue.Put(1);
  queue.Put(2);
  EXPECT_EQ(queue.Take(), 2);
  EXPECT_EQ(queue.Counted({}).missed, 1u);
}

TEST(MeasurementQueue, HandsNothingOutBeforeItIsReady) {
  MeasurementQueue<int> queue;
  queue.Put(1, Time(milliseconds(20)), Time(0));
  EXPECT_FALSE(queue.Take(Time(milliseconds(20)) - Duration(1)));
  EXPECT_EQ(queue.Take(Time(milliseconds(20))), 1);
}

// A latency of 10 periods: ten are on their way at any time, and no reader has missed them.
TEST(MeasurementQueue, CountsNothingAsMissedThatIsStillOnItsWay) {
  MeasurementQueue<int> queue(2);
  const auto put = [&queue](int i) { queue.Put(i, Time(milliseconds(i + 10)), Time(milliseconds(i))); };
  for (int i = 0; i < 12; ++i) put(i);  // at 11 ms those of 0 and 1 are ready
  EXPECT_EQ(queue.Counted({}).missed, 0u);
  put(12);  // a third is ready: the first is lost
  EXPECT_EQ(queue.Counted({}).missed, 1u);
  EXPECT_EQ(queue.Take(Time(milliseconds(12))), 1);
  EXPECT_EQ(queue.Take(Time(milliseconds(12))), 2);
  EXPECT_FALSE(queue.Take(Time(milliseconds(12))));
}

TEST(MeasurementQueue, AddsItsCountsToAStatusAndLeavesTheRest) {
  MeasurementQueue<int> queue;
  queue.Put(1);
  queue.Take();
  const DeviceStatus status =
      queue.Counted({.health = DeviceStatus::Health::kFaulty, .since = Time(5), .missed = 9, .garbage = 4});
  EXPECT_EQ(status.health, DeviceStatus::Health::kFaulty);
  EXPECT_EQ(status.since, Time(5));
  EXPECT_EQ(status.delivered, 1u);
  EXPECT_EQ(status.missed, 0u);
  EXPECT_EQ(status.garbage, 4u);
}

TEST(MeasurementQueue, TakesWhatCanOnlyBeMoved) {
  MeasurementQueue<std::unique_ptr<int>> queue;
  queue.Put(std::make_unique<int>(3));
  EXPECT_EQ(**queue.Take(), 3);
}

}  // namespace
}  // namespace merlin
