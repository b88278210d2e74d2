// SPDX-License-Identifier: MIT
// Computes recordings again: reads their events in order, drives the control cycle with each measurement, and
// compares the commands.
#include "chicane/recording/replay.hpp"

#include <array>
#include <bit>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "chicane/base/instruction_set.hpp"
#include "chicane/base/text.hpp"
#include "chicane/protocol/car_messages.hpp"
#include "chicane/protocol/yaml_codec.hpp"
#include "chicane/recording/recorder.hpp"
#include "chicane/run/control_cycle.hpp"
#include "chicane/run/make.hpp"
#include "chicane/run/racing.hpp"
#include "chicane/run/setting.hpp"

namespace chicane::recording {
namespace {

/// Sets the arithmetic of the recording for all later controllers.
Result<void> choose_arithmetic(const std::string& wanted, const std::string& path) {
  if (wanted.empty() || arithmetic(chosen_instruction_set()) == wanted) return {};
  using enum InstructionSet;
  for (const InstructionSet set : {kAvx512, kAvx2, kNeon, kBaseline}) {
    if (!is_available(set) || arithmetic(set) != wanted) continue;
    choose_instruction_set(set);
    return {};
  }
  for (const InstructionSet set : {kAvx512, kAvx2, kNeon, kBaseline}) {
    if (!is_supported(set) || arithmetic(set) != wanted) continue;
    return fail(ErrorCode::kInvalidArgument, path + ": arithmetic: got \"" + wanted + "\", which needs " +
                                                 std::string(to_string(set)) + ": that was not built in. " +
                                                 how_to_build(to_string(set)));
  }
  return fail(ErrorCode::kInvalidArgument,
              path + ": arithmetic: got \"" + wanted + "\", expected \"" +
                  std::string(arithmetic(chosen_instruction_set())) +
                  "\", which is all that this processor has: use one like that it was recorded on");
}

Result<scenario::Scenario> parse_scenario(std::string_view yaml, const std::string& file) {
  const Result<protocol::Document> document = protocol::parse_document(yaml, file);
  if (!document) return fail(document.error());
  scenario::Scenario scenario;
  const std::array layers{*document};
  if (Result<void> applied = protocol::apply_layers(layers, scenario); !applied) return fail(applied.error());
  return scenario;
}

class RecordingReader {
 public:
  RecordingReader(const std::string& path, RecordingHead& head,
                  const std::function<Result<void>(const RecordedEvent&)>& visit)
      : path_{path}, head_{head}, visit_{visit} {}

  Result<telemetry::McapReport> read() {
    Result<telemetry::McapReport> report = telemetry::read_mcap(
        path_,
        {.on_message = [this](const telemetry::McapMessage& message) { take(message); },
         .on_attachment = [this](std::string_view name, std::string_view bytes) { take(name, bytes); },
         .on_metadata = [this](std::string_view name,
                               const std::map<std::string, std::string>& entries) { take(name, entries); }});
    if (!report) return report;
    if (!state_) return fail(state_.error());
    if (!has_scenario_) {
      return fail(ErrorCode::kParse,
                  path_ + ": " + kRecordedScenario + ": got none, expected a recording of chicane");
    }
    report->damaged += damaged_;
    return report;
  }

 private:
  void take(const telemetry::McapMessage& message) {
    if (!state_ || !has_scenario_) return;
    if (message.channel.topic == protocol::kChangeTopic) {
      const auto change = protocol::decode_change(message.bytes);
      if (!change) ++damaged_;
      if (change) state_ = visit_(*change);
    } else if (message.channel.topic == protocol::kStepTopic) {
      const auto step = protocol::decode_step(message.bytes);
      if (!step) ++damaged_;
      if (step) state_ = visit_(RecordedStep{*step, 1e-9 * static_cast<double>(message.log_time)});
    }
  }

  void take(std::string_view name, std::string_view bytes) {
    if (name != kRecordedScenario || !state_) return;
    const Result<scenario::Scenario> scenario = parse_scenario(bytes, path_ + ":" + kRecordedScenario);
    has_scenario_ = true;
    state_ = scenario ? visit_(*scenario) : fail(scenario.error());
  }

