// SPDX-License-Identifier: MIT
// Time of a ROS 2 node: stamps of messages checked against arrival times, and simulated time by /clock.
#include "chicane/ros/node_clock.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace chicane::ros {
namespace {

constexpr double kNanosecond = 1e-9;
constexpr double kHour = 3600.0;  // [s] difference of clocks from which time counts as simulated; chosen

double seconds(std::int64_t nanoseconds) { return kNanosecond * static_cast<double>(nanoseconds); }

}  // namespace

bool ClockWatch::accept(std::int64_t stamp, std::int64_t received, std::int64_t system) {
  if (!last_) {
    last_ = {stamp, received};
    offset_ = received - stamp;
    const double age = seconds(system - stamp);
    const bool was = std::exchange(is_simulated_, std::fabs(age) > kHour);
    if (is_simulated_ && !was) {
      news_ = fmt::format(
          "the stamps of {} are {:.0f} h from this machine's time: simulated time (/clock), or another "
          "machine's clock; the moment of arrival counts",
          topic_, std::fabs(age) / kHour);
    }
    return true;
  }
  const double by_stamp = seconds(stamp - last_->stamp);
  const double by_arrival = seconds(received - last_->received);
  if (std::fabs(by_stamp - by_arrival) > kJump) {
    news_ = fmt::format("the clock of {} jumped by {:+.1f} s", topic_, by_stamp - by_arrival);
    offset_ = received - stamp;
  } else if (by_stamp <= 0.0) {
    if (!std::exchange(has_said_dropped_, true))
      news_ = fmt::format("a message of {} came {}: such messages are left out", topic_,
                          by_stamp == 0.0 ? "twice" : "after a newer one");
    return false;
  }
  follow(received - stamp, by_arrival);
  last_ = {stamp, received};
  return true;
}

// Clocks drift apart, and stamps of simulated time may run slower than the machine's clock: the offset of the
// fastest message is forgotten slowly.
void ClockWatch::follow(std::int64_t lag, double since) {
  constexpr double kDrift = 1e-3;  // growth of the offset with time [s/s]; chosen: beyond the drift of clocks
  offset_ = std::min(offset_ + static_cast<std::int64_t>(kDrift * since / kNanosecond), lag);
  if (seconds(lag - offset_) > kLatest) offset_ = lag;
}

std::string ClockWatch::news() { return std::exchange(news_, {}); }

std::string NodeClock::tick(std::int64_t time) {
  if (!is_simulated_) return {};
  if (has_ticked_ && time >= time_) {
    time_ = time;
    return {};
  }
  std::string news = has_ticked_ ? fmt::format("/clock went back by {:.1f} s: a simulation that began anew?",
                                               1e-9 * static_cast<double>(time_ - time))
                                 : std::string("/clock is there: time is simulated");
  base_ = now();
  first_ = time_ = time;
  has_ticked_ = true;
  return news;
}

std::int64_t NodeClock::stamp_now() const {
  if (is_simulated_) return time_;
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

}  // namespace chicane::ros
