// SPDX-License-Identifier: MIT
#include "chicane/recording/replay.hpp"

#include <bit>
#include <limits>
#include <memory>
#include <utility>
#include <variant>

#include "chicane/controller/controller.hpp"
#include "chicane/protocol/schema.hpp"
#include "chicane/recording/reader.hpp"
#include "chicane/run/make.hpp"
#include "chicane/safety/command_gate.hpp"

namespace chicane::recording {
namespace {

bool is_same(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

/// A controller and its gate, from the first step on.
class Recomputation {
 public:
  Recomputation(const scenario::Scenario& scenario, std::unique_ptr<controller::Controller> controller)
      : scenario_{scenario}, controller_{std::move(controller)}, gate_{scenario.vehicle} {}

  /// What concerns neither controller nor vehicle changes nothing here.
  void add(const telemetry::Change& change) {
    if (!protocol::set_text(scenario_, change.name.view(), change.value.view())) return;
    run::configure(*controller_, scenario_);
    gate_.set_vehicle(scenario_.vehicle);
  }

  void add(const protocol::Step& step, ReplayReport& report) {
    ++report.steps;
    if (step.deadline_spent_at > 0) ++report.late;
    if (step.begins) {
      controller_->reset();
      gate_.reset();
      next_cycle_ = step.cycle;
    }
    if (step.cycle != next_cycle_) {
      ++report.unknown;
      return;
    }
    ++next_cycle_;
    const bool has_difference = !is_reproduced(step);
    ++(has_difference ? report.different : report.identical);
    if (has_difference && !report.first_difference) report.first_difference = step.cycle;
  }

 private:
  bool is_reproduced(const protocol::Step& step) {
    const auto [wish, rung] = answer(step);
    const safety::GateResult gated = gate_.pass(step.manual.value_or(wish), step.gate_interval);
    if (step.manual) controller_->note_sent(gated.command);
    return is_same(gated.command.steer, step.command.steer) &&
           is_same(gated.command.throttle, step.command.throttle) && rung == step.rung &&
           (gated.reason != safety::GateReason::kNone) == step.gated;
  }

  /// What the controller wanted, and which rung of it.
  std::pair<model::Command, controller::Rung> answer(const protocol::Step& step) {
    if (!step.has_measurement) {
      constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
      return {{.steer = kNothing, .throttle = kNothing}, controller::Rung::kHoldAndBrake};
    }
    DeadlineLog questions{.spent_at = step.deadline_spent_at};
    const controller::StepResult& result =
        controller_->step(step.measurement, Deadline::never().counted_in(questions));
    return {result.command, result.report.rung};
  }

  scenario::Scenario scenario_;
  std::unique_ptr<controller::Controller> controller_;
  safety::CommandGate gate_;
  std::uint64_t next_cycle_ = 0;
};

}  // namespace

Result<ReplayReport> verify_recording(const std::string& path) {
  ReplayReport report;
  RecordingHead head;
  std::unique_ptr<Recomputation> again;
  const auto visit = [&](const RecordedEvent& event) -> Result<void> {
    if (const auto* scenario = std::get_if<scenario::Scenario>(&event)) {
      auto controller = run::make_controller(*scenario);
      if (!controller) return fail(controller.error());
      again = std::make_unique<Recomputation>(*scenario, std::move(*controller));
    } else if (const auto* change = std::get_if<telemetry::Change>(&event)) {
      again->add(*change);
    } else {
      again->add(std::get<RecordedStep>(event).step, report);
    }
    return {};
  };
  const Result<telemetry::McapReport> read = read_recording(path, head, visit);
  if (!read) return fail(read.error());
  report.recorded_by = head["program"];
  report.controller = head["controller"];
  report.track = head["track"];
  report.damaged = read->damaged;
  report.is_complete = read->is_complete;
  return report;
}

}  // namespace chicane::recording
