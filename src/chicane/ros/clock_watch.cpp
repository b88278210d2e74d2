// SPDX-License-Identifier: MIT
#include "chicane/ros/clock_watch.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace chicane::ros {
namespace {

constexpr double kNanosecond = 1e-9;
constexpr double kHour = 3600.0;

double seconds(std::int64_t nanoseconds) { return kNanosecond * static_cast<double>(nanoseconds); }

}  // namespace

bool ClockWatch::accept(std::int64_t stamp, std::int64_t received, std::int64_t system) {
  if (!last_) {
    last_ = {stamp, received};
    const double age = seconds(system - stamp);
    const bool was = std::exchange(is_simulated_, std::fabs(age) > kHour);
    if (is_simulated_ && !was) {
      say(fmt::format(
          "the stamps of {} are {:.0f} h from this machine's time: simulated time (/clock), or another "
          "machine's clock; the moment of arrival counts",
          topic_, std::fabs(age) / kHour));
    }
    return true;
  }
  const double by_stamp = seconds(stamp - last_->stamp);
  const double by_arrival = seconds(received - last_->received);
  if (std::fabs(by_stamp - by_arrival) > kJump) {
    say(fmt::format("the clock of {} jumped by {:+.1f} s", topic_, by_stamp - by_arrival));
  } else if (by_stamp <= 0.0) {
    ++dropped_;
    if (!std::exchange(has_said_dropped_, true))
      say(fmt::format("a message of {} came {}: such messages are left out", topic_,
                      by_stamp == 0.0 ? "twice" : "after a newer one"));
    return false;
  }
  last_ = {stamp, received};
  return true;
}

void ClockWatch::say(std::string line) { news_ = std::move(line); }

std::string ClockWatch::news() { return std::exchange(news_, {}); }

}  // namespace chicane::ros
