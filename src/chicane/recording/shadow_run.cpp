// SPDX-License-Identifier: MIT
// Shadow runs, and branches: a recorded or live run is repeated up to a moment; from there two futures are
// driven, one of them with other settings, and summarised.
#include "chicane/recording/shadow_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

#include "chicane/base/math.hpp"
#include "chicane/base/text.hpp"
#include "chicane/protocol/schema.hpp"
#include "chicane/protocol/schema_json.hpp"
#include "chicane/sim/world.hpp"

namespace chicane::recording {
namespace {

/// Whether measurement and command of a frame have the bits of a recorded step.
bool is_same(const telemetry::Frame& frame, const protocol::Step& step) noexcept {
  const model::Measurement &now = frame.measurement, &then = step.measurement;
  const model::Command &sent = frame.result.command, &sent_then = step.command;
  return is_same_number(now.x, then.x) && is_same_number(now.y, then.y) &&
         is_same_number(now.psi, then.psi) && is_same_number(now.speed, then.speed) &&
         is_same_number(now.steer, then.steer) && is_same_number(now.throttle, then.throttle) &&
         is_same_number(sent.steer, sent_then.steer) && is_same_number(sent.throttle, sent_then.throttle);
}

}  // namespace

Result<void> ShadowRun::begin(const scenario::Scenario& scenario) {
  auto loop = run::ClosedLoop::create(scenario);
  if (!loop) return fail(loop.error());
  take(std::move(*loop));
  loop_->drive_on();
  return {};
}

void ShadowRun::begin(std::unique_ptr<run::ClosedLoop> loop) {
  take(std::move(loop));
  time_ = loop_->frame().time;
  next_cycle_ = loop_->cycle();
}

bool ShadowRun::begin(const ShadowRun& other) {
  std::unique_ptr<run::ClosedLoop> copy = other.loop_->copy();
  if (copy == nullptr) return false;
  take(std::move(copy));
  time_ = other.time_;
  next_cycle_ = other.next_cycle_;
  first_difference_ = other.first_difference_;
  return true;
}

void ShadowRun::take(std::unique_ptr<run::ClosedLoop> loop) {
  steps_.reset();
  loop_ = std::move(loop);
  steps_.emplace(*loop_, hooks_);
}

Result<void> ShadowRun::follow(const RecordedEvent& event) {
  return std::visit([this](const auto& one) { return take(one); }, event);
}

Result<void> ShadowRun::take(const telemetry::Change& change) {
  if (const Result<run::Setting> setting = run::read_setting(change)) apply(*setting);
  return {};
}

Result<void> ShadowRun::take(const RecordedStep& recorded) {
  const protocol::Step& step = recorded.step;
  if (step.begins && loop_->cycle() > 0) loop_->restart();
  finish_cycle();
  loop_->advance({.delay = step.measurement.delay, .deadline_spent_at = step.deadline_spent_at});
  steps_->tell_lap();
  time_ = recorded.log_time;
  next_cycle_ = step.cycle + 1;
  if (!first_difference_ && !is_same(loop_->frame(), step)) first_difference_ = step.cycle;
  return {};
}

void ShadowRun::apply(const run::Setting& setting) {
  if (const auto* fault = std::get_if<run::FaultSwitch>(&setting.action)) {
    const auto bit = static_cast<unsigned>(fault->event.fault);
    const bool is_on = (loop_->frame().active_faults >> bit & 1U) != 0U;
    const bool is_of_the_past = setting.change.time <= loop_->frame().time;  // this run has driven beyond it
    if (is_of_the_past && is_on == (fault->to != run::FaultSwitch::To::kOff)) return;
  }
  finish_cycle();
  loop_->apply(setting);
}

void ShadowRun::drive(const std::function<bool()>& is_enough) {
  while (!loop_->is_over() && !is_enough()) steps_->advance();
}

namespace {

/// Summary of a future, collected from its frames.
class FutureMeter {
 public:
  /// Adds a frame; returns its distance from the start line of the first frame's lap [m].
  double add(const telemetry::Frame& frame, const road::Track& track) {
    const bool is_first = count_ == 0;
    if (is_first) start_ = frame.time, lap_ = frame.lap, events_ = frame.off_track_events;
    // Prefer the true motion to the measured one, because sensors may fail.
    const double speed = frame.has_truth ? hypot(frame.truth.vx, frame.truth.vy) : frame.measurement.speed;
    future_.max_lateral_error = std::max(future_.max_lateral_error, std::fabs(frame.lateral_error));
    future_.min_edge_distance =
        is_first ? frame.edge_distance : std::min(future_.min_edge_distance, frame.edge_distance);
    future_.top_speed = std::max(future_.top_speed, speed);
    future_.off_track_events = frame.off_track_events - events_;
    const bool is_own = frame.guard.rung == controller::Rung::kController && !frame.guard.gated;
    if (!frame.is_manual && !is_own) ++future_.interventions;
    ++count_;
    speed_sum_ += speed;
    future_.mean_speed = speed_sum_ / static_cast<double>(count_);
    go_to(frame, track);
    future_.duration = frame.time - start_;
    return distance_;
  }
  void add(const telemetry::CompletedLap& lap) { future_.lap_times.push_back(lap.lap_time); }
  [[nodiscard]] const Future& future() const { return future_; }
  /// Crossings of the line, as far as the last frame shows.
  [[nodiscard]] int crossings() const {
    return static_cast<int>(
        std::count_if(future_.passages.begin(), future_.passages.end(),
                      [](const Passage& each) { return each.sector == sim::WorldState::kSectors; }));
  }

