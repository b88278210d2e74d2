// SPDX-License-Identifier: MIT
// Metrics of a run, collected step by step: extremes, laps and durations; settings and faults of each lap.
#include "chicane/telemetry/metrics.hpp"

#include <iterator>
#include <map>
#include <utility>

namespace chicane::telemetry {
namespace {

/// Duration in nanoseconds; 0 for negative ones and for not-a-number.
std::uint64_t nanoseconds(double seconds) noexcept {
  return std::isfinite(seconds) && seconds > 0.0 ? static_cast<std::uint64_t>(std::min(seconds, 1e9) * 1e9)
                                                 : 0;
}

TimeSummary summarise(const Durations& times) noexcept {
  const auto seconds = [](std::uint64_t ns) { return static_cast<double>(ns) * 1e-9; };
  return {seconds(times.percentile(0.5)), seconds(times.percentile(0.99)), seconds(times.percentile(0.999)),
          seconds(times.max())};
}

void add_to(Fnv& hash, const model::State& state) noexcept {
  for (const double value : {state.x, state.y, state.psi, state.vx, state.vy, state.r, state.steer})
    hash.add(value);
}

constexpr std::string_view kManual = "manual.is_on";  // name of the change by which a person takes the wheel
constexpr std::string_view kFault = "fault.";         // beginning of the names of faults

/// Whether a setting does not affect a lap: the pace, and a person's controls.
bool is_left_out(std::string_view name) {
  return name.starts_with("run.") || (name.starts_with("manual.") && name != kManual);
}

}  // namespace

void Metrics::Stretch::add(double dt, double speed, double error) noexcept {
  if (!std::isfinite(speed) || !std::isfinite(error))
    return;  // a broken client's message is not a measurement
  time += dt;
  speed_time += speed * dt;
  error_squared_time += error * error * dt;
  top_speed = std::max(top_speed, speed);
  max_abs_error = std::max(max_abs_error, std::fabs(error));
}

void Metrics::Stretch::add_rate(double dt, double rate) noexcept {
  rate_time += dt;
  rate_squared_time += rate * rate * dt;
}

LapSummary Metrics::Stretch::summary(double lap_time) const noexcept {
  LapSummary lap;
  lap.lap_time = lap_time;
  lap.mean_speed = time > 0.0 ? speed_time / time : 0.0;
  lap.top_speed = top_speed;
  lap.rms_lateral_error = time > 0.0 ? std::sqrt(error_squared_time / time) : 0.0;
  lap.max_abs_lateral_error = max_abs_error;
  if (std::isfinite(min_edge_distance)) lap.min_edge_distance = min_edge_distance;
  lap.max_lateral_acceleration = max_lateral_acceleration;
  lap.steering_rate_rms = rate_time > 0.0 ? std::sqrt(rate_squared_time / rate_time) : 0.0;
  return lap;
}

Metrics::Metrics(int lap_capacity, double deadline, std::size_t corners)
    : corners_{corners}, deadline_{deadline} {
  laps_.reserve(static_cast<std::size_t>(std::max(0, lap_capacity)));
  corner_times_.reserve(laps_.capacity() * corners_);
}

void Metrics::add_physics(const PhysicsSample& sample) noexcept {
  add_to(hash_, sample.state);
  const double speed = std::sqrt(sample.state.vx * sample.state.vx + sample.state.vy * sample.state.vy);
  for (Stretch* stretch : {&lap_, &total_}) {
    stretch->add(sample.step, speed, sample.lateral_error);
    stretch->max_lateral_acceleration =
        std::max(stretch->max_lateral_acceleration, std::fabs(sample.lateral_acceleration));
  }
  judge(sample.step, sample.edge_distance, sample.is_off_track);
}

void Metrics::judge(double step, double edge_distance, bool is_off_track) noexcept {
  for (Stretch* stretch : {&lap_, &total_})
    stretch->min_edge_distance = std::min(stretch->min_edge_distance, edge_distance);
  if (edge_distance < 0.0) out_of_track_time_ += step;
  if (is_off_track && !is_off_track_) ++off_track_events_;
  is_off_track_ = is_off_track;
}

void Metrics::add(const Frame& frame) noexcept {
  const controller::StepReport& report = frame.result.report;
  hash_.add(frame.result.command.steer);
  hash_.add(frame.result.command.throttle);

  const double steer = frame.has_truth ? frame.truth.steer : frame.measurement.steer;
  const double elapsed = frame.time - last_time_;
  if (cycles_ > 0 && elapsed > 0.0) {
    for (Stretch* stretch : {&lap_, &total_}) {
      stretch->add_rate(elapsed, (steer - last_steer_) / elapsed);
      if (!frame.has_truth) stretch->add(elapsed, frame.measurement.speed, frame.lateral_error);
    }
  }
  if (!frame.has_truth && frame.is_judged)
    judge(cycles_ > 0 ? std::max(elapsed, 0.0) : 0.0, frame.edge_distance, frame.is_off_track);
  last_time_ = frame.time;
  last_steer_ = steer;

  ++cycles_;
  step_times_.add(nanoseconds(frame.step_time));
  solve_times_.add(nanoseconds(frame.solve_time));
  if (frame.step_time > deadline_) ++deadline_misses_;
  iterations_ += static_cast<std::uint64_t>(std::max(0, report.solve.iterations));
  if (!solver::usable(report.solve.status)) ++not_usable_;
  if (frame.guard.rung != controller::Rung::kController) ++fallbacks_;
  ++guard_reasons_[static_cast<std::size_t>(frame.guard.reason)];
  if (frame.guard.gated) ++gated_;
  learned_ = report.learned;
}

void Metrics::lap_completed(double lap_time, const std::array<double, 3>& sector_times,
                            std::span<const double> corner_times) noexcept {
  ++laps_completed_;
  last_lap_ = lap_.summary(lap_time);
  last_lap_.sector_times = sector_times;
  if (laps_.size() < laps_.capacity()) {
    laps_.push_back(last_lap_);
    for (std::size_t i = 0; i < corners_; ++i)
      corner_times_.push_back(corner_times.size() == corners_ ? corner_times[i] : kNotMeasured);
  }
  lap_ = {};
}

RunSummary Metrics::summary() const {
  RunSummary run;
  run.laps_completed = laps_completed_;
  run.off_track_events = off_track_events_;
  run.out_of_track_time = out_of_track_time_;
  run.duration = total_.time;
  run.laps = laps_;
  for (std::size_t lap = 0; lap < laps_.size(); ++lap) {
    const auto first = corner_times_.begin() + static_cast<std::ptrdiff_t>(lap * corners_);
    run.laps[lap].corner_times.assign(first, first + static_cast<std::ptrdiff_t>(corners_));
  }
  run.total = total_.summary(total_.time);
  run.step_time = summarise(step_times_);
  run.solve_time = summarise(solve_times_);
  run.cycles = cycles_;
  run.mean_iterations = cycles_ > 0 ? static_cast<double>(iterations_) / static_cast<double>(cycles_) : 0.0;
  run.not_usable = not_usable_;
  run.fallbacks = fallbacks_;
  run.guard_reasons = guard_reasons_;
  run.learned = learned_;
  run.gate_interventions = gated_;
  run.deadline_misses = deadline_misses_;
  run.state_hash = hash_.value();
  return run;
}

void compare_with_limit(RunSummary& run, const lap_time::LapTimes& limit, int first_lap) {
  run.limit = limit;
  run.why_no_limit.clear();
  for (std::size_t number = static_cast<std::size_t>(first_lap); number <= run.laps.size(); ++number) {
    LapSummary& lap = run.laps[number - 1];
    lap.gap_to_limit = lap_time::gap(lap.lap_time, limit.lap);
    for (std::size_t i = 0; i < lap.sector_gaps.size(); ++i)
      lap.sector_gaps[i] = lap_time::gap(lap.sector_times[i], limit.sectors[i]);
  }
}

void LapLedger::restart() {
  std::erase_if(log_, [](const Noted& each) { return each.name.starts_with(kFault); });
  fold(log_.size());
}

void LapLedger::add(const Change& change) {
  if (change.starts_anew) return begin();
  if (is_left_out(change.name.view())) return;
  if (log_.size() >= kMostKept) fold(kMostKept / 2);
  log_.push_back({change.time, std::string(change.name.view()), std::string(change.value.view())});
}

void LapLedger::fold(std::size_t count) {
  std::map<std::string, std::string> outcome;
  const auto end = log_.begin() + static_cast<std::ptrdiff_t>(count);
  for (auto each = log_.begin(); each != end; ++each) outcome[each->name] = std::move(each->value);
  std::vector<Noted> folded;
  for (auto& [name, value] : outcome) folded.push_back({kBefore, name, std::move(value)});
  std::move(end, log_.end(), std::back_inserter(folded));
  log_ = std::move(folded);
}

LapSetup LapLedger::setup(double end, double lap_time) const {
  const double start = end - lap_time;
  LapSetup setup;
  std::map<std::string, std::string> settings;
  std::map<std::string, bool> faults;  // faults that acted in the lap, or still act
  double by_hand_since = end;          // time since which a person drives; `end`: nobody does
  double by_hand = 0.0;                // time in the lap that a person drove
  for (const Noted& each : log_) {
    if (each.time > end) break;
    const bool is_on = each.value != "false";
    if (each.name == kManual) {
      by_hand += std::max(0.0, std::max(start, each.time) - std::max(start, by_hand_since));
      by_hand_since = is_on ? each.time : end;
    } else if (each.name.starts_with(kFault)) {
      // A fault that ended before the lap began did not act in the lap.
      if (is_on || each.time > start)
        faults[each.name.substr(kFault.size())] = true;
      else
        faults.erase(each.name.substr(kFault.size()));
    } else {
      std::string& value = settings[each.name];
      setup.is_mixed |= each.time > start && value != each.value;
      value = each.value;
    }
  }
  by_hand += std::max(0.0, end - std::max(start, by_hand_since));
  setup.by_hand_share = lap_time > 0.0 ? std::clamp(by_hand / lap_time, 0.0, 1.0) : 0.0;
  for (auto& [name, value] : settings) {
    setup.names.push_back(name);
    setup.values.push_back(std::move(value));
  }
  for (const auto& [name, acted] : faults) setup.faults.push_back(name);
  return setup;
}

}  // namespace chicane::telemetry
