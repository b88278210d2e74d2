// SPDX-License-Identifier: MIT

#include "chicane/sim/fault.hpp"
#include "chicane/telemetry/frame.hpp"
#include "support/chicane_test.hpp"
#include "support/runs.hpp"

namespace chicane::run {
namespace {

struct Drive {
  std::string preset, car, fault;  ///< "position_jump@4+2"
  std::vector<std::pair<std::string, std::string>> more{};
};

/// What a reader of the sentence would say against the values of its frame; empty: nothing.
std::string against(const telemetry::Frame& frame, double full_brake) {
  const std::string text = telemetry::sentence_of(frame.situation);
  const double throttle = frame.applied.throttle;
  const double pedal = throttle < 0.0 ? throttle / full_brake : throttle;
  const double speed = std::hypot(frame.truth.vx, frame.truth.vy);
  const double grip = 100.0 * std::max(frame.tire_use[0], frame.tire_use[1]);
  const auto says = [&](const char* words) { return text.find(words) != std::string::npos; };
  if (std::count(text.begin(), text.end(), ' ') > 5) return "more than six words";
  if (says("Brakes") && !says("give") && pedal >= 0.0) return "brakes, and does not";
  if (says("Full throttle") && pedal < 0.98) return "full throttle, and is not";
  if (says("Part throttle") && (pedal <= 0.0 || pedal >= 0.98)) return "part throttle, and is not";
  if (says("Rolls") && std::fabs(pedal) >= 0.05) return "rolls, and does not";
  if (says("Grip") && (grip < 70.0 || !says(std::to_string(std::lround(grip)).c_str())))
    return "another grip";
  if ((says("stands") || says("holds")) && speed > 0.3) return "stands, and moves";
  if (says("Off the road") != (frame.situation.kind == telemetry::SituationKind::kOffRoad))
    return "off the road";
  const bool is_replaced = controller::word_of(frame.guard.rung).severity == Severity::kError;
  const bool is_alarm = telemetry::severity_of(frame.situation) == Severity::kError;
  if (is_replaced && !is_alarm) return "no alarm, and the controller is replaced";
  if (says("guard stops") && frame.guard.rung != controller::Rung::kGuardStop) return "stops, and does not";
  if (is_alarm && telemetry::what_ends(frame.situation).find("R starts again") == std::string::npos)
    return "an alarm that nothing ends";
  return "";
}

/// Drives for `seconds`, and looks at each frame.
void expect_true_sentences(const Drive& drive, double seconds) {
  protocol::Request ask{.scenario_file = {},
                        .settings = {{"preset", drive.preset}, {"car", drive.car}, {"track", "lakeside"}}};
  for (const auto& each : drive.more) ask.settings.push_back(each);
  if (!drive.fault.empty()) ask.faults.push_back(drive.fault);
  Result<scenario::Scenario> scenario = protocol::compose(ask);
  ASSERT_TRUE(scenario) << scenario.error().message;
  const auto loop = test::loop_of(*scenario);
  const std::string name = drive.preset + " " + drive.car + " " + drive.fault;
  int contradictions = 0;
  unsigned events = 0;
  double moved_at = 0.0, alarm_ended = -2.0;
  while (loop->time() < seconds && !loop->is_over()) {
    if (!loop->advance()) continue;
    const telemetry::Frame& frame = loop->frame();
    const std::string found = against(frame, scenario->vehicle.brake_throttle_limit);
    if (!found.empty() && contradictions++ < 3)
      ADD_FAILURE() << name << ", " << frame.time << " s: " << found << ": "
                    << telemetry::sentence_of(frame.situation) << ", pedal " << frame.applied.throttle;
    if (std::hypot(frame.truth.vx, frame.truth.vy) > 0.3) moved_at = frame.time;
    const bool is_stuck = frame.time - moved_at > 10.0;
    const bool must_know = controller::word_of(frame.guard.rung).severity == Severity::kError || is_stuck;
    if (is_stuck && contradictions++ < 3) {
      EXPECT_NE(telemetry::what_ends(frame.situation), "") << name << ", " << frame.time << " s";
      --contradictions;
    }
    if (telemetry::severity_of(frame.situation) == Severity::kError || must_know) {
      if (frame.time - alarm_ended > telemetry::kAlarmPause) ++events;
      alarm_ended = frame.time;
    }
  }
  EXPECT_LE(loop->frame().situation.alarms, events) << name;
  EXPECT_EQ(contradictions, 0) << name;
}

TEST(SituationOfRuns, AgreesWithTheAppliedValues) {
  const Drive drives[] = {
      {"default", "udacity", "", {}},
      {"default", "vw-vanagon", "position_jump@4+100", {}},
      {"weighted", "indy", "half_grip@4+3", {}},
      {"pid", "road-car", "frozen_sensor@4+100", {}},
      {"stanley", "f1tenth", "link_lost@4+2", {}},
      {"default", "udacity", "dead_controller@4+100", {{"guard.mode", "off"}}},
  };
  for (const Drive& drive : drives) expect_true_sentences(drive, 16.0);
}

#ifdef CHICANE_SLOW_TESTS
/// Minutes.
TEST(SituationOfRuns, AgreesWithTheAppliedValuesForEachPresetCarAndFault) {
  for (const protocol::Entry& preset : protocol::entries(protocol::Shelf::kPreset))
    for (const protocol::Entry& car : protocol::entries(protocol::Shelf::kCar))
      for (const sim::FaultKind& fault : sim::fault_kinds())
        expect_true_sentences({preset.name, car.name, std::string(fault.name) + "@6+3", {}}, 25.0);
}
#endif

}  // namespace
}  // namespace chicane::run
