// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include "chicane/live/assets.hpp"
#include "chicane/live/live_settings.hpp"
#include "chicane/live/pages.hpp"
#include "chicane/live/run_builder.hpp"
#include "chicane/live/run_limit.hpp"
#include "chicane/protocol/fault_codec.hpp"
#include "chicane/protocol/json_report.hpp"
#include "chicane/run/closed_loop.hpp"
#include "chicane/run/realtime_loop.hpp"
#include "chicane/wire/viewer.hpp"
#include "commands.hpp"
#include "experiment.hpp"
#include "interrupt.hpp"
#include "limit_of.hpp"
#include "progress.hpp"
#include "record.hpp"

namespace chicane::apps {
namespace {

/// Somebody watches: the dashboard stays up after the last lap. Scripts, and whoever asked for a number of
/// laps, get an end.
bool stays_up(const Options& options) {
  const bool has_laps = std::any_of(options.settings.begin(), options.settings.end(),
                                    [](const auto& setting) { return setting.first == "laps"; });
  const bool is_watched = isatty(STDOUT_FILENO) == 1 && isatty(STDERR_FILENO) == 1;
  return is_watched && !has_laps && !options.is_fast && !options.is_json;
}

wire::ViewerServices services(run::RunControls& controls) {
  wire::ViewerServices services;
  services.pause = [&controls](bool is_paused) -> Result<void> {
    controls.is_paused = is_paused;
    return {};
  };
  services.step = [&controls]() -> Result<void> {
    if (!controls.is_paused) return fail(ErrorCode::kInvalidArgument, "the run is not paused");
    ++controls.steps;
    return {};
  };
  services.reset = [&controls]() -> Result<void> {
    controls.wants_restart = true;
    return {};
  };
  return services;
}

double step_budget(const Options& options, const scenario::Scenario& scenario) {
  if (options.step_budget_ms) return 1e-3 * *options.step_budget_ms;
  return run::RealtimeOptions{}.budget_share * scenario.control_period;
}

Result<std::unique_ptr<KeptRun>> keep(const Options& options, const run::ClosedLoop& loop,
                                      const lap_time::LimitAnswer& limit) {
  protocol::Run run = description(loop);
  run.limit = limit;
  return KeptRun::start(options, std::move(run), loop.scenario(),
                        options.is_fast ? 0.0 : step_budget(options, loop.scenario()));
}

/// What viewers are told of a run that begins now.
protocol::Run live_description(const run::ClosedLoop& loop) {
  protocol::Run run = description(loop);
  run.limit = live::RunLimit::first_answer(loop.track());
  return run;
}

/// The results of a run, which are told even when its recording failed.
struct Outcome {
  telemetry::RunSummary summary;
  Result<void> kept;
};

/// A run that viewers change while it goes on. What cannot change in a run that goes on starts another one,
/// built beside it on a thread of its own and taken over by ours.
class WatchedRun {
 public:
  WatchedRun(const Options& options, std::unique_ptr<run::ClosedLoop> loop, run::RunControls& controls)
      : options_{options},
        controls_{controls},
        loop_{std::move(loop)},
        settings_{{.scenario = loop_->scenario(),
                   .faults = protocol::fault_controls(),
                   .build = [this](live::ChosenRun next) { builder_.begin(std::move(next)); },
                   .built = [this] { return built(); },
                   .on_building = [this](const std::string& what) { tell_building(what); },
                   .on_accepted = [this](const scenario::Scenario& now) { describe_anew(now); }},
                  controls.wishes},
        viewer_{{.run = live_description(*loop_), .services = services(controls), .parameters = &settings_}} {
  }

  Result<Outcome> go() {
    if (const Result<void> begun = begin(); !begun) return fail(begun.error());
    wire::Router router(nullptr, &viewer_);
    const auto server =
        net::Server::create({.address = options_.address, .port = options_.port},
                            router.handlers(live::live_pages(settings_)), live::embedded_assets());
    if (!server) return fail(server.error());
    auto kept = keep(options_, *loop_, live::RunLimit::first_answer(loop_->track()));
    if (!kept) return fail(kept.error());
    kept_ = std::move(*kept);
    fmt::print(stderr, "dashboard at http://localhost:{}/; Ctrl-C ends\n", (*server)->port());
    limit_.search(loop_->track(), loop_->scenario());
    telemetry::RunSummary summary = drive();
    compare_with_limit(limit_, summary, *kept_, controls_.wants_stop);
    return Outcome{std::move(summary), kept_->finish()};
  }

 private:
  /// What the command line says beside the scenario goes the way that viewers' wishes go.
  Result<void> begin() {
    if (options_.pace) {
      if (Result<void> set = settings_.set({"run.pace", *options_.pace}); !set) return set;
    }
    return options_.is_manual ? settings_.set({"manual.is_on", true}) : Result<void>{};
  }

  telemetry::RunSummary drive() {
    Progress progress;
    run::RealtimeHooks hooks;
    hooks.on_frame = [&](const telemetry::Frame& frame) {
      limit_.follow(loop_->scenario(), frame);
      if (auto news = limit_.news()) kept_->record(std::move(news));
      kept_->record(frame);
      viewer_.publish(frame);
      note_faults(frame);
      progress.show(frame);
    };
    hooks.on_lap = [&](const telemetry::CompletedLap& lap) {
      kept_->record(lap);
      viewer_.publish(lap, loop_->time());
    };
    hooks.on_change = [this](const telemetry::Change& change) { note(change); };
    for (;;) {
      telemetry::RunSummary summary = run::run_realtime(
          *loop_,
          {.step_budget = step_budget(options_, loop_->scenario()), .stay_at_end = stays_up(options_)},
          controls_, hooks);
      if (!take_over()) return summary;
    }
  }

