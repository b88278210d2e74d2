// SPDX-License-Identifier: MIT
#include "chicane/live/worker_run.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "chicane/base/instruction_set.hpp"
#include "chicane/live/description.hpp"
#include "chicane/live/pages.hpp"
#include "chicane/protocol/fault_codec.hpp"

namespace chicane::live {
namespace {

constexpr const char* kNoLimit = "it is not computed in a page without a program; `chicane limit` does";
constexpr double kMaxBehind = 0.1;  // [s] of the clock: later than this, missed time is skipped

protocol::Run worker_description(const run::ClosedLoop& loop) {
  protocol::Run run = description(loop);
  run.limit = {.why_not = kNoLimit};
  return run;
}

}  // namespace

WorkerRun::WorkerRun(std::unique_ptr<run::ClosedLoop> loop, WorkerServer::Send send)
    : loop_{std::move(loop)},
      settings_{with_viewer(viewer_, {.scenario = loop_->scenario(),
                                      .faults = protocol::fault_controls(),
                                      .build = [this](ChosenRun next) { request_ = std::move(next); },
                                      .built = [this]() -> std::optional<Result<void>> {
                                        if (!request_) return std::nullopt;
                                        auto built = build_run(*std::exchange(request_, std::nullopt),
                                                               &worker_description);
                                        if (!built) return fail(built.error());
                                        built_ = std::move(*built);
                                        return Result<void>{};
                                      }}),
                controls_.settings},
      viewer_{
          {.run = worker_description(*loop_), .services = run_services(controls_), .parameters = &settings_}},
      router_{nullptr, &viewer_},
      publisher_{viewer_, settings_} {
  hooks_.on_frame = [this](const telemetry::Frame& frame) {
    if (frame.begins && frame.cycle == 0) ended_.reset();
    publisher_.frame(frame);
  };
  hooks_.on_lap = [this](const telemetry::CompletedLap& lap) { publisher_.lap(lap); };
  hooks_.on_change = [this](const telemetry::Change& change) { publisher_.change(change); };
  begin_steps();
  wire::Pages pages = live_pages(settings_);
  pages["/run.json"] = [this] {
    return net::Content{.content_type = "application/json", .bytes = run_json()};
  };
  server_ = std::make_unique<WorkerServer>(router_.handlers(std::move(pages)), std::move(send));
}

Result<std::unique_ptr<WorkerRun>> WorkerRun::create(const scenario::Scenario& scenario,
                                                     WorkerServer::Send send) {
  auto loop = run::ClosedLoop::create(scenario);
  if (!loop) return fail(loop.error());
  return std::unique_ptr<WorkerRun>(new WorkerRun(std::move(*loop), std::move(send)));
}

void WorkerRun::begin_steps() {
  steps_.emplace(*loop_, 0.0, controls_, hooks_, run::LapPlanner::Clock::kVirtual);
  anchor_.reset();
}

void WorkerRun::advance(double now, const std::function<bool()>& go_on) {
  server_->pass_time(now);
  if (steps_->is_to_start_anew()) take_over();
  const bool is_moved = steps_->restart_if_wanted() || controls_.is_paused;
  if (is_moved || !anchor_ || anchor_->pace != loop_->pace()) anchor_ = {loop_->time(), now, loop_->pace()};
  if (controls_.is_paused) return drive_paused();
  const double until = anchor_->time + (now - anchor_->clock) * anchor_->pace;
  drive(until, go_on);
  if (std::fabs(loop_->time() - until) > kMaxBehind * anchor_->pace) anchor_.reset();
}

void WorkerRun::drive(double until, const std::function<bool()>& go_on) {
  while (loop_->time() < until && !steps_->is_to_start_anew()) {
    if (steps_->advance() && !go_on()) return;
    if (!loop_->is_over()) continue;
    if (!ended_) ended_ = loop_->summary();
    publisher_.end(*ended_);
    loop_->drive_on();
    if (loop_->time() < publisher_.time()) return;  // the car was lost and is at the start again
  }
}

void WorkerRun::drive_paused() {
  steps_->finish_cycle();
  steps_->take_up_changes();
  if (steps_->is_to_start_anew()) return;
  if (steps_->is_unseen() || steps_->take_step())
    steps_->one_cycle();  // viewers are to see where a run begins
}

/// Goes on with the run that the next change begins.
void WorkerRun::take_over() {
  loop_ = std::move(built_->loop);
  viewer_.set_run(std::move(built_->description));
  ended_.reset();
  begin_steps();
  for (const telemetry::Change& choice : built_->choices) hooks_.on_change(choice);
  controls_.settings.pop();
  built_.reset();
}

std::string WorkerRun::run_json() const {
  const std::string hash = ended_ ? fmt::format("\"{:016x}\"", ended_->state_hash) : "null";
  return fmt::format(
      "{{\"time_s\":{:.3f},\"pace\":{},\"arithmetic\":\"{}\",\"state_hash\":{},\"laps\":{}}}\n",
      loop_->time(), loop_->pace(), arithmetic(chosen_instruction_set()), hash,
      ended_ ? ended_->laps.size() : 0);
}

}  // namespace chicane::live