  void take(std::string_view name, const std::map<std::string, std::string>& entries) {
    if (name != kRecordedRun || !state_) return;
    head_.entries.clear();
    head_.entries.insert(entries.begin(), entries.end());
    state_ = choose_arithmetic(head_["arithmetic"], path_);
    if (head_["mode"] == kSimulateMode) {
      state_ = fail(ErrorCode::kInvalidArgument,
                    path_ +
                        ": mode: got simulate, expected drive or serve: the commands came from another "
                        "program, and are not ours to compute");
    }
  }

  const std::string& path_;
  RecordingHead& head_;
  const std::function<Result<void>(const RecordedEvent&)>& visit_;
  Result<void> state_;
  bool has_scenario_ = false;
  std::uint64_t damaged_ = 0;
};

}  // namespace

Result<telemetry::McapReport> read_recording(const std::string& path, RecordingHead& head,
                                             const std::function<Result<void>(const RecordedEvent&)>& visit) {
  return RecordingReader(path, head, visit).read();
}

Result<scenario::Scenario> recorded_scenario(const std::string& path) {
  RecordingHead head;
  std::optional<scenario::Scenario> first;
  const auto read = read_recording(path, head, [&](const RecordedEvent& event) -> Result<void> {
    if (const auto* scenario = std::get_if<scenario::Scenario>(&event)) first = *scenario;
    return fail(ErrorCode::kInvalidArgument, path + ": read as far as needed");
  });
  if (!first) return fail(read ? Error{ErrorCode::kParse, path + ": scenario: got none"} : read.error());
  if (head["mode"] == "serve") {
    return fail(ErrorCode::kInvalidArgument, path + ": mode: got serve, expected drive");
  }
  return *first;
}

bool is_foreign_log(const std::string& file) {
  std::error_code trouble;
  if (std::filesystem::is_directory(file, trouble)) return true;  // a bag, as rosbag2 writes it
  if (file.ends_with(".db3") || file.ends_with(".csv")) return true;
  if (!file.ends_with(".mcap")) return false;
  bool is_ours = false, has_odometry = false;
  telemetry::McapVisitor visitor;
  visitor.on_message = [&](const telemetry::McapMessage& message) {
    is_ours |= message.channel.topic == kFrameTopic;
    has_odometry = has_odometry || (message.channel.type == protocol::OdometryMessage::kType &&
                                    message.channel.message_encoding == "cdr" &&
                                    protocol::decode<protocol::OdometryMessage>(message.bytes).has_value());
  };
  return telemetry::read_mcap(file, visitor) && has_odometry && !is_ours;
}

Result<telemetry::McapReport> check_recording(const std::string& path) {
  std::uint64_t steps = 0;
  telemetry::McapVisitor visitor;
  visitor.on_message = [&](const telemetry::McapMessage& message) {
    steps += message.channel.topic == kFrameTopic ? 1U : 0U;
  };
  const Result<telemetry::McapReport> read = telemetry::read_mcap(path, visitor);
  const bool is_cut = read && !read->is_complete && read->messages == 0;
  if (read && steps == 0)
    return fail(refusal(path, is_cut ? "a file that was cut in its first chunk" : "no control step",
                        "a recording of ours, or a bag with nav_msgs/msg/Odometry in CDR",
                        ErrorCode::kParse));
  return read;
}

namespace {

bool is_same_number(double a, double b) {
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

  /// Applies a change; without effect if it concerns neither controller nor vehicle.
  void add(const telemetry::Change& change) {
    const Result<run::Setting> setting = run::read_setting(change);
    if (!setting) return;
    if (const auto* learned = std::get_if<run::LearnedLap>(&setting->action)) {
      controller::LapRequest request = cycle_.controller().wants_lap();
      request.terms = *learned;
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
    return is_same_number(result.command.steer, step.command.steer) &&
           is_same_number(result.command.throttle, step.command.throttle) && frame_.guard.rung == step.rung &&
           frame_.guard.gated == step.gated;
  }

  scenario::Scenario scenario_;
  std::optional<road::Track> track_;  ///< track known to guard and racing controller
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