 private:
  /// Adds the distance since the last frame, and the passage of a third of a lap, interpolated in time.
  void go_to(const telemetry::Frame& frame, const road::Track& track) {
    constexpr int kSectors = sim::WorldState::kSectors;
    const double length = track.lap_length(), third = length / kSectors;
    const bool is_closed = track.centre().is_closed();
    const double before = distance_;
    double step = frame.s - std::exchange(s_, frame.s);
    if (count_ == 1) {
      step = frame.s - track.start_s();
      if (is_closed && step < 0.0) step += length;
    } else if (is_closed) {
      step -= length * std::round(step / length);
    }
    distance_ += step;
    int thirds = static_cast<int>(std::floor(distance_ / third));
    if (!is_closed) thirds = std::min(thirds, kSectors);  // an open road is one lap
    if (count_ > 1 && thirds > passed_) {
      const double elapsed = frame.time - start_ - future_.duration;
      future_.passages.push_back({.lap = lap_ + (thirds - 1) / kSectors + 1,
                                  .sector = (thirds - 1) % kSectors + 1,
                                  .time = future_.duration + elapsed * (thirds * third - before) / step});
    }
    passed_ = count_ == 1 ? thirds : std::max(passed_, thirds);
  }

  Future future_{.min_edge_distance = std::numeric_limits<double>::quiet_NaN()};
  std::uint64_t count_ = 0;          ///< frames
  double start_ = 0.0;               ///< time of the first frame [s]
  double distance_ = 0.0, s_ = 0.0;  ///< distance, and Frame::s, of the last frame [m]
  double speed_sum_ = 0.0;           ///< sum of speeds [m/s]
  int lap_ = 0, events_ = 0;         ///< lap and off-track events of the first frame
  int passed_ = 0;                   ///< thirds of laps passed since the start line
};

/// Reads a setting or a fault that may change during a run.
Result<run::Setting> read_live(const telemetry::Change& change) {
  const std::string_view key = change.name.view();
  const protocol::Parameter* row = protocol::find(key);
  if (row != nullptr && !protocol::is_live(*row)) {
    return fail(ErrorCode::kInvalidArgument,
                std::string(key) +
                    ": got a change while the run goes on, expected a setting that can change then "
                    "(docs/viewer.md)");
  }
  if (row == nullptr && !key.starts_with("fault."))
    return fail(ErrorCode::kNotFound, fmt::format("{}: {}", printable(key), protocol::unknown_key(key)));
  return run::read_setting(change);
}

constexpr double kForever = std::numeric_limits<double>::infinity();
constexpr double kSameTime = 1e-9;  // [s] rounding of times

/// Computation of a branch: the recorded run is computed again up to the branch. From there the first future
/// is the run itself, as recorded until the recording ends; the second one is a copy with other settings.
class Branching {
 public:
  Branching(const BranchOptions& options, const BranchHooks& hooks)
      : options_{options}, hooks_{hooks}, first_{*this, false}, second_{*this, true} {}

