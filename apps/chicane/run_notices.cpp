// SPDX-License-Identifier: MIT
#include "run_notices.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "chicane/controller/guard_words.hpp"
#include "chicane/safety/supervisor.hpp"

namespace chicane::apps {
namespace {

constexpr double kNoPedal = 0.005;  // smaller pedals neither drive nor brake

/// Speed of the plant, or the measured one where another program simulates; NaN without a measurement [m/s].
double speed_of(const telemetry::Frame& frame) {
  return std::fabs(frame.has_truth ? frame.truth.vx : frame.measurement.speed);
}

bool is_intervention(const telemetry::Frame& frame) {
  return frame.guard.rung != controller::Rung::kController && !frame.is_manual;
}

std::string intervention_of(const telemetry::Frame& frame) {
  return controller::sentence_of(controller::describe_driver(frame.guard.rung, frame.guard.reason));
}

/// End of a stop that outlasts its sensor's fault; empty: nothing has to be done.
std::string_view end_of(controller::GuardReason reason) {
  const bool is_tried =
      std::any_of(safety::kConditions.begin(), safety::kConditions.end(), [&](const safety::Condition& each) {
        return each.reason == reason && each.ends == safety::ConditionEnd::kByTrial;
      });
  return is_tried ? "; it is tried by half a metre, else ends by a restart, or by driving by hand" : "";
}

/// Why a car stands: the intervention, else the pedal that acts on it.
std::string reason_of_standing(const telemetry::Frame& frame) {
  if (is_intervention(frame)) return intervention_of(frame).append(end_of(frame.guard.reason));
  const double pedal = frame.applied.throttle;
  if (pedal > kNoPedal) return fmt::format("a throttle of {:.2f} does not move it", pedal);
  return pedal < -kNoPedal ? fmt::format("the controller brakes with {:.2f}", -pedal)
                           : "the controller gives no throttle";
}

}  // namespace

std::vector<std::string> RunNotices::look_at(const telemetry::Frame& frame) {
  if (frame.time < last_time_) *this = {};  // another run
  last_time_ = frame.time;
  Lines lines;
  watch_guard(frame, lines);
  watch_standing(frame, lines);
  return lines;
}

void RunNotices::watch_guard(const telemetry::Frame& frame, Lines& lines) {
  const bool is_replaced = is_intervention(frame);
  const bool has_settled = !is_replaced && !is_replaced_ && frame.time - ended_ >= kPause;
  if (!intervention_.empty() && has_settled) {
    lines.push_back(fmt::format("{:.1f} s: the controller drives again, after {:.1f} s and {} replaced {}",
                                ended_, ended_ - began_, steps_, steps_ == 1 ? "command" : "commands"));
    intervention_.clear();
  }
  if (is_replaced_ && !is_replaced) ended_ = frame.time;
  is_replaced_ = is_replaced;
  if (!is_replaced) return;
  if (intervention_.empty()) {
    began_ = frame.time;
    steps_ = 0;
  }
  ++steps_;
  const std::string sentence = intervention_of(frame);
  const bool may_say = intervention_.empty() || frame.time - said_ >= kPause;
  if (sentence == intervention_ || !may_say) return;
  lines.push_back(fmt::format("{:.1f} s: {}", frame.time, sentence));
  intervention_ = sentence;
  said_ = frame.time;
}

void RunNotices::watch_standing(const telemetry::Frame& frame, Lines& lines) {
  const double speed = speed_of(frame);
  if (speed > kMovingSpeed || frame.is_manual) {
    if (is_reported_ && !frame.is_manual)
      lines.push_back(fmt::format("{:.1f} s: the car moves again, after {:.1f} s", frame.time,
                                  frame.time - stood_since_));
    stands_ = is_reported_ = false;
    return;
  }
  if (speed < kStandingSpeed && !stands_) {
    stands_ = true;
    stood_since_ = frame.time;
  }
  if (!stands_ || is_reported_ || frame.time - stood_since_ < kStoodTime) return;
  is_reported_ = true;
  lines.push_back(fmt::format("{:.1f} s: the car has stood for {:g} s: {}{}", frame.time, kStoodTime,
                              reason_of_standing(frame),
                              frame.is_off_track ? "; a tyre is off the road" : ""));
}

}  // namespace chicane::apps
