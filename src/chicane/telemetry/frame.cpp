// SPDX-License-Identifier: MIT
// Situation of a run: its kind, computed from one frame, and the sentences for people in one table.
#include "chicane/telemetry/frame.hpp"

#include <algorithm>
#include <cmath>

#include "chicane/base/math.hpp"
#include "chicane/safety/supervisor.hpp"

namespace chicane::telemetry {
namespace {

using controller::GuardReason;
using controller::Rung;
using Kind = SituationKind;
using Driver = Situation::Driver;

/// Situations with name, severity and sentence. # stands for Situation::number, @ for the corner.
constexpr std::array<Word<Kind>, 19> kKinds{{
    {Kind::kStands, "stands", Severity::kOk, "The car stands"},
    {Kind::kGrip, "grip", Severity::kOk, "Grip: # %@"},
    {Kind::kBrakes, "brakes", Severity::kOk, "Brakes@"},
    {Kind::kFullThrottle, "full_throttle", Severity::kOk, "Full throttle@"},
    {Kind::kRolls, "rolls", Severity::kOk, "Rolls@"},
    {Kind::kPartThrottle, "part_throttle", Severity::kOk, "Part throttle@"},
    {Kind::kPersonDrives, "person_drives", Severity::kOk, "A person drives"},
    {Kind::kOtherSteering, "other_steering", Severity::kWarning, "Wheels turn otherwise than asked"},
    {Kind::kWeakBrakes, "weak_brakes", Severity::kWarning, "Brakes give less than asked"},
    {Kind::kThrottleLimited, "throttle_limited", Severity::kWarning, "The guard limits the throttle"},
    {Kind::kStopReported, "stop_reported", Severity::kWarning, "The guard would stop the car"},
    {Kind::kOffRoad, "off_road", Severity::kWarning, "Off the road by # m"},
    {Kind::kLastPlan, "last_plan", Severity::kWarning, "The car follows its last plan"},
    {Kind::kReturnsToRoad, "returns_to_road", Severity::kWarning, "The controller returns to the road"},
    {Kind::kStopsWithoutPlan, "stops_without_plan", Severity::kError, "The car stops without a plan"},
    {Kind::kControllerStops, "controller_stops", Severity::kError, "The controller stops the car"},
    {Kind::kGuardStops, "guard_stops", Severity::kError, "The guard stops the car"},
    {Kind::kGuardHolds, "guard_holds", Severity::kError, "The guard holds the car"},
    {Kind::kStuck, "stuck", Severity::kError, "The car stands and should drive"},
}};

constexpr const Word<Kind>& row_of(Kind kind) noexcept { return kKinds[static_cast<std::size_t>(kind)]; }

// All chosen. Thresholds of the applied pedal, as share of full throttle or braking.
constexpr double kNoPedal = 0.005;      // smaller pedals are shown as 0 %
constexpr double kPedal = 0.05;         // with smaller pedals the car rolls
constexpr double kFullThrottle = 0.98;  // least pedal that counts as full throttle
// Thresholds of the used grip.
constexpr double kNearLimit = 75.0;  // [%] use from which grip limits the car
constexpr double kStillNear = 70.0;  // [%] use down to which grip still limits the car
constexpr double kApproach = 100.0;  // [m] distance before a corner from which the corner is named
// Thresholds of the speed; between the two the car counts as before.
constexpr double kStanding = 0.1;  // [m/s] speed below which a car stands
constexpr double kMoving = 0.3;    // [m/s] speed above which a car moves

/// Speed of the car, true if it is known, else measured [m/s].
double speed_of(const Frame& frame) noexcept {
  return frame.has_truth ? chicane::hypot(frame.truth.vx, frame.truth.vy) : frame.measurement.speed;
}

/// Grip that the axle nearest its limit uses [%]; NaN: unknown.
double used_grip(const Frame& frame) noexcept {
  return 100.0 * std::fmax(frame.tire_use[0], frame.tire_use[1]);
}

/// Applied pedal as share of full throttle or, negative, of full braking.
double pedal_of(const Frame& frame, double full_brake) noexcept {
  const double throttle = frame.applied.throttle;
  return throttle < 0.0 ? std::max(-1.0, throttle / full_brake) : std::min(1.0, throttle);
}

Driver driver_of(const Frame& frame) noexcept {
  if (frame.is_manual) return Driver::kPerson;
  switch (frame.guard.rung) {
    case Rung::kController:
    case Rung::kReturnToRoad:
    case Rung::kStopOnRoad:
      return Driver::kController;
    default:
      return Driver::kGuard;
  }
}

/// Kind of the motion under the applied command. `grip`: used_grip() [%], `pedal`: pedal_of().
Kind motion_of(double grip, double pedal) noexcept {
  if (grip >= kNearLimit) return Kind::kGrip;
  if (pedal <= -kPedal) return Kind::kBrakes;
  if (pedal >= kFullThrottle) return Kind::kFullThrottle;
  return pedal < kPedal ? Kind::kRolls : Kind::kPartThrottle;
}

/// Whether a kind of motion_of() still holds; wider than its conditions there, so that sentences do not
/// flicker.
bool is_true(Kind kind, double grip, double pedal) noexcept {
  switch (kind) {
    case Kind::kGrip:
      return grip >= kStillNear;
    case Kind::kBrakes:
      return pedal < -kNoPedal;
    case Kind::kFullThrottle:
      return pedal >= kFullThrottle;
    case Kind::kRolls:
      return std::fabs(pedal) < kPedal;
    case Kind::kPartThrottle:
      return pedal > kNoPedal && pedal < kFullThrottle;
    default:
      return false;
  }
}

/// Kind of the guard's warning while the controller's command is sent; kStands: no warning.
Kind warning_of(GuardReason reason) noexcept {
  switch (reason) {
    case GuardReason::kNone:
    case GuardReason::kStuck:  // by the pedal; a standing car shows in its motion
      return Kind::kStands;
    case GuardReason::kOtherSteering:
      return Kind::kOtherSteering;
    case GuardReason::kWeakBrakes:
      return Kind::kWeakBrakes;
    case GuardReason::kTooFastForSilence:
      return Kind::kThrottleLimited;
    default:
      return Kind::kStopReported;
  }
}

/// Kind of a cycle in which another command than the controller's was sent.
Kind replaced_by(Rung rung, bool stands) noexcept {
  switch (rung) {
    case Rung::kShiftedPlan:
      return Kind::kLastPlan;
    case Rung::kReturnToRoad:
      return Kind::kReturnsToRoad;
    case Rung::kStopOnRoad:
      return Kind::kControllerStops;
    case Rung::kGuardStop:
      return stands ? Kind::kGuardHolds : Kind::kGuardStops;
    default:
      return Kind::kStopsWithoutPlan;
  }
}

/// Kind with the highest weight of those that hold.
Kind kind_of(const Frame& frame, const Situation& now, double grip) noexcept {
  const bool is_off_road = frame.is_judged && frame.is_off_track;
  if (frame.is_manual) return is_off_road ? Kind::kOffRoad : Kind::kPersonDrives;
  const bool stands = now.stands_since >= 0.0;
  const bool is_stuck = stands && frame.time - now.stands_since >= kStuckAfter;
  if (is_stuck) return now.rung == Rung::kGuardStop ? Kind::kGuardHolds : Kind::kStuck;
  if (now.rung != Rung::kController) return replaced_by(now.rung, stands);
  if (is_off_road) return Kind::kOffRoad;
  const Kind warning = warning_of(now.reason);
  if (warning != Kind::kStands || stands) return warning;
  return motion_of(grip, now.pedal);
}

/// Whether `s` lies in a corner, which may contain the start line.
bool is_in(const road::Corner& corner, double s) noexcept {
  return corner.begin <= corner.end ? corner.begin <= s && s <= corner.end
                                    : s >= corner.begin || s <= corner.end;
}

/// Sets the corner of the car at `s`, or the next one ahead within kApproach.
void set_corner(double s, std::span<const road::Corner> corners, Situation& now) noexcept {
  double nearest = kApproach;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const double distance = corners[i].begin - s;
    const bool is_here = is_in(corners[i], s);
    if (!is_here && !(distance >= 0.0 && distance < nearest)) continue;
    now.corner = static_cast<int>(i) + 1;
    now.is_ahead = !is_here;
    if (is_here) return;
    nearest = distance;
  }
}

/// Words between a sentence and the number of its corner; empty: the corner is not named.
std::string_view before_corner(const Situation& now) noexcept {
  if (!now.is_ahead) return " in T";
  switch (now.kind) {
    case Kind::kBrakes:
      return " for T";
    case Kind::kRolls:
      return " towards T";
    case Kind::kGrip:
    case Kind::kPartThrottle:
      return " before T";
    default:
      return "";
  }
}

/// Clause on what ends a condition of the guard, after "It ends ".
std::string_view end_of(GuardReason reason) noexcept {
  const safety::Condition* row = safety::condition_of(reason);
  switch (row == nullptr ? safety::ConditionEnd::kByMotion : row->ends) {
    case safety::ConditionEnd::kByItself:
      return "when the measurements are right again";
    case safety::ConditionEnd::kByTrial:
      return "when the measurements agree, or answer a trial of half a metre";
    case safety::ConditionEnd::kByAnswer:
      return "with the next answer that can be sent";
    case safety::ConditionEnd::kByMotion:
      return "when the car moves";
    case safety::ConditionEnd::kByPerson:
      return "when a person has turned the car";
  }
  return "";
}

}  // namespace