  Result<BranchReport> drive(const RunEvents& events) {
    if (options_.from && !first_.car.begin(*options_.from)) return cannot_copy();
    last_log_time_ = first_.car.time();
    const Result<void> read = events([this](const RecordedEvent& event) {
      return std::visit([&](const auto& one) { return take(one, event); }, event);
    });
    if (!read) return fail(read.error());
    if (!has_branched_ && options_.drives_both) {
      if (Result<void> branched = branch_at_end(); !branched) return fail(branched.error());
    }
    if (!has_branched_) {
      return fail(ErrorCode::kInvalidArgument,
                  fmt::format("--branch-at: got {}, expected a moment in [0, {:.2f}] s, which was recorded",
                              options_.at, last_log_time_));
    }
    report_.known_until = last_log_time_;
    first_.car.finish_cycle();  // a recording ends at a control step
    if (options_.drives_both && !is_over_) drive_on(first_);
    drive_on(second_);
    if (has_given_up_) return fail(ErrorCode::kInvalidArgument, "given up");
    report_.first_difference = first_.car.first_difference();
    report_.recorded = first_.meter.future();
    report_.branched = second_.meter.future();
    return report_;
  }

 private:
  /// One of the two futures.
  struct Side {
    Side(Branching& of, bool is_second)
        : is_branch{is_second},
          car{{.on_frame = [&of, this](const telemetry::Frame&) { of.step(*this); },
               .on_lap = [&of, this](const telemetry::CompletedLap& lap) { of.add(*this, lap); },
               .on_change =
                   [&of, this](const telemetry::Change& change) {
                     if (is_branch) of.tell(change);
                   }}} {}

    bool is_branch;
    ShadowRun car;
    FutureMeter meter;
  };

  static tl::unexpected<Error> cannot_copy() {
    return fail(ErrorCode::kInvalidArgument, "this controller or plant cannot be copied");
  }

  Result<void> take(const scenario::Scenario& /*scenario*/, const RecordedEvent& event) {
    if (is_left_behind(has_branched_)) return {};
    Result<void> begun = first_.car.follow(event);
    return begun && !has_branched_ && hooks_.on_begin ? hooks_.on_begin(first_.car.loop()) : begun;
  }

  Result<void> take(const telemetry::Change& change, const RecordedEvent& event) {
    if (is_left_behind(false)) return {};
    if (!has_branched_) tell(change);
    return first_.car.follow(event);
  }

  Result<void> take(const RecordedStep& recorded, const RecordedEvent& event) {
    last_log_time_ = recorded.log_time;
    if (!may_go_on(recorded.log_time)) return fail(ErrorCode::kInvalidArgument, "given up");
    const bool is_start = !has_branched_ && recorded.log_time >= options_.at - kSameTime;
    if (is_start) {
      if (Result<void> branched = branch(recorded); !branched) return branched;
    }
    const bool is_seen = has_branched_ && is_within(recorded.log_time);
    // A comparison needs nothing after the first future's end, and no other run.
    if (is_left_behind(has_branched_ && !is_start && (!is_seen || recorded.step.begins))) return {};
    if (Result<void> followed = first_.car.follow(event); !followed) return followed;
    if (is_seen) add(first_);
    if (has_branched_) return {};
    ++report_.steps_before;
    if (hooks_.on_frame) hooks_.on_frame(first_.car.loop().frame());
    return {};
  }

  /// Branches after the last known event.
  Result<void> branch_at_end() {
    if (!first_.car.has_begun() || first_.car.next_cycle() == 0)
      return fail(ErrorCode::kInvalidArgument, "the run has not begun: there is nothing to go on from");
    RecordedStep next;
    next.step.cycle = first_.car.next_cycle();
    first_.car.finish_cycle();
    next.log_time = last_log_time_ + (first_.car.loop().time() - first_.car.loop().frame().time);
    return branch(next);
  }

  /// Branches at the control step `recorded`, which is not computed yet.
  Result<void> branch(const RecordedStep& recorded) {
    first_.car.finish_cycle();
    has_branched_ = true;
    report_.at = recorded.log_time;
    report_.cycle = recorded.step.cycle;
    run::ClosedLoop& loop = first_.car.loop();
    if (recorded.step.begins && loop.cycle() > 0) loop.restart();
    start_ = loop.time();
    return second_.car.begin(first_.car) ? change() : cannot_copy();
  }

  /// Applies the settings of the options to the second future.
  Result<void> change() {
    const run::ClosedLoop& loop = second_.car.loop();
    scenario::Scenario changed = loop.scenario();
    for (const auto& [key, text] : options_.settings) {
      if (!decltype(telemetry::Change::value)::fits(text))
        return fail(ErrorCode::kInvalidArgument, key + ": is too long");
      const telemetry::Change change{.cycle = loop.cycle(),
                                     .time = loop.time(),
                                     .name = std::string_view(key),
                                     .value = std::string_view(text)};
      const Result<run::Setting> setting = read_live(change);
      if (!setting) return fail(setting.error());
      if (const auto* field = std::get_if<run::FieldValue>(&setting->action)) run::write(changed, *field);
      second_.car.apply(*setting);
      tell(change);
    }
    for (const protocol::Contradiction& found : protocol::contradictions(changed))
      return fail(ErrorCode::kInvalidArgument, fmt::format("{}: {}", found.key, found.message));
    return {};
  }

