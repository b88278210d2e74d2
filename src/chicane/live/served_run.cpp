// SPDX-License-Identifier: MIT
#include "chicane/live/served_run.hpp"

#include <fmt/format.h>

#include <chrono>
#include <utility>

#include "chicane/live/description.hpp"
#include "chicane/live/live_settings.hpp"
#include "chicane/live/pages.hpp"
#include "chicane/live/run_limit.hpp"
#include "chicane/live/served_futures.hpp"
#include "chicane/live/what_if.hpp"
#include "chicane/wire/viewer.hpp"

namespace chicane::live {
namespace {

constexpr const char* kUnknownRoad = "the simulator's road is not known: --track FILE tells it";
constexpr const char* kOtherRoad = "the simulator drives on another road than --track";

protocol::Run describe_served(const scenario::Scenario& scenario, const controller::Controller& controller,
                              const std::optional<road::Track>& track) {
  protocol::Run run;
  run.mode = "serve";
  protocol::describe(controller, run);
  run.preset = scenario.preset;
  run.guard = protocol::guard_facts(scenario.guard);
  run.latency = scenario.latency;
  run.control_period = scenario.control_period;
  describe(scenario, run);
  if (track)
    describe(*track, run);
  else  // the scenario's is not the simulator's
    run.origin.road_kind.clear(), run.origin.road_notes.clear();
  run.limit = track ? RunLimit::first_answer(*track) : lap_time::LimitAnswer{.why_not = kUnknownRoad};
  return run;
}

}  // namespace

ServedRun::ServedRun(const net::ServerOptions& server, const scenario::Scenario& scenario,
                     std::unique_ptr<controller::Controller> controller, std::optional<road::Track> track,
                     std::vector<net::Asset> assets, std::shared_ptr<const road::RacingRoad> lap)
    : scenario_{scenario},
      controller_{std::move(controller)},
      track_{std::move(track)},
      description_{describe_served(scenario_, *controller_, track_)},
      assets_{std::move(assets)} {
  options_.server = server;
  options_.scenario = scenario_;
  if (track_) options_.track = &*track_;
  options_.lap = std::move(lap);
  options_.latency =
      std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::duration<double>(scenario_.latency));
}

double ServedRun::step_budget() const { return std::chrono::duration<double>(options_.step_budget).count(); }

Result<wire::ServeSummary> ServedRun::run(recording::Recorder* recorder, const LiveHooks& hooks,
                                          const std::function<void(std::uint16_t)>& on_listening,
                                          const std::atomic<bool>& stop, const ServeFunction& serve) {
  run::SettingQueue requests;
  LiveSettings settings({.scenario = scenario_, .has_world = false}, requests);
  RunLog log(false);
  ServedFutures futures(log);
  WhatIf what_if([&futures](const WhatIfQuestion& question, const recording::BranchHooks& branching) {
    return futures.branch(question.options, branching);
  });
  wire::ViewerOptions viewing;
  viewing.run = description_;
  viewing.parameters = &settings;
  if (track_) {
    viewing.services.what_if = [&](std::string_view question) {
      futures.assume(settings.scenario());
      return what_if.ask(question);
    };
  }
  wire::ViewerEndpoint viewer(std::move(viewing));
  RunLimit limit([&](const lap_time::LimitAnswer& news) { viewer.set_limit(news); });
  if (!track_) limit.give_up(kUnknownRoad);
  RunPublisher publisher(
      viewer, settings,
      {.recorder = recorder, .limit = &limit, .log = track_ ? &log : nullptr, .hooks = hooks});
  if (track_) log.begin(scenario_);
  wire::ServeHooks serving;
  serving.settings = &requests;
  serving.parameters = &settings;
  serving.description = &description_;
  serving.on_change = [&](const telemetry::Change& change) { publisher.change(change); };
  serving.on_frame = [&](const telemetry::Frame& frame) { publisher.frame(frame); };
  serving.on_lap = [&](const telemetry::CompletedLap& lap) { publisher.lap(lap); };
  serving.on_other_road = [&](double distance) {
    limit.give_up(kOtherRoad);
    futures.give_up(kOtherRoad);
    viewer.set_limit({.why_not = kOtherRoad});
    publisher.say(
        fmt::format("the simulator drives on another road than {}, up to {:.0f} m away: --track is not "
                    "used, and laps are taken from where the car drives",
                    track_->name(), distance));
  };
  serving.on_clock = [&](std::string_view sentence) { publisher.say(sentence); };
  serving.log = [&](std::string_view line) { publisher.say(line); };
  serving.on_listening = on_listening;
  serving.on_end = [&] {
    limit.end();
    viewer.set_end("stopped", "stopped by its operator");
    viewer.dismiss();
  };
  serving.pages = live_pages(settings);
  add_what_if(serving.pages, what_if);
  if (track_) limit.search(*track_, scenario_);  // before there is a control thread, to which it belongs then
  auto summary =
      serve(options_, std::move(controller_), std::move(serving), &viewer, std::move(assets_), stop);
  if (!summary) return summary;
  publisher.compare(summary->run, stop);
  return summary;
}

}  // namespace chicane::live
