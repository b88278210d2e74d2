// SPDX-License-Identifier: MIT
// Memory of the current run: its events, and checkpoints to branch from, thinned as the run grows longer.
#include "chicane/live/run_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

namespace chicane::live {
namespace {

constexpr auto kCollectEvery = std::chrono::milliseconds(200);  // chosen: far below what the ring holds
constexpr const char* kTooLong =
    "the run has become too long to be computed again from its start; reset it first";
constexpr const char* kTooBusy = "the machine was too busy to keep what happened in this run; reset it first";

/// Step of a recording with the inputs and the command of a step of the log.
recording::RecordedStep recorded_of(const RunLog::Step& note) {
  recording::RecordedStep recorded;
  recorded.log_time = note.time;
  protocol::Step& step = recorded.step;
  step.cycle = note.cycle;
  step.begins = note.begins;
  step.deadline_spent_at = note.deadline_spent_at;
  step.measurement.time = note.time;
  step.measurement.delay = note.delay;
  step.measurement.x = note.seen[0];
  step.measurement.y = note.seen[1];
  step.measurement.psi = note.seen[2];
  step.measurement.speed = note.seen[3];
  step.measurement.steer = note.seen[4];
  step.measurement.throttle = note.seen[5];
  step.command = {.steer = note.sent[0], .throttle = note.sent[1]};
  return recorded;
}

}  // namespace

RunLog::RunLog(bool has_checkpoints, std::size_t most_events)
    : has_checkpoints_{has_checkpoints},
      most_events_{most_events},
      worker_{[this] { follow(); }, kCollectEvery} {}

void RunLog::begin(const scenario::Scenario& scenario) {
  put(std::make_shared<const scenario::Scenario>(scenario));
}

void RunLog::note(const telemetry::Frame& frame) noexcept {
  const model::Measurement& now = frame.measurement;
  const model::Command& sent = frame.result.command;
  put(Step{.cycle = frame.cycle,
           .time = frame.time,
           .delay = now.delay,
           .deadline_spent_at = frame.deadline_spent_at,
           .begins = frame.begins,
           .seen = {now.x, now.y, now.psi, now.speed, now.steer, now.throttle},
           .sent = {sent.steer, sent.throttle}});
}

void RunLog::collect() {
  while (Entry* entry = ring_.front()) {
    std::visit([this](auto& note) { take(note); }, *entry);
    ring_.pop();
  }
  if (has_lost_.exchange(false)) why_unknown_ = kTooBusy;
}

void RunLog::take(Begin& scenario) {
  scenario_ = std::move(scenario);
  why_unknown_ = nullptr;
  events_.clear();
  first_ = {.scenario = first_.scenario + 1, .start = first_.start + 1, .event = 0};
}

void RunLog::take(const Step& step) {
  if (step.begins) start_anew(step);
  add(step);
}

void RunLog::take(const telemetry::Change& change) {
  add(Change{.cycle = change.cycle,
             .time = change.time,
             .name = std::string(change.name.view()),
             .value = std::string(change.value.view())});
}

void RunLog::add(Event event) {
  events_.push_back(std::move(event));
  if (events_.size() <= most_events_) return;
  events_.pop_front();
  ++first_.event;
}

void RunLog::start_anew(const Step& first) {
  std::deque<Event> kept;
  for (Event& event : events_) {
    auto* change = std::get_if<Change>(&event);
    if (change == nullptr) continue;
    const bool is_of_the_new_run = change->cycle == first.cycle && change->time == first.time;
    if (change->name.starts_with("fault.") && !is_of_the_new_run) continue;
    change->cycle = first.cycle;
    change->time = first.time;
    std::erase_if(kept, [&](const Event& each) { return std::get<Change>(each).name == change->name; });
    kept.push_back(std::move(event));
  }
  events_ = std::move(kept);
  ++first_.start;
  first_.event = 0;
  why_unknown_ = nullptr;
}

RunLog::Place RunLog::last() const {
  return {.scenario = first_.scenario, .start = first_.start, .event = first_.event + events_.size()};
}

telemetry::Change RunLog::Change::as_recorded() const {
  return {.cycle = cycle, .time = time, .name = name, .value = value};
}

recording::RunEvents RunLog::Excerpt::recorded() const {
  return [*this](const auto& visit) -> Result<void> {
    Result<void> done = begin.event == 0 ? visit(*scenario) : Result<void>{};
    for (std::size_t i = 0; i < events->size() && done; ++i) {
      if (const auto* step = std::get_if<Step>(&(*events)[i])) done = visit(recorded_of(*step));
      if (const auto* change = std::get_if<Change>(&(*events)[i])) done = visit(change->as_recorded());
    }
    return done;
  };
}

Result<RunLog::Excerpt> RunLog::since(Place from) {
  const std::lock_guard lock(mutex_);
  collect();
  if (scenario_ == nullptr) return fail(ErrorCode::kInvalidArgument, "the run has not begun");
  if (why_unknown_ != nullptr) return fail(ErrorCode::kInvalidArgument, why_unknown_);
  const Place end = last();
  const bool goes_on = from.is_in_start_of(first_) && from.event >= first_.event && from.event <= end.event;
  if (!goes_on && first_.event > 0) return fail(ErrorCode::kInvalidArgument, kTooLong);
  const Place begin = goes_on ? from : first_;
  return Excerpt{
      .begin = begin,
      .end = end,
      .scenario = scenario_,
      .events = std::make_shared<const std::vector<Event>>(
          events_.begin() + static_cast<std::ptrdiff_t>(begin.event - first_.event), events_.end())};
}

RunLog::Place RunLog::end() {
  const std::lock_guard lock(mutex_);
  collect();
  return last();
}

void RunLog::follow() {
  if (!has_checkpoints_) return static_cast<void>(end());
  const Result<Excerpt> news = since(followed_);
  if (!news) return;
  const bool is_another = news->begin != followed_;
  followed_ = news->end;
  if (const std::lock_guard lock(mutex_); is_another) checkpoints_.clear();
  if (is_another && !shadow_.emplace().begin(*news->scenario)) shadow_.reset();
  Place place = news->begin;
  for (const Event& event : *news->events) {
    ++place.event;
    if (!shadow_) return;
    if (const auto* change = std::get_if<Change>(&event))
      static_cast<void>(shadow_->follow(change->as_recorded()));
    const auto* step = std::get_if<Step>(&event);
    if (step == nullptr) continue;
    static_cast<void>(shadow_->follow(recorded_of(*step)));
    keep(place);
    static_cast<void>(end());  // empties the ring, which fills while the shadow run is computed
  }
}

void RunLog::keep(const Place& place) {
  const double now = shadow_->time();
  if (!checkpoints_.empty() && now - checkpoints_.back().run->time() < kSpacing) return;
  auto copy = std::make_shared<recording::ShadowRun>();
  if (!copy->begin(*shadow_)) return shadow_.reset();
  const std::lock_guard lock(mutex_);
  checkpoints_.push_back({.place = place, .run = std::move(copy)});
  thin(now);
}

void RunLog::thin(double now) {
  for (std::size_t i = 1; i + 1 < checkpoints_.size();) {
    const double after = checkpoints_[i + 1].run->time();
    if (after - checkpoints_[i - 1].run->time() > now - after) {
      ++i;
      continue;
    }
    checkpoints_.erase(checkpoints_.begin() + static_cast<std::ptrdiff_t>(i));
  }
}

Result<recording::BranchReport> RunLog::branch(const recording::BranchOptions& options,
                                               const recording::BranchHooks& hooks) {
  recording::BranchOptions from_there = options;
  Place place;
  {
    const std::lock_guard lock(mutex_);
    collect();
    const Checkpoint* oldest = nullptr;
    for (const Checkpoint& each : checkpoints_) {
      if (!each.place.is_in_start_of(first_) || each.place.event < first_.event) continue;
      if (oldest == nullptr) oldest = &each;
      if (each.run->time() >= options.at - 1e-9) break;  // 1e-9 s: rounding of times
      from_there.from = each.run;
      place = each.place;
    }
    if (!from_there.from && first_.event > 0 && oldest != nullptr) {
      return fail(ErrorCode::kInvalidArgument,
                  fmt::format("the run is not known so far back any more: ask for a moment after {:.0f} s",
                              std::ceil(oldest->run->time())));
    }
  }
  const Result<Excerpt> events = since(place);
  if (!events) return fail(events.error());
  if (events->begin.event == 0)
    from_there.from.reset();  // the excerpt is the whole run: another one has begun
  return recording::branch_run(events->recorded(), from_there, hooks);
}

}  // namespace chicane::live
