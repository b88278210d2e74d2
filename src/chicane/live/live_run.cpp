// SPDX-License-Identifier: MIT
// Live run: its parts connected, its loop, the takeover of runs that viewers begin, and its end.
#include "chicane/live/live_run.hpp"

#include <utility>

#include "chicane/live/pages.hpp"
#include "chicane/protocol/schema_json.hpp"

namespace chicane::live {
namespace {

wire::ViewerServices services(run::RunControls& controls, WhatIf& what_if, Rival& rival,
                              const LiveSettings& settings) {
  wire::ViewerServices services = run_services(controls);
  services.what_if = [&what_if](std::string_view question) { return what_if.ask(question); };
  services.rival = [&](std::string_view question) { return rival.ask(question, settings.scenario()); };
  return services;
}

/// Description of a run for viewers, at its start.
protocol::Run live_description(const run::ClosedLoop& loop) {
  protocol::Run run = description(loop);
  run.limit = RunLimit::first_answer(loop.track());
  return run;
}

}  // namespace

LiveRun::LiveRun(const LiveRunOptions& options, std::unique_ptr<run::ClosedLoop> loop,
                 run::RunControls& controls)
    : options_{options},
      controls_{controls},
      loop_{std::move(loop)},
      settings_{with_viewer(viewer_, {.scenario = loop_->scenario(),
                                      .faults = protocol::fault_controls(),
                                      .build = [this](ChosenRun next) { builder_.begin(std::move(next)); },
                                      .built = [this] { return built(); },
                                      .say = [this](std::string_view line) { say(line); }}),
                controls.settings},
      viewer_{{.run = live_description(*loop_),
               .services = services(controls, what_if_, rival_, settings_),
               .parameters = &settings_}},
      router_{nullptr, &viewer_, [this](std::string_view line) { say(line); }},
      builder_{[](ChosenRun next, const std::function<bool()>&) {
        return build_run(std::move(next), &live_description);
      }},
      what_if_{[this](const WhatIfQuestion& question, const recording::BranchHooks& hooks) {
        return log_.branch(question.options, hooks);
      }},
      rival_{log_, [this] { controls_.wants_restart = true; }},
      limit_{[this](const lap_time::LimitAnswer& news) {
        if (!news.found && hooks_.say) hooks_.say("no gap to the limit: " + news.why_not);
        viewer_.set_limit(news);
      }} {}

Result<std::unique_ptr<LiveRun>> LiveRun::create(const LiveRunOptions& options,
                                                 std::unique_ptr<run::ClosedLoop> loop,
                                                 run::RunControls& controls) {
  std::unique_ptr<LiveRun> run(new LiveRun(options, std::move(loop), controls));
  if (const Result<void> opened = run->open(); !opened) return fail(opened.error());
  return run;
}

Result<void> LiveRun::open() {
  // The command line's settings take the way of viewers' changes.
  if (options_.pace) {
    if (Result<void> set = settings_.set({"run.pace", *options_.pace}); !set) return set;
  }
  if (options_.is_manual) {
    if (Result<void> set = settings_.set({"manual.is_on", true}); !set) return set;
  }
  wire::Pages pages = live_pages(settings_);
  add_what_if(pages, what_if_);
  add_rival(pages, rival_);
  auto server = net::Server::create(options_.server, router_.handlers(std::move(pages)), options_.assets);
  if (!server) return fail(server.error());
  server_ = std::move(*server);
  return {};
}

void LiveRun::say(std::string_view line) {
  std::unique_lock lock(mutex_);  // run() may set the hooks while viewers connect
  const auto say = hooks_.say;
  lock.unlock();
  if (say) say(line);
}

protocol::Run LiveRun::description() const { return live_description(*loop_); }

double LiveRun::step_budget() const {
  return options_.step_budget.value_or(run::RealtimeOptions{}.budget_share *
                                       loop_->scenario().control_period);
}

telemetry::RunSummary LiveRun::run(recording::Recorder* recorder, const LiveHooks& hooks) {
  {
    const std::lock_guard lock(mutex_);
    hooks_ = hooks;
  }
  recorder_ = recorder;
  publisher_.emplace(viewer_, settings_,
                     RunListeners{.recorder = recorder, .limit = &limit_, .log = &log_, .hooks = hooks_});
  log_.begin(loop_->scenario());
  limit_.search(loop_->track(), loop_->scenario());
  telemetry::RunSummary summary = drive();
  publisher_->end(summary);
  publisher_->compare(summary, controls_.wants_stop);
  viewer_.dismiss();
  return summary;
}

telemetry::RunSummary LiveRun::drive() {
  run::RunHooks hooks;
  hooks.on_frame = [&](const telemetry::Frame& frame) {
    limit_.follow(loop_->scenario(), frame);
    publisher_->frame(frame);
  };
  hooks.on_lap = [&](const telemetry::CompletedLap& lap) { publisher_->lap(lap); };
  hooks.on_change = [&](const telemetry::Change& change) { publisher_->change(change); };
  hooks.on_over = [&] {
    if (!publisher_->has_reported_end()) publisher_->end(loop_->summary());
  };
  for (;;) {
    telemetry::RunSummary summary = run::run_realtime(
        *loop_, {.step_budget = step_budget(), .stay_at_end = options_.stay_at_end}, controls_, hooks);
    if (!take_over()) return summary;
  }
}

bool LiveRun::take_over() {
  const run::Setting* next = controls_.settings.front();
  if (next == nullptr || !next->change.starts_anew || controls_.wants_stop) return false;
  std::unique_ptr<BuiltRun> run;
  {
    const std::lock_guard lock(mutex_);
    run = std::move(built_.front());
    built_.pop_front();
  }
  loop_ = std::move(run->loop);
  limit_.end();  // before set_run(): viewers must not get the old limit after the new road
  viewer_.set_run(std::move(run->description));
  log_.begin(run->recorded->scenario);
  if (recorder_ != nullptr) recorder_->record(std::move(run->recorded));
  for (const telemetry::Change& choice : run->choices) publisher_->change(choice);
  controls_.settings.pop();
  limit_.search(loop_->track(), loop_->scenario());
  return true;
}

std::optional<Result<void>> LiveRun::built() {
  auto result = builder_.take();
  if (!result) return std::nullopt;
  if (!*result) return fail(result->error());
  const std::lock_guard lock(mutex_);
  built_.push_back(std::move(**result));
  return Result<void>{};
}

}  // namespace chicane::live
