// SPDX-License-Identifier: MIT
// Live run whose car another program simulates: its parts connected, and its futures by a plant of ours.
#include "chicane/live/served_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>
#include <variant>

#include "chicane/base/duration.hpp"
#include "chicane/base/math.hpp"
#include "chicane/base/median.hpp"
#include "chicane/live/live_settings.hpp"
#include "chicane/live/pages.hpp"
#include "chicane/live/run_limit.hpp"
#include "chicane/live/what_if.hpp"
#include "chicane/wire/viewer.hpp"

namespace chicane::live {
namespace {

// Chosen.
constexpr double kLeastKnown = 1.0;  // [s] shortest record from which a future is computed
constexpr double kLongestGap = 0.5;  // [s] longest time between two sightings of one car
constexpr double kMostDelay = 0.5;   // [s] longest delay that is repeated
constexpr double kShortestPeriod = 0.02, kLongestPeriod = 0.2;  // [s] range of the control period

/// Median time between the newest sightings up to `seen[to]` [s]; `otherwise` without any.
double usual_period(const std::vector<Seen>& seen, std::size_t to, double otherwise) {
  constexpr std::size_t kLooked = 100;  // most sightings in the median; chosen
  std::vector<double> periods;
  for (std::size_t i = to; i > 0 && periods.size() < kLooked; --i)
    periods.push_back(seen[i].time - seen[i - 1].time);
  if (periods.empty()) return otherwise;
  return std::clamp(median(std::move(periods)), kShortestPeriod, kLongestPeriod);
}

/// Position of the car at `time` [s], which lies within the run.
Vec2 place_at(const std::vector<Seen>& seen, double time) {
  const auto after =
      std::find_if(seen.begin() + 1, seen.end() - 1, [&](const Seen& each) { return each.time >= time; });
  const Seen &b = *after, &a = *(after - 1);
  const double share = (time - a.time) / (b.time - a.time);
  return {a.x + share * (b.x - a.x), a.y + share * (b.y - a.y)};
}

}  // namespace

model::State moving(const std::vector<Seen>& seen, std::size_t i) {
  const Seen &now = seen[i], &before = seen[i - 1];
  const double elapsed = now.time - before.time;
  const double turned = angle_difference(now.psi, before.psi);
  const Vec2 way{now.x - before.x, now.y - before.y};
  constexpr double kSlow = 3.0;  // [m/s] speed below which the direction of motion is too inaccurate; chosen
  const double slip =
      now.speed < kSlow ? 0.0 : angle_difference(atan2(way.y(), way.x()), before.psi + 0.5 * turned);
  constexpr double kMostSlip = 0.5;  // [rad] larger slip shows that the car was put elsewhere; chosen
  const double kept = std::fabs(slip) < kMostSlip ? slip : 0.0;
  return {.x = now.x,
          .y = now.y,
          .psi = now.psi,
          .vx = now.speed * cos(kept),
          .vy = now.speed * sin(kept),
          .r = turned / elapsed,
          .steer = before.sent.steer};
}

void ServedFutures::assume(const scenario::Scenario& scenario) {
  const std::lock_guard lock(mutex_);
  scenario_ = scenario;
}

void ServedFutures::give_up(std::string why) {
  const std::lock_guard lock(mutex_);
  why_not_ = std::move(why);
}

Result<ServedFutures::Known> ServedFutures::known_at(double time) {
  const Result<RunLog::Excerpt> excerpt = log_.since({});
  if (!excerpt) return fail(excerpt.error());
  std::vector<Seen> seen;
  for (const RunLog::Event& event : *excerpt->events) {
    const auto* step = std::get_if<RunLog::Step>(&event);
    if (step == nullptr) continue;
    const auto& [x, y, psi, speed, steer, throttle] = step->seen;
    if (!std::isfinite(x + y + psi + speed)) continue;
    if (!seen.empty() && step->time <= seen.back().time) continue;
    // After a long gap it is another car, or the car in another place.
    if (!seen.empty() && step->time - seen.back().time > kLongestGap) seen.clear();
    seen.push_back({.time = step->time,
                    .delay = std::clamp(step->delay, 0.0, kMostDelay),
                    .x = x,
                    .y = y,
                    .psi = psi,
                    .speed = speed,
                    .sent = {.steer = step->sent[0], .throttle = step->sent[1]}});
  }
  const auto after = std::find_if(seen.begin(), seen.end(),
                                  [&](const Seen& each) { return each.time > time + 1e-9; });  // rounding
  const auto count = static_cast<std::size_t>(after - seen.begin());
  if (count < 2 || seen[count - 1].time - seen.front().time < kLeastKnown)
    return fail(ErrorCode::kInvalidArgument,
                "there is no second of this car's run before that moment that is known without a gap");
  return Known{.seen = std::move(seen), .at = count - 1};
}

Result<void> ServedFutures::follow(recording::ShadowRun& car, scenario::Scenario scenario,
                                   const std::vector<Seen>& seen, std::size_t to) {
  scenario = run::endless(std::move(scenario));
  scenario.control_period = usual_period(seen, to, scenario.control_period);
  scenario.latency = seen[to].delay;
  auto loop = run::ClosedLoop::create(scenario, roads_);
  if (!loop) return fail(loop.error());
  (*loop)->drive_on();
  std::size_t from = to;
  while (from > 1 && seen[to].time - seen[from].time < kFollowed) --from;
  (*loop)->restart_at(moving(seen, from));
  for (std::size_t i = from; i <= to; ++i)
    (*loop)->follow(seen[i].time, moving(seen, i), seen[i].delay, seen[i].sent);
  car.begin(std::move(*loop));
  return {};
}

Result<recording::StandIn> ServedFutures::compare(const scenario::Scenario& scenario, const Known& known,
                                                  const recording::BranchHooks& hooks) {
  const std::vector<Seen>& seen = known.seen;
  const double end = seen[known.at].time;
  std::size_t before = known.at;
  while (before > 1 && end - seen[before].time < kCompared) --before;
  recording::StandIn stand_in{.plant = scenario.plant, .compared = end - seen[before].time};
  recording::ShadowRun check({.on_frame = [&](const telemetry::Frame& frame) {
    const Vec2 driven = place_at(seen, frame.time);
    stand_in.apart = std::max(stand_in.apart, hypot(frame.truth.x - driven.x(), frame.truth.y - driven.y()));
  }});
  if (Result<void> begun = follow(check, scenario, seen, before); !begun) return fail(begun.error());
  bool goes_on = true;
  check.drive([&] {
    const double time = check.loop().time();
    goes_on = !hooks.go_on || hooks.go_on(time);
    return !goes_on || time >= end;
  });
  if (!goes_on) return fail(ErrorCode::kInvalidArgument, "given up");
  return stand_in;
}

Result<recording::BranchReport> ServedFutures::branch(const recording::BranchOptions& options,
                                                      const recording::BranchHooks& hooks) {
  std::unique_lock lock(mutex_);
  if (!why_not_.empty()) return fail(ErrorCode::kInvalidArgument, why_not_);
  if (!scenario_) return fail(ErrorCode::kInvalidArgument, "the simulator's road is not known");
  const scenario::Scenario scenario = *scenario_;
  lock.unlock();
  const Result<Known> known = known_at(options.at);
  if (!known) return fail(known.error());
  Result<recording::StandIn> stand_in = compare(scenario, *known, hooks);
  if (!stand_in) return fail(stand_in.error());
  const auto from = std::make_shared<recording::ShadowRun>();
  if (Result<void> begun = follow(*from, scenario, known->seen, known->at); !begun)
    return fail(begun.error());
  recording::BranchOptions from_there = options;
  from_there.at = known->seen[known->at].time + 1.0;  // beyond the record: the futures begin at its end
  from_there.drives_both = true;
  from_there.from = from;
  const recording::RunEvents nothing = [](const auto&) { return Result<void>{}; };
  auto report = recording::branch_run(nothing, from_there, hooks);
  if (report) report->stand_in = std::move(*stand_in);
  return report;
}

namespace {

constexpr const char* kUnknownRoad = "the road is unknown: --track FILE sets it";
constexpr const char* kOtherRoad = "the simulator drives on another road than --track";

/// Description of a served run for viewers and recordings.
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
  else  // the road of the scenario is not the simulator's
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
  options_.latency = duration(scenario_.latency);
}

double ServedRun::step_budget() const { return seconds(options_.step_budget); }

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
  if (track_) limit.search(*track_, scenario_);  // before serve(), whose control thread then owns the limit
  auto summary =
      serve(options_, std::move(controller_), std::move(serving), &viewer, std::move(assets_), stop);
  if (!summary) return summary;
  publisher.compare(summary->run, stop);
  return summary;
}

}  // namespace chicane::live