Situation situation_of(const Frame& frame, const Situation& before, const SituationTerms& terms) noexcept {
  const bool begins = frame.begins && frame.cycle == 0;
  const Situation last = begins || frame.time < before.kind_since ? Situation{} : before;
  Situation now;
  now.driver = driver_of(frame);
  now.rung = frame.guard.rung;
  now.reason = frame.guard.reason;
  now.remedy = terms.remedy;
  now.pedal = pedal_of(frame, terms.full_brake);
  now.alarmed_at = last.alarmed_at;
  now.alarms = last.alarms;
  now.event_since = last.event_since;
  const double speed = speed_of(frame);
  const bool stood = last.stands_since >= 0.0;
  if (stood ? !(speed > kMoving) : speed < kStanding)
    now.stands_since = stood && !frame.is_manual ? last.stands_since : frame.time;
  if (frame.is_judged) set_corner(frame.s, terms.corners, now);

  const double grip = used_grip(frame);
  now.kind = kind_of(frame, now, grip);
  const bool is_motion = is_true(now.kind, grip, now.pedal);
  if (is_motion && frame.time - last.kind_since < kSentenceHeld && is_true(last.kind, grip, now.pedal))
    now.kind = last.kind;
  now.kind_since = now.kind == last.kind && !begins ? last.kind_since : frame.time;
  if (now.kind == Kind::kGrip) now.number = grip;
  if (now.kind == Kind::kOffRoad) now.number = std::max(0.1, -frame.edge_distance);

  if (severity_of(now) == Severity::kError) {
    const bool goes_on = last.alarmed_at >= 0.0 && frame.time - last.alarmed_at <= kAlarmPause;
    if (!goes_on) {
      ++now.alarms;
      now.event_since = frame.time;
    }
    now.alarmed_at = frame.time;
  }
  return now;
}

