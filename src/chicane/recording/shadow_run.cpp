// SPDX-License-Identifier: MIT
#include "chicane/recording/shadow_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
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

bool is_same(double a, double b) noexcept {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

bool is_same(const telemetry::Frame& frame, const protocol::Step& step) noexcept {
  const model::Measurement &now = frame.measurement, &then = step.measurement;
  const model::Command &sent = frame.result.command, &sent_then = step.command;
  return is_same(now.x, then.x) && is_same(now.y, then.y) && is_same(now.psi, then.psi) &&
         is_same(now.speed, then.speed) && is_same(now.steer, then.steer) &&
         is_same(now.throttle, then.throttle) && is_same(sent.steer, sent_then.steer) &&
         is_same(sent.throttle, sent_then.throttle);
}

}  // namespace

Result<void> ShadowRun::begin(const scenario::Scenario& scenario) {
  auto loop = run::ClosedLoop::create(scenario, make_);
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
    const bool is_of_the_past = setting.change.time <= loop_->frame().time;
    if (is_of_the_past && is_on == (fault->to != run::FaultSwitch::To::kOff)) return;
  }
  finish_cycle();
  loop_->apply(setting);
}

void ShadowRun::drive(const std::function<bool()>& is_enough) {
  while (!loop_->is_over() && !is_enough()) steps_->advance();
}

namespace {

/// The road of a future from the branch on: how far, and when which third of the lap was passed.
class Odometer {
 public:
  /// Distance from the start line of the lap in which the first frame is [m].
  double add(const telemetry::Frame& frame, const road::Track& track) {
    const bool is_closed = track.centre().is_closed();
    const double length = track.lap_length();
    third_ = length / sim::WorldState::kSectors;
    most_thirds_ = is_closed ? std::numeric_limits<int>::max() : sim::WorldState::kSectors;
    if (!has_begun_) {
      begin(frame, frame.s - track.start_s(), is_closed ? length : 0.0);
    } else {
      double step = frame.s - s_;
      if (is_closed) step -= length * std::round(step / length);
      go(step, frame.time);
    }
    s_ = frame.s;
    time_ = frame.time;
    return distance_;
  }
  [[nodiscard]] const std::vector<Passage>& passages() const { return passages_; }

 private:
  void begin(const telemetry::Frame& frame, double behind_line, double round) {
    has_begun_ = true;
    distance_ = behind_line < 0.0 ? behind_line + round : behind_line;
    start_ = frame.time;
    lap_ = frame.lap;
    passed_ = thirds();
  }
  void go(double step, double time) {
    const double before = distance_;
    distance_ += step;
    if (thirds() <= passed_) return;
    passed_ = thirds();
    const double share = (passed_ * third_ - before) / step;
    passages_.push_back({.lap = lap_ + (passed_ - 1) / sim::WorldState::kSectors + 1,
                         .sector = (passed_ - 1) % sim::WorldState::kSectors + 1,
                         .time = time_ + share * (time - time_) - start_});
  }
  [[nodiscard]] int thirds() const {
    return std::min(most_thirds_, static_cast<int>(std::floor(distance_ / third_)));
  }

  bool has_begun_ = false;
  double third_ = 1.0;                                          // of the lap [m]
  int most_thirds_ = 0;                                         // an open road is one lap
  double distance_ = 0.0, s_ = 0.0, time_ = 0.0, start_ = 0.0;  // as of the last frame
  int lap_ = 0, passed_ = 0;
  std::vector<Passage> passages_;
};

/// What a future comes to, from its frames.
class FutureMeter {
 public:
  /// The distance that Odometer tells.
  double add(const telemetry::Frame& frame, const road::Track& track) {
    if (count_ == 0) {
      start_ = frame.time;
      events_ = frame.off_track_events;
    }
    // The car's true motion, not the measured one: sensors may fail.
    const double speed = frame.has_truth ? hypot(frame.truth.vx, frame.truth.vy) : frame.measurement.speed;
    future_.duration = frame.time - start_;
    future_.max_lateral_error = std::max(future_.max_lateral_error, std::fabs(frame.lateral_error));
    future_.min_edge_distance =
        count_ == 0 ? frame.edge_distance : std::min(future_.min_edge_distance, frame.edge_distance);
    future_.top_speed = std::max(future_.top_speed, speed);
    future_.off_track_events = frame.off_track_events - events_;
    const bool is_own = frame.guard.rung == controller::Rung::kController && !frame.guard.gated;
    if (!frame.is_manual && !is_own) {
      ++future_.interventions;
    }
    ++count_;
    speed_sum_ += speed;
    future_.mean_speed = speed_sum_ / static_cast<double>(count_);
    return road_.add(frame, track);
  }
  void add(const telemetry::CompletedLap& lap) { future_.lap_times.push_back(lap.lap_time); }
  [[nodiscard]] Future future() const {
    Future future = future_;
    if (count_ == 0) future.min_edge_distance = std::numeric_limits<double>::quiet_NaN();
    future.passages = road_.passages();
    return future;
  }
  /// How often the line was crossed, as far as a frame behind it was seen.
  [[nodiscard]] int crossings() const {
    return static_cast<int>(
        std::count_if(road_.passages().begin(), road_.passages().end(),
                      [](const Passage& each) { return each.sector == sim::WorldState::kSectors; }));
  }

