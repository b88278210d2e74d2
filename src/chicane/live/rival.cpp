// SPDX-License-Identifier: MIT
#include "chicane/live/rival.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <variant>

#include "chicane/base/math.hpp"
#include "chicane/base/text.hpp"
#include "chicane/live/detail/columns.hpp"
#include "chicane/live/what_if.hpp"
#include "chicane/protocol/json.hpp"
#include "chicane/protocol/schema.hpp"

namespace chicane::live {
namespace {

using protocol::Json;

constexpr auto kLook = std::chrono::milliseconds(5);  // between two looks at what the run did

/// What both cars feel: the world, not the controller.
bool is_of_the_world(std::string_view key) {
  return key.starts_with("fault.") || key.starts_with("plant_options.") || key.starts_with("sensor.") ||
         key == "latency_ms";
}

Json json_of(const std::array<double, 3>& values) {
  return {rounded(values[0]), rounded(values[1]), rounded(values[2])};
}

Json json_of(const std::vector<LapNotes>& laps) {
  Json all = Json::array();
  for (const LapNotes& each : laps) {
    all.push_back({{"lap", each.lap.lap},
                   {"lap_time_s", rounded(each.lap.lap_time)},
                   {"sector_times_s", json_of(each.lap.sector_times)},
                   {"is_clean", each.lap.is_clean},
                   {"slowest_mps", json_of(each.slowest)},
                   {"fastest_mps", json_of(each.fastest)},
                   {"largest_error_m", json_of(each.largest_error)}});
  }
  return all;
}

/// Each is known, may change while a run goes on, and has that value.
Result<scenario::Scenario> with_settings(scenario::Scenario scenario,
                                         const std::vector<std::pair<std::string, std::string>>& settings) {
  for (const auto& [key, value] : settings) {
    const protocol::Parameter* row = protocol::find(key);
    if (row == nullptr || !protocol::is_live(*row) || is_of_the_world(key)) {
      return fail(ErrorCode::kInvalidArgument, printable(key) + ": got " + printable(value) +
                                                   ", expected a setting of the controller or its car");
    }
    if (const Result<void> set = protocol::set_text(scenario, key, value); !set) return fail(set.error());
  }
  for (const protocol::Contradiction& found : protocol::contradictions(scenario))
    return fail(ErrorCode::kInvalidArgument, std::string(found.key) + ": " + found.message);
  scenario.laps = 0;  // as long as the run goes on
  return scenario;
}

}  // namespace

void LapNoter::add(double time, double speed, double lateral_error) {
  if (rows_.size() >= kMostRows) rows_.pop_front();
  rows_.push_back({time, speed, lateral_error});
}

LapNotes LapNoter::finish(const telemetry::CompletedLap& lap) {
  LapNotes notes{.lap = lap};
  notes.slowest.fill(std::nan(""));
  notes.fastest.fill(std::nan(""));
  notes.largest_error.fill(std::nan(""));
  const double begin = rows_.empty() ? 0.0 : rows_.back().time - lap.lap_time;
  for (const Row& row : rows_) {
    const double time = row.time - begin;
    if (time < 0.0) continue;
    const std::size_t third = time < lap.sector_times[0]                         ? 0
                              : time < lap.sector_times[0] + lap.sector_times[1] ? 1
                                                                                 : 2;
    notes.slowest[third] = std::fmin(notes.slowest[third], row.speed);
    notes.fastest[third] = std::fmax(notes.fastest[third], row.speed);
    notes.largest_error[third] = std::fmax(notes.largest_error[third], std::fabs(row.lateral_error));
  }
  rows_.clear();
  return notes;
}

Rival::Rival(RunLog& log, std::function<void()> begin_anew)
    : log_{log}, begin_anew_{std::move(begin_anew)}, worker_{[this] { work(); }, kLook} {}

Result<std::string> Rival::ask(std::string_view json, const scenario::Scenario& scenario) {
  const Result<WhatIfQuestion> question = read_question(json);
  if (!question) return fail(question.error());
  const auto& settings = question->options.settings;
  const Result<scenario::Scenario> raced = with_settings(scenario, settings);
  if (!raced) return fail(raced.error());
  const std::lock_guard lock(mutex_);
  request_ = Request{*raced, settings};
  state_ = settings.empty() ? State::kNone : State::kBuilding;
  worker_.wake();
  return std::to_string(++newest_);
}

std::string Rival::answer() const {
  constexpr std::array kNames{"none", "building", "building", "racing", "ended", "failed"};
  const std::lock_guard lock(mutex_);
  Json json{{"id", newest_}, {"state", kNames[static_cast<std::size_t>(state_)]}};
  if (!why_.empty()) json["why"] = why_;
  Json settings = Json::object();
  for (const auto& [key, value] : settings_) settings[key] = value;
  json["settings"] = std::move(settings);
  json["run"] = json_of(laps_of_run_);
  json["rival"] = json_of(laps_);
  json["trace"] = columns(kColumns, trace_);
  return protocol::json_text(json) + "\n";
}

void Rival::work() {
  std::unique_lock lock(mutex_);
  const std::optional<Request> request = std::exchange(request_, std::nullopt);
  lock.unlock();
  if (car_) catch_up();
  if (request) build(*request);
}

void Rival::build(const Request& request) {
  car_.emplace(recording::ShadowObservers{
      .on_step = [this](const run::ClosedLoop& loop) { note(loop); },
      .on_lap = [this](const telemetry::CompletedLap& lap) { keep(laps_, own_laps_.finish(lap)); }});
  const bool is_wanted = !request.settings.empty();
  const Result<void> built = is_wanted ? car_->begin(request.scenario) : Result<void>{};
  {
    const std::lock_guard lock(mutex_);
    laps_of_run_.clear();
    laps_.clear();
    trace_.clear();
    why_ = built ? "" : built.error().message;
    settings_ = request.settings;
    state_ = !built ? State::kFailed : is_wanted ? State::kWaiting : State::kNone;
  }
  if (!car_->has_begun()) return car_.reset();
  place_ = log_.end();
  begin_anew_();
}

/// Drives to where the run is.
void Rival::catch_up() {
  const Result<RunLog::Excerpt> news = log_.since(place_);
  if (!news && is_racing()) return end(State::kEnded, "this computer could not keep up with both cars");
  if (!news) return;
  const RunLog::Place before = std::exchange(place_, news->end);
  if (before.scenario != 0 && before.scenario != place_.scenario)
    return end(State::kEnded, "the run began with other choices");
  if (news->begin != before) begin();
  if (!is_racing()) return;  // it begins with the run's next beginning
  for (const RunLog::Event& event : *news->events) {
    std::visit([this](const auto& one) { take(one); }, event);
    if (!car_) return;
  }
}

void Rival::take(const RunLog::Step& step) {
  constexpr double kRounding = 1e-9;
  run_laps_.add(step.time, step.speed, step.lateral_error);
  const run::ClosedLoop& loop = car_->loop();
  car_->drive([&] { return loop.time() >= step.time + kRounding; });
  if (loop.is_over()) end(State::kEnded, loop.summary().end_reason);
}

void Rival::take(const RunLog::Change& change) {
  if (!is_of_the_world(change.name)) return;
  if (const Result<run::Setting> setting = run::read_setting(change.as_recorded())) car_->apply(*setting);
}

void Rival::note(const run::ClosedLoop& loop) {
  const telemetry::Frame& frame = loop.frame();
  const model::State& car = frame.truth;
  const double speed = hypot(car.vx, car.vy);
  own_laps_.add(frame.time, speed, frame.lateral_error);
  const std::lock_guard lock(mutex_);
  trace_.push_back({frame.time, car.x, car.y, car.psi, frame.applied.steer, speed, loop.world().progress});
  if (trace_.size() > kTrace) trace_.pop_front();
}

void Rival::begin() {
  car_->loop().restart();
  own_laps_.begin();
  run_laps_.begin();
  const std::lock_guard lock(mutex_);
  laps_of_run_.clear();
  laps_.clear();
  trace_.clear();
  state_ = State::kRacing;
}

bool Rival::is_racing() const {
  const std::lock_guard lock(mutex_);
  return state_ == State::kRacing;
}

void Rival::end(State state, std::string why) {
  car_.reset();
  const std::lock_guard lock(mutex_);
  state_ = state;
  why_ = std::move(why);
}

void Rival::keep(std::vector<LapNotes>& laps, const LapNotes& notes) const {
  const std::lock_guard lock(mutex_);
  laps.push_back(notes);
  if (laps.size() > kMostLaps) laps.erase(laps.begin());
}

}  // namespace chicane::live