  /// Faults that began or ended by themselves: nobody asked, so nobody has been told.
  void note_faults(const telemetry::Frame& frame) {
    const std::uint32_t changed = frame.active_faults ^ told_faults_;
    for (std::size_t i = 0; i < faults_.size() && changed != 0U; ++i) {
      if ((changed >> i & 1U) == 0U) continue;
      const bool is_on = (frame.active_faults >> i & 1U) != 0U;
      note({.cycle = frame.cycle + 1,
            .time = frame.time,
            .name = faults_[i].key,
            .value = is_on ? "true" : "false"});
    }
  }

  void note(const telemetry::Change& change) {
    for (std::size_t i = 0; i < faults_.size(); ++i) {
      if (faults_[i].key != change.name.view()) continue;
      const bool is_on = change.value.view() == "true";
      told_faults_ = (told_faults_ & ~(1U << i)) | (is_on ? 1U << i : 0U);
    }
    kept_->record(change);
    settings_.tell(change);
  }

  /// Goes on with the run that the next change begins. False when there is none.
  bool take_over() {
    const telemetry::Change* next = controls_.wishes.front();
    if (next == nullptr || !next->starts_anew || controls_.wants_stop) return false;
    std::unique_ptr<live::BuiltRun> run;
    {
      const std::lock_guard lock(mutex_);
      run = std::move(built_.front());
      built_.pop_front();
    }
    loop_ = std::move(run->loop);
    limit_.end();  // or its news could come after the description of another road
    viewer_.set_run(std::move(run->description));
    kept_->record(std::move(run->recorded));
    for (const telemetry::Change& choice : run->choices) note(choice);
    controls_.wishes.pop();
    limit_.search(loop_->track(), loop_->scenario());
    return true;
  }

  /// The network thread: a run that was built is ours to take.
  std::optional<Result<void>> built() {
    auto result = builder_.take();
    if (!result) return std::nullopt;
    if (!*result) return fail(result->error());
    const std::lock_guard lock(mutex_);
    built_.push_back(std::move(**result));
    return Result<void>{};
  }

  void tell_building(const std::string& what) {
    viewer_.change_run([what](protocol::Run& run) { run.building = what; });
  }

  void describe_anew(const scenario::Scenario& now) {
    viewer_.change_run([latency = now.latency, vehicle = now.vehicle](protocol::Run& run) {
      run.latency = latency;
      run.vehicle = vehicle;
    });
  }

  const Options& options_;
  run::RunControls& controls_;
  std::unique_ptr<run::ClosedLoop> loop_;
  live::LiveSettings settings_;
  wire::ViewerEndpoint viewer_;
  std::unique_ptr<KeptRun> kept_;
  const std::vector<protocol::Control> faults_ = protocol::fault_controls();
  std::uint32_t told_faults_ = 0;  ///< bits, as viewers know them
  std::mutex mutex_;
  std::deque<std::unique_ptr<live::BuiltRun>> built_;  ///< one for each change that starts anew
  live::RunBuilder builder_{&live_description};        ///< the network thread's
  live::RunLimit limit_{[this](const lap_time::LimitAnswer& news) {
    if (!news.found) fmt::print(stderr, "no gap to the limit: {}\n", news.why_not);
    viewer_.set_limit(news);
  }};  ///< ends before everything it tells
};

Result<Outcome> run_fast(const Options& options, run::ClosedLoop& loop, const run::RunControls& controls) {
  lap_time::LimitAnswer limit{.why_not = "nobody asked for it (--limit)"};
  if (options.wants_limit) {
    double wall_time = 0.0;
    const auto found = limit_of(loop.scenario(), loop.track(), {}, controls.wants_stop, wall_time);
    if (!found) return fail(found.error());
    limit = {.found = *found};
  }
  const auto kept = keep(options, loop, limit);
  if (!kept) return fail(kept.error());
  telemetry::RunSummary summary;
  {
    Progress progress;
    summary = run::run_closed_loop(
        loop,
        {.on_frame =
             [&](const telemetry::Frame& frame) {
               (*kept)->record(frame);
               progress.show(frame);
             },
         .on_lap = [&](const telemetry::CompletedLap& lap) { (*kept)->record(lap); }},
        [&] { return controls.wants_stop.load(); });
  }
  if (limit.found) telemetry::compare_with_limit(summary, limit.found->times);
  summary.why_no_limit = limit.why_not;
  return Outcome{std::move(summary), (*kept)->finish()};
}

Result<Outcome> run(const Options& options) {
  static run::RunControls controls;  // as long as signals may come
  catch_interrupts(controls.wants_stop);
  const Result<scenario::Scenario> scenario = experiment(options);
  if (!scenario) return fail(scenario.error());
  Result<std::unique_ptr<run::ClosedLoop>> loop = run::ClosedLoop::create(*scenario);
  if (!loop) return fail(loop.error());
  if (options.is_fast) return run_fast(options, **loop, controls);
  return WatchedRun(options, std::move(*loop), controls).go();
}

}  // namespace

ExitCode drive(const Options& options) {
  const Result<Outcome> outcome = run(options);
  if (!outcome) return report(outcome.error());
  const telemetry::RunSummary& summary = outcome->summary;
  fmt::print("{}", options.is_json ? protocol::to_json(summary) : protocol::to_table(summary));
  if (!outcome->kept) return report(outcome->kept.error());
  const bool is_kept = stays_up(options) ? summary.off_track_events == 0 : kept_its_promises(summary);
  return is_kept ? kSuccess : kBrokenPromise;
}

}  // namespace chicane::apps