 private:
  Future future_;
  Odometer road_;
  std::uint64_t count_ = 0;
  double start_ = 0.0;
  double speed_sum_ = 0.0;
  int events_ = 0;
};

/// A setting or a fault that may change while a run goes on.
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

/// One of the two futures: the recorded run computed again, then the shadow run by itself. The first one is
/// the recorded run for as long as there is one; the second one leaves it at the branch, with the settings.
class Branching {
 public:
  Branching(const BranchOptions& options, const BranchHooks& hooks, const run::Factories& make,
            bool is_branch, BranchReport& report)
      : options_{options},
        hooks_{hooks},
        is_branch_{is_branch},
        report_{report},
        car_{{.on_frame = [this](const telemetry::Frame&) { step(car_.loop()); },
              .on_lap = [this](const telemetry::CompletedLap& lap) { add(lap); },
              .on_change = [this](const telemetry::Change& change) { tell(change); }},
             make} {}

  Result<Future> drive(const RunEvents& events) {
    if (options_.from && !car_.begin(*options_.from))
      return fail(ErrorCode::kInvalidArgument, "this controller cannot be copied");
    last_log_time_ = car_.time();
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
    car_.finish_cycle();  // a recording ends with the last control step, a run may have gone on to a line
    if (is_branch_ || (options_.drives_both && !is_over_)) drive_on();
    if (has_given_up_) return fail(ErrorCode::kInvalidArgument, "given up");
    return meter_.future();
  }

  /// ShadowRun::first_difference() of all that was recorded, for the first future.
  [[nodiscard]] std::optional<std::uint64_t> first_difference() const { return car_.first_difference(); }

 private:
  Result<void> take(const scenario::Scenario& /*scenario*/, const RecordedEvent& event) {
    if (is_left_behind(has_branched_)) return {};
    Result<void> begun = car_.follow(event);
    return begun && is_branch_ && hooks_.on_begin ? hooks_.on_begin(car_.loop()) : begun;
  }

  Result<void> take(const telemetry::Change& change, const RecordedEvent& event) {
    if (is_left_behind(false)) return {};
    tell(change);
    return car_.follow(event);
  }

  Result<void> take(const RecordedStep& recorded, const RecordedEvent& event) {
    last_log_time_ = recorded.log_time;
    if (!may_go_on(recorded.log_time)) return fail(ErrorCode::kInvalidArgument, "given up");
    const bool is_start = !has_branched_ && recorded.log_time >= options_.at - 1e-9;
    if (is_start) {
      if (Result<void> branched = branch(recorded); !branched) return branched;
    }
    const bool is_seen = has_branched_ && is_within(recorded.log_time);
    // Of two futures that are compared, what follows is not needed, nor another run.
    if (is_left_behind(has_branched_ && !is_start && (!is_seen || recorded.step.begins))) return {};
    if (Result<void> followed = car_.follow(event); !followed) return followed;
    if (is_seen) add(car_.loop());
    if (has_branched_ || !is_branch_) return {};
    ++report_.steps_before;
    if (hooks_.on_frame) hooks_.on_frame(car_.loop().frame());
    return {};
  }

  /// From now on: what comes next is not known yet.
  Result<void> branch_at_end() {
    if (!car_.has_begun() || car_.next_cycle() == 0)
      return fail(ErrorCode::kInvalidArgument, "the run has not begun: there is nothing to go on from");
    RecordedStep next;
    next.step.cycle = car_.next_cycle();
    car_.finish_cycle();
    next.log_time = last_log_time_ + (car_.loop().time() - car_.loop().frame().time);
    return branch(next);
  }

