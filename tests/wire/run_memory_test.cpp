// SPDX-License-Identifier: MIT
#include "chicane/wire/run_memory.hpp"

#include <deque>

#include "support/chicane_test.hpp"

namespace chicane::wire {
namespace {

std::vector<double> frame_times(const RunMemory& memory) {
  std::vector<double> times;
  std::uint64_t before = memory.end();
  EXPECT_EQ(memory.frame_before(0), nullptr);
  while (const KeptMessage* message = memory.frame_before(before)) {
    before = message->number;
    EXPECT_EQ(memory.frames_before(memory.end()) - memory.frames_before(before), times.size() + 1);
    times.push_back(message->time);
  }
  std::reverse(times.begin(), times.end());
  return times;
}

TEST(RunMemory, KeepsAllFramesOfTheLastMinuteAndOlderOnesAtADistance) {
  RunMemory memory;
  constexpr double kPeriod = 0.04;
  for (int i = 0; i < 5000; ++i) memory.add_frame(kPeriod * i, std::to_string(i));
  const std::vector<double> times = frame_times(memory);
  const double newest = kPeriod * 4999;
  EXPECT_EQ(times.front(), 0.0);
  EXPECT_EQ(times.back(), newest);
  for (std::size_t i = 1; i < times.size(); ++i) {
    const double gap = times[i] - times[i - 1];
    if (times[i - 1] >= newest - RunMemory::kDense)
      EXPECT_NEAR(gap, kPeriod, 1e-9) << times[i];
    else
      EXPECT_LE(gap, RunMemory::kSpacing + 1e-9) << times[i];  // rounding of products
  }
  EXPECT_LT(times.size(), 1501U + 701U);  // 60 s of 25 a second, 140 s of 5 a second
}

TEST(RunMemory, StopsGrowing) {
  RunMemory memory;
  for (int i = 0; i < 30'000; ++i) {
    memory.add_frame(0.1 * i, {});
    memory.add_change(0.1 * i, {});
  }
  EXPECT_LE(frame_times(memory).size(), RunMemory::kMostSparse + RunMemory::kMostDense);
  EXPECT_EQ(memory.change_from(0)->time, 0.1 * (30'000 - static_cast<int>(RunMemory::kMostChanges)));
}

TEST(RunMemory, NeverForgetsTheBestLap) {
  RunMemory memory;
  const auto add = [&](int lap, double time, bool is_clean) {
    memory.add_lap({.lap = lap, .lap_time = time, .is_clean = is_clean}, lap, std::to_string(lap));
  };
  add(1, 30.0, true);
  add(2, 20.0, false);  // fast, but off the road
  for (int lap = 3; lap < 1500; ++lap) add(lap, 40.0, true);
  EXPECT_EQ(memory.lap_from(0)->payload, "1");
  EXPECT_EQ(memory.lap_from(memory.lap_from(0)->number + 1)->payload, "501");
}

TEST(RunMemory, GoesOnCountingWhenTheRunBeginsAnew) {
  RunMemory memory;
  memory.add_lap({.lap = 1}, 1.0, "old");
  const std::uint64_t seen = memory.lap_from(0)->number;
  memory.forget();
  EXPECT_EQ(memory.lap_from(0), nullptr);
  EXPECT_EQ(memory.frame_before(memory.end()), nullptr);
  memory.add_lap({.lap = 1}, 0.5, "new");
  ASSERT_NE(memory.lap_from(seen + 1), nullptr);
  EXPECT_EQ(memory.lap_from(seen + 1)->payload, "new");
}

/// A link that carries `rate` byte/s one after the other, and `delay` s each way.
class Link {
 public:
  Link(double rate, double delay) : rate_{rate}, delay_{delay} {}

  /// Sends whatever has room for `seconds`, in messages of `bytes`; the longest that one took to arrive [s].
  double run(LinkPace& pace, double seconds, std::size_t bytes) {
    double longest = 0.0;
    for (const double end = now_ + seconds; now_ < end; now_ += 0.016) {
      for (; !acknowledged_.empty() && acknowledged_.front().at <= now_; acknowledged_.pop_front())
        pace.received(acknowledged_.front().total, now_);
      while (pace.has_room()) {
        pace.sent(bytes, now_);
        sent_ += bytes;
        free_ = std::max(free_, now_) + static_cast<double>(bytes) / rate_;
        longest = std::max(longest, free_ + delay_ - now_);
        acknowledged_.push_back({sent_, free_ + 2.0 * delay_});
      }
    }
    return longest;
  }
  [[nodiscard]] double carried() const { return static_cast<double>(sent_); }

 private:
  struct Read {
    std::uint64_t total = 0;
    double at = 0.0;
  };
  double rate_, delay_, now_ = 0.0, free_ = 0.0;
  std::uint64_t sent_ = 0;
  std::deque<Read> acknowledged_;
};

TEST(LinkPace, KeepsWhatIsOnItsWayOnASlowLinkShort) {
  Link link{64e3, 0.2};
  LinkPace pace;
  EXPECT_LT(link.run(pace, 5.0, 3000), 1.0) << "while it finds out";
  const double before = link.carried();
  EXPECT_LT(link.run(pace, 20.0, 3000), 0.6) << "one way, and a queue that is aimed at 0.15 s";
  EXPECT_GT(link.carried() - before, 0.85 * 20.0 * 64e3) << "the link is used";
}

TEST(LinkPace, LetsAFastLinkCarryMegabytesInASecond) {
  Link link{50e6, 0.001};
  LinkPace pace;
  link.run(pace, 1.0, 3000);
  EXPECT_GT(link.carried(), 10e6);
}

TEST(LinkPace, SlowsDownWhenTheLinkDoes) {
  Link fast{10e6, 0.02}, slow{64e3, 0.02};
  LinkPace pace;
  fast.run(pace, 2.0, 3000);
  const std::size_t before = pace.window();
  // What the fast link carried is acknowledged late by the slow one.
  for (double now = 10.0; now < 12.0; now += 0.5) {
    pace.sent(3000, now);
    pace.received(static_cast<std::uint64_t>(fast.carried()), now + 0.4);
  }
  pace.received(static_cast<std::uint64_t>(fast.carried()) + 12000, 13.0);
  EXPECT_LT(pace.window(), before / 2);
  EXPECT_GE(pace.window(), LinkPace::kLeast);
}

TEST(LinkPace, CountsWhatWasSentAndWaitsForAReaderThatReadsNothing) {
  LinkPace pace;
  pace.sent(1000, 0.0);
  pace.received(5000, 0.1);
  EXPECT_EQ(pace.in_flight(), 1000U) << "more than was sent";
  pace.received(1000, 0.1);
  pace.received(500, 0.2);
  EXPECT_EQ(pace.in_flight(), 0U);
  LinkPace other;
  std::size_t sent = 0;
  for (; other.has_room(); sent += 3000) other.sent(3000, 0.0);
  EXPECT_LE(sent, LinkPace::kFirst + 3000);
}

}  // namespace
}  // namespace chicane::wire