std::string_view name_of(SituationKind kind) noexcept { return row_of(kind).name; }

std::string_view name_of(Situation::Driver driver) noexcept {
  constexpr std::array<std::string_view, 3> kNames{"controller", "guard", "person"};
  return kNames[static_cast<std::size_t>(driver)];
}

std::string_view name_of(Severity severity) noexcept {
  constexpr std::array<std::string_view, 3> kNames{"normal", "notice", "alarm"};
  return kNames[static_cast<std::size_t>(severity)];
}

Severity severity_of(const Situation& situation) noexcept { return row_of(situation.kind).severity; }

std::string sentence_of(const Situation& situation) {
  const double digits = situation.kind == Kind::kOffRoad ? 10.0 : 1.0;
  const std::string_view link = before_corner(situation);
  std::string text;
  for (const char letter : row_of(situation.kind).sentence) {
    if (letter == '#')
      text += number_text(std::round(digits * situation.number) / digits);
    else if (letter != '@')
      text += letter;
    else if (situation.corner > 0 && !link.empty())
      text.append(link).append(std::to_string(situation.corner));
  }
  return text;
}

std::string_view reason_of(const Situation& situation) noexcept {
  if (situation.driver == Driver::kPerson) return "";
  const bool is_alarm = severity_of(situation) == Severity::kError;
  if (situation.reason != GuardReason::kNone && severity_of(situation) != Severity::kOk)
    return controller::word_of(situation.reason).sentence;
  if (!is_alarm) return "";
  if (situation.rung != Rung::kController) return controller::word_of(situation.rung).sentence;
  if (situation.pedal > kNoPedal) return "its throttle does not move it";
  return situation.pedal < -kNoPedal ? "the controller brakes" : "the controller gives no throttle";
}

std::string what_ends(const Situation& situation) {
  if (severity_of(situation) != Severity::kError) return "";
  return std::string("It ends ").append(end_of(situation.reason)).append(". ").append(situation.remedy) + ".";
}

}  // namespace chicane::telemetry