  /// Drives a future on, from its current state to the end of the branch.
  void drive_on(Side& side) {
    const run::ClosedLoop& loop = side.car.loop();
    const double rest = last_log_time_ - report_.at;
    const bool has_laps_only = options_.laps + options_.more_laps > 0 && options_.duration == 0.0;
    const double duration = options_.duration > 0.0 ? options_.duration : has_laps_only ? kForever : rest;
    const auto driven = [&] { return loop.time() - start_; };
    side.car.drive([&] {
      if (has_given_up_ || has_all_laps(side) || driven() > kLongest) return true;
      if (options_.laps > 0 && (loop.world().lap >= options_.laps || loop.world().is_finished)) return true;
      return loop.is_control_due() && driven() > duration + 1e-6;
    });
    if (!side.is_branch) return;
    if (loop.is_over()) report_.end_reason = "the car left the road and did not come back";
    if (driven() > kLongest) report_.end_reason = "the laps were not driven within an hour";
  }

  /// Takes a driven control step of a future.
  void step(Side& side) {
    add(side);
    const run::ClosedLoop& loop = side.car.loop();
    has_given_up_ = !may_go_on(report_.at + loop.time() - start_);
    if (side.is_branch && hooks_.on_frame) hooks_.on_frame(loop.frame());
  }

  /// Adds a control step after the branch to the summary of a future.
  void add(Side& side) {
    const run::ClosedLoop& loop = side.car.loop();
    const double distance = side.meter.add(loop.frame(), loop.track());
    if (hooks_.on_future)
      hooks_.on_future({.frame = loop.frame(), .distance = distance, .is_branch = side.is_branch});
  }

  void add(Side& side, const telemetry::CompletedLap& lap) {
    if (side.is_branch || (has_branched_ && is_within(last_log_time_))) side.meter.add(lap);
    if ((side.is_branch || !has_branched_) && hooks_.on_lap) hooks_.on_lap(lap);
  }
  void tell(const telemetry::Change& change) {
    if (hooks_.on_change) hooks_.on_change(change);
  }

  /// Whether the record is not needed any more: two futures are driven, and the first one `ends`.
  bool is_left_behind(bool ends) { return is_over_ = is_over_ || (ends && options_.drives_both); }
  [[nodiscard]] bool may_go_on(double time) const { return !hooks_.go_on || hooks_.go_on(time); }
  [[nodiscard]] bool has_all_laps(const Side& side) const {
    return options_.more_laps > 0 && side.meter.crossings() >= options_.more_laps;
  }
  /// Whether a recorded time is within the duration asked for the second future.
  [[nodiscard]] bool is_within(double log_time) const {
    if (has_all_laps(first_)) return false;
    return log_time - report_.at <= (options_.duration > 0.0 ? options_.duration : kForever) + kSameTime;
  }

  static constexpr double kLongest = 3600.0;  ///< longest future of laps without a duration [s]; chosen

  const BranchOptions& options_;
  const BranchHooks& hooks_;
  BranchReport report_;
  Side first_, second_;
  bool has_branched_ = false;   ///< the branch is reached
  bool is_over_ = false;        ///< the first future has ended within the record
  bool has_given_up_ = false;   ///< BranchHooks::go_on has returned false
  double start_ = 0.0;          ///< run time at the branch [s]
  double last_log_time_ = 0.0;  ///< log time of the last visited control step [s]
};

}  // namespace

Result<BranchReport> branch_run(const RunEvents& events, const BranchOptions& options,
                                const BranchHooks& hooks) {
  return Branching(options, hooks).drive(events);
}

Result<BranchReport> branch_recording(const BranchOptions& options, const BranchHooks& hooks) {
  RecordingHead head;
  const RunEvents events = [&](const auto& visit) -> Result<void> {
    const auto read = read_recording(options.log, head, [&](const RecordedEvent& event) -> Result<void> {
      if (head["mode"] == "serve") {
        return fail(ErrorCode::kInvalidArgument,
                    options.log +
                        ": mode: got serve, expected drive: the car of an external simulator is not "
                        "here to drive on");
      }
      return visit(event);
    });
    return read ? Result<void>{} : fail(read.error());
  };
  return branch_run(events, options, hooks);
}

}  // namespace chicane::recording
