// SPDX-License-Identifier: MIT
#include "chicane/recording/replay.hpp"

#include <bit>
#include <memory>
#include <string>
#include <utility>
#include <variant>

#include "chicane/recording/reader.hpp"
#include "chicane/run/control_cycle.hpp"
#include "chicane/run/make.hpp"
#include "chicane/run/racing.hpp"
#include "chicane/run/setting.hpp"

namespace chicane::recording {
namespace {

bool is_same(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

/// The control cycles of a run, from the first step on.
class Recomputation {
 public:
  Recomputation(const scenario::Scenario& scenario, std::unique_ptr<controller::Controller> controller,
                std::optional<road::Track> track, std::shared_ptr<const road::RacingRoad> lap)
      : scenario_{scenario},
        track_{std::move(track)},
        cycle_{std::move(controller), scenario, track_ ? &*track_ : nullptr} {
    cycle_.use_line(std::move(lap));
  }

  /// What concerns neither controller nor vehicle changes nothing here.
  void add(const telemetry::Change& change) {
    const Result<run::Setting> setting = run::read_setting(change);
    if (!setting) return;
    if (const auto* learned = std::get_if<run::LearnedLap>(&setting->action)) {
      controller::LapRequest request = cycle_.controller().wants_lap();
      request.grip = learned->grip;
      request.slides = learned->slides;
      const auto lap = run::plan_wanted_lap(scenario_, track_ ? &*track_ : nullptr, request);
      if (lap) cycle_.use_line(*lap);
    }
    const auto* field = std::get_if<run::FieldValue>(&setting->action);
    if (field == nullptr) return;
    run::write(scenario_, *field);
    cycle_.configure(scenario_);
  }

  void add(const protocol::Step& step, ReplayReport& report) {
    ++report.steps;
    if (step.deadline_spent_at > 0) ++report.late;
    if (step.begins) cycle_.begin(step.cycle);
    if (step.cycle != cycle_.next()) {
      ++report.unknown;
      return;
    }
    const bool has_difference = !is_reproduced(step);
    ++(has_difference ? report.different : report.identical);
    if (has_difference && !report.first_difference) report.first_difference = step.cycle;
  }

 private:
  bool is_reproduced(const protocol::Step& step) {
    frame_.measurement = step.measurement;
    frame_.has_measurement = step.has_measurement;
    cycle_.step({.deadline = Deadline::never(),
                 .deadline_spent_at = step.deadline_spent_at,
                 .interval = step.gate_interval,
                 .manual = step.manual},
                frame_);
    const controller::StepResult& result = frame_.result;
    return is_same(result.command.steer, step.command.steer) &&
           is_same(result.command.throttle, step.command.throttle) && frame_.guard.rung == step.rung &&
           frame_.guard.gated == step.gated;
  }

  scenario::Scenario scenario_;
  std::optional<road::Track> track_;  ///< what guard and racing controller knew
  run::ControlCycle cycle_;
  telemetry::Frame frame_;
};

}  // namespace

Result<ReplayReport> verify_recording(const std::string& path, const run::Factories& make) {
  ReplayReport report;
  RecordingHead head;
  std::unique_ptr<Recomputation> again;
  const auto visit = [&](const RecordedEvent& event) -> Result<void> {
    if (const auto* scenario = std::get_if<scenario::Scenario>(&event)) {
      auto controller = make.controller(*scenario);
      if (!controller) return fail(controller.error());
      std::optional<road::Track> track;
      if (scenario->guard.road == safety::GuardRoad::kTrack) {
        auto found = make.track(*scenario);  // guard and racing controller knew it
        if (!found) return fail(found.error());
        track = std::move(*found);
      }
      auto lap = run::plan_lap(*scenario, track ? &*track : nullptr);
      if (!lap) return fail(lap.error());
      again = std::make_unique<Recomputation>(*scenario, std::move(*controller), std::move(track),
                                              std::move(*lap));
    } else if (const auto* change = std::get_if<telemetry::Change>(&event)) {
      again->add(*change);
    } else {
      again->add(std::get<RecordedStep>(event).step, report);
    }
    return {};
  };
  const Result<telemetry::McapReport> read = read_recording(path, head, visit);
  if (!read) return fail(read.error());
  if (report.steps == 0) {
    return fail(ErrorCode::kParse,
                path + ": steps: got none" +
                    (read->damaged > 0 ? " and " + std::to_string(read->damaged) + " damaged parts"
                                       : std::string(read->is_complete ? "" : " before the file's end")) +
                    ", expected a recording with control steps to compute again");
  }
  report.recorded_by = head["program"];
  report.controller = head["controller"];
  report.track = head["track"];
  report.damaged = read->damaged;
  report.is_complete = read->is_complete;
  return report;
}

}  // namespace chicane::recording
