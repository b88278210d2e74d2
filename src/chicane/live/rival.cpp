// SPDX-License-Identifier: MIT
#include "chicane/live/rival.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "chicane/base/math.hpp"
#include "chicane/base/text.hpp"
#include "chicane/live/detail/rounded.hpp"
#include "chicane/live/what_if.hpp"
#include "chicane/protocol/json.hpp"
#include "chicane/protocol/schema.hpp"

namespace chicane::live {
namespace {

using protocol::Json;

constexpr auto kLook = std::chrono::milliseconds(5);  // between two looks at what the run did
constexpr std::uint64_t kSpare = 64;                  // places that cycles leave to laps and changes

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

Rival::Rival(std::function<void()> begin_anew)
    : begin_anew_{std::move(begin_anew)}, worker_{[this] { work(); }, kLook} {}

Result<std::string> Rival::ask(std::string_view json, const scenario::Scenario& scenario) {
  const Result<WhatIfQuestion> question = read_question(json);
  if (!question) return fail(question.error());
  const auto& settings = question->options.settings;
  const Result<scenario::Scenario> raced = with_settings(scenario, settings);
  if (!raced) return fail(raced.error());
  const std::lock_guard lock(mutex_);
  wish_ = Wish{*raced, settings};
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
  const std::array<std::pair<const char*, double Pose::*>, 7> columns{{{"time_s", &Pose::time},
                                                                       {"x_m", &Pose::x},
                                                                       {"y_m", &Pose::y},
                                                                       {"yaw_rad", &Pose::yaw},
                                                                       {"steer_rad", &Pose::steer},
                                                                       {"speed_mps", &Pose::speed},
                                                                       {"distance_m", &Pose::distance}}};
  Json trace = Json::object();
  for (const auto& [name, column] : columns) {
    Json values = Json::array();
    for (const Pose& pose : trace_) values.push_back(rounded(pose.*column));
    trace[name] = std::move(values);
  }
  json["trace"] = std::move(trace);
  return protocol::json_text(json) + "\n";
}

void Rival::note(const telemetry::Frame& frame) noexcept {
  const bool begins = frame.begins && frame.cycle == 0;
  if (!begins && entries_.room() < kSpare) return;  // the next one says how far the run is
  if (!entries_.push({.kind = begins ? Entry::Kind::kBegin : Entry::Kind::kCycle,
                      .time = frame.time,
                      .speed = hypot(frame.truth.vx, frame.truth.vy),
                      .lateral_error = frame.lateral_error}))
    has_lost_ = true;
}

void Rival::note(const telemetry::CompletedLap& lap) noexcept {
  if (!entries_.push({.kind = Entry::Kind::kLap, .lap = lap})) has_lost_ = true;
}

void Rival::note(const telemetry::Change& change) noexcept {
  if (!is_of_the_world(change.name.view())) return;
  if (!entries_.push({.kind = Entry::Kind::kChange, .change = change})) has_lost_ = true;
}

void Rival::end_race() noexcept {
  if (!entries_.push({.kind = Entry::Kind::kEnd})) has_lost_ = true;
}

void Rival::work() {
  std::unique_lock lock(mutex_);
  const std::optional<Wish> wish = std::exchange(wish_, std::nullopt);
  lock.unlock();
  while (const Entry* entry = entries_.front()) {
    take(*entry);
    entries_.pop();
  }
  if (wish) build(*wish);
  if (has_lost_.exchange(false) && loop_)
    end(State::kEnded, "this computer could not keep up with both cars");
}

void Rival::build(const Wish& wish) {
  loop_.reset();
  own_.clear();
  for (const auto& [key, value] : wish.settings) own_.push_back(key);
  Result<std::unique_ptr<run::ClosedLoop>> loop = wish.settings.empty()
                                                      ? Result<std::unique_ptr<run::ClosedLoop>>{nullptr}
                                                      : run::ClosedLoop::create(wish.scenario);
  {
    const std::lock_guard lock(mutex_);
    laps_of_run_.clear();
    laps_.clear();
    trace_.clear();
    why_ = loop ? "" : loop.error().message;
    settings_ = wish.settings;
    state_ = !loop ? State::kFailed : *loop ? State::kWaiting : State::kNone;
  }
  if (!loop || !*loop) return;
  loop_ = std::move(*loop);
  planner_.emplace(run::LapPlanner::Clock::kVirtual);
  begin_anew_();
}

void Rival::take(const Entry& entry) {
  if (!loop_) return;
  using enum Entry::Kind;
  if (entry.kind == kEnd) return end(State::kEnded, "the run began with other choices");
  if (entry.kind == kBegin) begin();
  {
    const std::lock_guard lock(mutex_);
    if (state_ != State::kRacing) return;  // it begins with the run's next beginning
  }
  if (entry.kind == kChange) {
    changes_.push_back(entry.change);
  } else if (entry.kind == kLap) {
    keep(laps_of_run_, run_laps_.finish(entry.lap));
  } else {
    run_laps_.add(entry.time, entry.speed, entry.lateral_error);
    follow(entry.time);
  }
}

void Rival::begin() {
  loop_->restart();
  changes_.clear();
  own_laps_.begin();
  run_laps_.begin();
  const std::lock_guard lock(mutex_);
  laps_of_run_.clear();
  laps_.clear();
  trace_.clear();
  state_ = State::kRacing;
}

/// Drives the rival to where the run is.
void Rival::follow(double time) {
  constexpr double kRounding = 1e-9;
  while (loop_ && loop_->time() < time + kRounding) {
    while (loop_->is_control_due() && !changes_.empty() && changes_.front().cycle <= loop_->cycle()) {
      const bool is_own = std::find(own_.begin(), own_.end(), changes_.front().name.view()) != own_.end();
      if (!is_own) loop_->apply(changes_.front());
      changes_.pop_front();
    }
    const bool is_new = loop_->advance();
    if (const auto lap = loop_->take_lap()) keep(laps_, own_laps_.finish(*lap));
    if (is_new) {
      const telemetry::Frame& frame = loop_->frame();
      const model::State& car = frame.truth;
      const double speed = hypot(car.vx, car.vy);
      own_laps_.add(frame.time, speed, frame.lateral_error);
      planner_->advance(*loop_);
      const std::lock_guard lock(mutex_);
      trace_.push_back(
          {frame.time, car.x, car.y, car.psi, frame.applied.steer, speed, loop_->world().progress});
      if (trace_.size() > kTrace) trace_.pop_front();
    }
    if (loop_->is_over()) end(State::kEnded, loop_->summary().end_reason);
  }
}

void Rival::end(State state, std::string why) {
  loop_.reset();
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
