// SPDX-License-Identifier: MIT
#include "chicane/live/journal.hpp"

#include <chrono>
#include <memory>
#include <utility>

namespace chicane::live {
namespace {

constexpr auto kCollectEvery = std::chrono::milliseconds(200);
constexpr const char* kTooLong =
    "the run has become too long to be computed again from its start; reset it first";
constexpr const char* kTooBusy = "the machine was too busy to keep what happened in this run; reset it first";

}  // namespace

Journal::Journal()
    : ring_(kRing),
      worker_{[this] {
                const std::lock_guard lock(mutex_);
                collect();
              },
              kCollectEvery} {}

void Journal::begin(const scenario::Scenario& scenario) {
  {
    const std::lock_guard lock(mutex_);
    waiting_.push_back(scenario);
  }
  if (push({.kind = Entry::Kind::kBegin, .step = {}, .change = {}})) return;
  const std::lock_guard lock(mutex_);
  waiting_.pop_back();
}

void Journal::note(const telemetry::Frame& frame) noexcept {
  const model::Measurement& now = frame.measurement;
  static_cast<void>(push({.kind = Entry::Kind::kStep,
                          .step = {.cycle = frame.cycle,
                                   .time = frame.time,
                                   .delay = now.delay,
                                   .deadline_spent_at = frame.deadline_spent_at,
                                   .begins = frame.begins,
                                   .seen = {now.x, now.y, now.psi, now.speed, now.steer, now.throttle},
                                   .sent = {frame.result.command.steer, frame.result.command.throttle}},
                          .change = {}}));
}

void Journal::note(const telemetry::Change& change) noexcept {
  static_cast<void>(push({.kind = Entry::Kind::kChange, .step = {}, .change = change}));
}

bool Journal::push(const Entry& entry) noexcept {
  const std::uint64_t number = put_.load(std::memory_order_relaxed);
  if (number - taken_.load(std::memory_order_acquire) >= kRing) {
    has_lost_ = true;
    return false;
  }
  ring_[static_cast<std::size_t>(number % kRing)] = entry;
  put_.store(number + 1, std::memory_order_release);
  return true;
}

/// With the mutex held.
void Journal::collect() {
  const std::uint64_t end = put_.load(std::memory_order_acquire);
  for (std::uint64_t number = taken_.load(std::memory_order_relaxed); number != end; ++number) {
    take(ring_[static_cast<std::size_t>(number % kRing)]);
    taken_.store(number + 1, std::memory_order_release);
  }
  if (has_lost_.exchange(false)) why_unknown_ = kTooBusy;
}

void Journal::take(const Entry& entry) {
  switch (entry.kind) {
    case Entry::Kind::kBegin:
      scenario_ = std::move(waiting_.front());
      waiting_.pop_front();
      has_begun_ = true;
      why_unknown_ = nullptr;
      events_.clear();
      first_ = {.run = first_.run + 1, .event = 0};
      return;
    case Entry::Kind::kChange:
      add(ChangeNote{.cycle = entry.change.cycle,
                     .time = entry.change.time,
                     .name = std::string(entry.change.name.view()),
                     .value = std::string(entry.change.value.view())});
      return;
    case Entry::Kind::kStep:
      if (entry.step.begins) start_anew(entry.step);
      add(entry.step);
  }
}

void Journal::add(Event event) {
  events_.push_back(std::move(event));
  if (events_.size() <= kMostEvents) return;
  events_.pop_front();
  ++first_.event;
}

/// The car stands at the start again: settings stay, faults and what was driven do not.
void Journal::start_anew(const StepNote& first) {
  std::deque<Event> kept;
  for (Event& event : events_) {
    auto* change = std::get_if<ChangeNote>(&event);
    if (change == nullptr) continue;
    const bool is_of_the_new_run = change->cycle == first.cycle && change->time == first.time;
    if (change->name.starts_with("fault.") && !is_of_the_new_run) continue;
    change->cycle = first.cycle;
    change->time = first.time;
    std::erase_if(kept, [&](const Event& each) { return std::get<ChangeNote>(each).name == change->name; });
    kept.push_back(std::move(event));
  }
  events_ = std::move(kept);
  first_ = {.run = first_.run + 1, .event = 0};
  why_unknown_ = has_begun_ ? nullptr : why_unknown_;
}

recording::RecordedEvent Journal::told(const Event& event) {
  if (const auto* change = std::get_if<ChangeNote>(&event)) {
    return telemetry::Change{.cycle = change->cycle,
                             .time = change->time,
                             .name = std::string_view(change->name),
                             .value = std::string_view(change->value)};
  }
  const auto& note = std::get<StepNote>(event);
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

Result<Journal::Excerpt> Journal::history(Place from) {
  const std::lock_guard lock(mutex_);
  collect();
  if (!has_begun_) return fail(ErrorCode::kInvalidArgument, "the run has not begun");
  if (why_unknown_ != nullptr) return fail(ErrorCode::kInvalidArgument, why_unknown_);
  const Place end{.run = first_.run, .event = first_.event + events_.size()};
  const bool goes_on = from.run == first_.run && from.event >= first_.event && from.event <= end.event;
  if (!goes_on && first_.event > 0) return fail(ErrorCode::kInvalidArgument, kTooLong);
  const Place begin = goes_on ? from : first_;
  auto events = std::make_shared<const std::vector<Event>>(
      events_.begin() + static_cast<std::ptrdiff_t>(begin.event - first_.event), events_.end());
  const auto tell = [begin, scenario = scenario_, events](const auto& visit) -> Result<void> {
    if (begin.event == 0) {
      if (Result<void> begun = visit(scenario); !begun) return begun;
    }
    for (const Event& event : *events) {
      if (Result<void> taken = visit(told(event)); !taken) return taken;
    }
    return {};
  };
  return Excerpt{.begin = begin, .end = end, .events = tell};
}

Journal::Place Journal::oldest() {
  const std::lock_guard lock(mutex_);
  collect();
  return first_;
}

}  // namespace chicane::live