  Result<void> branch(const RecordedStep& recorded) {
    car_.finish_cycle();
    has_branched_ = true;
    report_.at = recorded.log_time;
    report_.cycle = recorded.step.cycle;
    run::ClosedLoop& loop = car_.loop();
    if (recorded.step.begins && loop.cycle() > 0) loop.restart();
    start_ = loop.time();
    return is_branch_ ? change() : Result<void>{};
  }

  Result<void> change() {
    const run::ClosedLoop& loop = car_.loop();
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
      car_.apply(*setting);
      tell(change);
    }
    for (const protocol::Contradiction& found : protocol::contradictions(changed))
      return fail(ErrorCode::kInvalidArgument, fmt::format("{}: {}", found.key, found.message));
    return {};
  }

  /// By itself, from where it has come to.
  void drive_on() {
    const run::ClosedLoop& loop = car_.loop();
    const double rest = last_log_time_ - report_.at;
    const bool has_laps_only = options_.laps + options_.more_laps > 0 && options_.duration == 0.0;
    const double duration = options_.duration > 0.0 ? options_.duration : has_laps_only ? kForever : rest;
    const auto driven = [&] { return loop.time() - start_; };
    car_.drive([&] {
      if (has_given_up_ || has_all_laps() || driven() > kLongest) return true;
      if (options_.laps > 0 && (loop.world().lap >= options_.laps || loop.world().is_finished)) return true;
      return loop.is_control_due() && driven() > duration + 1e-6;
    });
    if (!is_branch_) return;
    if (loop.is_over()) report_.end_reason = "the car left the road and did not come back";
    if (driven() > kLongest) report_.end_reason = "the laps were not driven within an hour";
  }

  void step(const run::ClosedLoop& loop) {
    add(loop);
    has_given_up_ = !may_go_on(report_.at + loop.time() - start_);
    if (is_branch_ && hooks_.on_frame) hooks_.on_frame(loop.frame());
  }

  /// A control step behind the branch.
  void add(const run::ClosedLoop& loop) {
    const double distance = meter_.add(loop.frame(), loop.track());
    if (hooks_.on_future)
      hooks_.on_future({.frame = loop.frame(), .distance = distance, .is_branch = is_branch_});
  }

  void add(const telemetry::CompletedLap& lap) {
    if (has_branched_ && (is_branch_ || is_within(last_log_time_))) meter_.add(lap);
    if (is_branch_ && hooks_.on_lap) hooks_.on_lap(lap);
  }
  void tell(const telemetry::Change& change) {
    if (is_branch_ && hooks_.on_change) hooks_.on_change(change);
  }

  /// Nothing more of what was recorded is computed: the second future has branched, or, of two that are
  /// driven, the first `ends`.
  bool is_left_behind(bool ends) {
    is_over_ = is_over_ || (ends && options_.drives_both);
    return is_branch_ ? has_branched_ : is_over_;
  }
  [[nodiscard]] bool may_go_on(double time) const { return !hooks_.go_on || hooks_.go_on(time); }
  [[nodiscard]] bool has_all_laps() const {
    return options_.more_laps > 0 && meter_.crossings() >= options_.more_laps;
  }
  /// Of what was recorded: as long as the second future is asked to be.
  [[nodiscard]] bool is_within(double log_time) const {
    if (has_all_laps()) return false;
    return log_time - report_.at <= (options_.duration > 0.0 ? options_.duration : kForever) + 1e-9;
  }

  static constexpr double kLongest = 3600.0;  // [s] without a given duration

  const BranchOptions& options_;
  const BranchHooks& hooks_;
  bool is_branch_;
  BranchReport& report_;
  ShadowRun car_;
  FutureMeter meter_;
  bool has_branched_ = false;
  bool is_over_ = false;  ///< the first future: what was recorded ends it
  bool has_given_up_ = false;
  double start_ = 0.0;          ///< of the run, at the branch [s]
  double last_log_time_ = 0.0;  ///< [s]
};

}  // namespace

Result<BranchReport> branch_run(const RunEvents& events, const BranchOptions& options,
                                const BranchHooks& hooks, const run::Factories& make) {
  BranchReport report;
  Branching second(options, hooks, make, true, report);
  auto branched = second.drive(events);
  if (!branched) return fail(branched.error());
  Branching first(options, hooks, make, false, report);
  auto recorded = first.drive(events);
  if (!recorded) return fail(recorded.error());
  report.first_difference = first.first_difference();
  report.recorded = std::move(*recorded);
  report.branched = std::move(*branched);
  return report;
}

Result<BranchReport> branch_recording(const BranchOptions& options, const BranchHooks& hooks,
                                      const run::Factories& make) {
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
  return branch_run(events, options, hooks, make);
}

}  // namespace chicane::recording
