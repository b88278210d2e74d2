// SPDX-License-Identifier: MIT
#include "chicane/runtime/replay.hpp"

#include <array>
#include <bit>
#include <charconv>
#include <map>
#include <memory>
#include <string_view>

#include "chicane/controller/controller.hpp"
#include "chicane/protocol/step_codec.hpp"
#include "chicane/protocol/yaml_codec.hpp"
#include "chicane/runtime/make.hpp"
#include "chicane/runtime/recorder.hpp"
#include "chicane/safety/command_gate.hpp"
#include "chicane/telemetry/mcap_reader.hpp"

namespace chicane::runtime {
namespace {

bool is_same(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

/// A controller and its gate, from the first step on.
class Recomputation {
 public:
  static Result<std::unique_ptr<Recomputation>> create(std::string_view yaml, const std::string& file) {
    const Result<protocol::Document> document = protocol::parse_document(yaml, file);
    if (!document) return fail(document.error());
    scenario::Scenario scenario;
    const std::array layers{*document};
    if (Result<void> applied = protocol::apply_layers(layers, scenario); !applied)
      return fail(applied.error());
    auto controller = make_controller(scenario);
    if (!controller) return fail(controller.error());
    return std::unique_ptr<Recomputation>(new Recomputation(scenario, std::move(*controller)));
  }

  void add(const protocol::Step& step, double budget, ReplayReport& report) {
    ++report.steps;
    if (budget > 0.0 && step.step_time >= budget) {
      ++report.late;
      if (!report.first_late) report.first_late = step.cycle;
    }
    if (step.cycle == 0) {
      controller_->reset();
      gate_.reset();
      next_cycle_ = 0;
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
  Recomputation(const scenario::Scenario& scenario, std::unique_ptr<controller::Controller> controller)
      : control_period_{scenario.control_period},
        controller_{std::move(controller)},
        gate_{scenario.vehicle} {}

  bool is_reproduced(const protocol::Step& step) {
    const controller::StepResult& result = controller_->step(step.measurement, Deadline::never());
    const safety::GateResult gated = gate_.pass(result.command, step.cycle == 0 ? 0.0 : control_period_);
    return is_same(gated.command.steer, step.command.steer) &&
           is_same(gated.command.throttle, step.command.throttle) && result.report.rung == step.rung &&
           (gated.reason != safety::GateReason::kNone) == step.gated;
  }

  double control_period_;
  std::unique_ptr<controller::Controller> controller_;
  safety::CommandGate gate_;
  std::uint64_t next_cycle_ = 0;
};

std::string value_of(const std::map<std::string, std::string>& entries, const char* key) {
  const auto entry = entries.find(key);
  return entry == entries.end() ? "" : entry->second;
}

}  // namespace

Result<ReplayReport> verify_recording(const std::string& path) {
  ReplayReport report;
  double budget = 0.0;
  Result<std::unique_ptr<Recomputation>> again = fail(
      ErrorCode::kParse, path + ": " + kRecordedScenario + ": got none, expected a recording of chicane");
  const Result<telemetry::McapReport> read = telemetry::read_mcap(
      path, {.on_message =
                 [&](const telemetry::McapMessage& message) {
                   if (!again || message.channel.topic != protocol::kStepTopic) return;
                   const auto step = protocol::decode_step(message.bytes);
                   if (step) again.value()->add(*step, budget, report);
                   if (!step) ++report.damaged;
                 },
             .on_attachment =
                 [&](std::string_view name, std::string_view bytes) {
                   if (name == kRecordedScenario) {
                     again = Recomputation::create(bytes, path + ":" + kRecordedScenario);
                   }
                 },
             .on_metadata =
                 [&](std::string_view name, const std::map<std::string, std::string>& entries) {
                   if (name != kRecordedRun) return;
                   report.recorded_by = value_of(entries, "program");
                   report.controller = value_of(entries, "controller");
                   report.track = value_of(entries, "track");
                   const std::string text = value_of(entries, "step_budget_s");
                   std::from_chars(text.data(), text.data() + text.size(), budget);
                 }});
  if (!read) return fail(read.error());
  if (!again) return fail(again.error());
  report.damaged += read->damaged;
  report.is_complete = read->is_complete;
  return report;
}

}  // namespace chicane::runtime
