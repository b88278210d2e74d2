// SPDX-License-Identifier: MIT
#include "chicane/road/line_planner.hpp"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace chicane::road {
namespace {

/// Two loops, of 5 and of 3 turns at a cost of 2, with `share` of work each cycle: (phase, turn) in the order
/// in which they were done, and how many cycles that took.
std::pair<std::vector<std::pair<int, int>>, int> run(int share) {
  Instalments instalments;
  std::vector<std::pair<int, int>> done;
  int cycles = 0;
  for (; instalments.phase() < 2 && cycles < 100; ++cycles) {
    int work = share;
    const auto turn = [&](int i) { done.emplace_back(instalments.phase(), i); };
    if (instalments.phase() == 0) instalments.loop(5, 2, work, turn);
    if (instalments.phase() == 1) instalments.loop(3, 2, work, turn);
  }
  return {done, cycles};
}

TEST(Instalments, DoEachTurnOnceAndInOrderHoweverTheWorkIsShared) {
  const std::vector<std::pair<int, int>> all{{0, 0}, {0, 1}, {0, 2}, {0, 3}, {0, 4}, {1, 0}, {1, 1}, {1, 2}};
  for (const int share : {1, 2, 3, 4, 7, 15, 16, 1000}) EXPECT_EQ(run(share).first, all) << share;
}

TEST(Instalments, TakeTheirShareOfWorkAndNoMoreThanATurnBeyondIt) {
  EXPECT_EQ(run(1000).second, 1);
  EXPECT_EQ(run(16).second, 1);
  EXPECT_EQ(run(4).second, 4);
  EXPECT_EQ(run(1).second, 8);
  Instalments instalments;
  int work = 5;
  instalments.loop(10, 2, work, [](int) {});
  EXPECT_EQ(work, -1);
  EXPECT_EQ(instalments.phase(), 0);
}

TEST(Instalments, DoNothingWithoutWork) {
  Instalments instalments;
  int work = 0;
  int turns = 0;
  instalments.loop(3, 1, work, [&](int) { ++turns; });
  EXPECT_EQ(turns, 0);
  EXPECT_EQ(instalments.phase(), 0);
}

TEST(Instalments, EnterAPhaseAtItsFirstTurnAndRestartAtTheFirst) {
  Instalments instalments;
  int work = 2;
  std::vector<int> done;
  const auto note = [&](int i) { done.push_back(i); };
  instalments.loop(5, 1, work, note);
  instalments.enter(7);
  EXPECT_EQ(instalments.phase(), 7);
  work = 1;
  instalments.loop(5, 1, work, note);
  instalments.restart();
  EXPECT_EQ(instalments.phase(), 0);
  work = 1;
  instalments.loop(5, 1, work, note);
  EXPECT_EQ(done, (std::vector<int>{0, 1, 0, 0}));
}

}  // namespace
}  // namespace chicane::road
