// SPDX-License-Identifier: MIT
#include "chicane/ros/car_topics.hpp"
#include "support/chicane_test.hpp"

namespace chicane::ros {
namespace {

constexpr double kQuarter = 1.5707963267948966;

TEST(FrameTree, ComposesAndInvertsAlongChainsOfParents) {
  FrameTree frames;
  frames.put({.frame = "map", .child_frame = "odom", .pose = {.x = 10.0, .y = 0.0, .psi = kQuarter}});
  frames.put({.frame = "odom", .child_frame = "base", .pose = {.x = 2.0, .y = 1.0, .psi = 0.0}});
  frames.put({.frame = "map", .child_frame = "camera", .pose = {.x = 0.0, .y = 5.0, .psi = 0.0}});
  const auto base = test::good(frames.find("map", "base"));
  EXPECT_NEAR(base->x, 9.0, 1e-12);
  EXPECT_NEAR(base->y, 2.0, 1e-12);
  EXPECT_NEAR(base->psi, kQuarter, 1e-12);
  const auto back = test::good(frames.find("base", "map"));
  const model::Pose round = composed(*base, *back);
  EXPECT_NEAR(round.x, 0.0, 1e-12);
  EXPECT_NEAR(round.y, 0.0, 1e-12);
  const auto beside = frames.find("camera", "base");
  ASSERT_TRUE(beside) << "their chains meet in map";
  EXPECT_NEAR(beside->y, -3.0, 1e-12);
  EXPECT_TRUE(frames.find("/map", "base")) << "a slash in front is no other frame";
  EXPECT_FALSE(frames.find("world", "base"));
}

TEST(FrameTree, TheNewestTransformCounts) {
  FrameTree frames;
  frames.put({.frame = "map", .child_frame = "odom", .pose = {.x = 1.0}});
  frames.put({.frame = "map", .child_frame = "odom", .pose = {.x = 2.0}});
  frames.put(
      {.frame = "map", .child_frame = "odom", .pose = {.x = std::numeric_limits<double>::quiet_NaN()}});
  EXPECT_EQ(frames.find("map", "odom")->x, 2.0);
}

TEST(FrameTree, EndsInARingAndAtItsCapacity) {
  FrameTree frames;
  frames.put({.frame = "a", .child_frame = "b"});
  frames.put({.frame = "b", .child_frame = "a"});
  EXPECT_FALSE(frames.find("c", "a"));
  for (std::size_t i = 0; i < 2 * FrameTree::kCapacity; ++i)
    frames.put({.frame = "map", .child_frame = "frame" + std::to_string(i)});
  EXPECT_TRUE(frames.find("map", "frame0"));
  EXPECT_FALSE(frames.find("map", "frame" + std::to_string(2 * FrameTree::kCapacity - 1)));
}

}  // namespace
}  // namespace chicane::ros
