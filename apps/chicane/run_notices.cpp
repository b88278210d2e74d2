// SPDX-License-Identifier: MIT
#include "run_notices.hpp"

#include <fmt/format.h>

#include <utility>

namespace chicane::apps {
namespace {

using telemetry::Situation;

bool is_replaced(const Situation& now) {
  return now.rung != controller::Rung::kController && now.driver != Situation::Driver::kPerson;
}

bool is_stuck(const Situation& now, double time) {
  return now.stands_since >= 0.0 && time - now.stands_since >= telemetry::kStuckAfter;
}

}  // namespace

std::vector<std::string> RunNotices::look_at(const telemetry::Frame& frame) {
  if (frame.time < last_time_) *this = {};  // another run
  last_time_ = frame.time;
  const Situation& now = frame.situation;
  if (now.driver == Situation::Driver::kPerson) said_.clear();
  if (!is_replaced(now) && severity_of(now) != Severity::kError) {
    std::string line = ended(frame.time);
    return line.empty() ? std::vector<std::string>{} : std::vector{std::move(line)};
  }
  const bool begins = said_.empty();
  if (begins) {
    began_ = frame.time;
    replaced_ = 0;
  }
  goes_on_ = true;
  if (is_replaced(now)) ++replaced_;
  const bool is_held = now.kind == telemetry::SituationKind::kGuardHolds;
  if (is_held && !is_stuck(now, frame.time) && !begins) return {};  // a stop that is said, and has ended
  std::string text = sentence_of(now);
  if (const auto reason = reason_of(now); !reason.empty() && (begins || !is_held))
    text.append(": ").append(reason);
  if (is_stuck(now, frame.time)) text.append(". ").append(what_ends(now));
  if (text == said_ || (!begins && frame.time - said_at_ < telemetry::kAlarmPause)) return {};
  said_ = std::move(text);
  said_at_ = frame.time;
  return {fmt::format("{:.1f} s: {}", frame.time, said_)};
}

/// The line that says so, once, after a pause.
std::string RunNotices::ended(double time) {
  if (std::exchange(goes_on_, false)) ended_ = time;
  if (said_.empty() || time - ended_ < telemetry::kAlarmPause) return "";
  said_.clear();
  const double lasted = ended_ - began_;
  if (replaced_ == 0) return fmt::format("{:.1f} s: the car moves again, after {:.1f} s", ended_, lasted);
  return fmt::format("{:.1f} s: the controller drives again, after {:.1f} s and {} replaced {}", ended_,
                     lasted, replaced_, replaced_ == 1 ? "command" : "commands");
}

}  // namespace chicane::apps
