// SPDX-License-Identifier: MIT
#include "chicane/sweep/tune.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#ifdef CHICANE_HAS_NLOPT
#include <nlopt.h>
#endif

#include "chicane/base/math.hpp"
#include "chicane/base/text.hpp"
#include "chicane/protocol/library.hpp"
#include "chicane/protocol/schema.hpp"
#include "chicane/run/parallel.hpp"
#include "chicane/sweep/sweep.hpp"
#include "chicane/sweep/trial.hpp"

namespace chicane::sweep {
namespace {

constexpr int kTuningDigits = 6;

/// The trials: the first is the nominal one.
std::vector<Settings> trials_of(double latency) {
  const auto text = [](double ms) { return number_text(std::max(ms, 0.0), kTuningDigits); };
  return {{},
          {{"latency_ms", text(latency + 30.0)}},
          {{"latency_ms", text(latency - 30.0)}},
          {{"plant_options.friction_scale", "0.9"}},
          {{"sensor.position_noise_m", "0.05"}}};
}

/// A number to change, on a logarithmic scale.
struct Knob {
  std::string key;
  double low = 0.0, high = 0.0, by_hand = 0.0;
  bool is_integer = false;
  [[nodiscard]] std::string at(double share) const {
    const double value = std::clamp(low * exp(share * log(high / low)), low, high);
    return number_text(is_integer ? std::round(value) : value, kTuningDigits);
  }
  [[nodiscard]] double share() const { return std::clamp(log(by_hand / low) / log(high / low), 0.0, 1.0); }
};

Result<Knob> knob_of(const scenario::Scenario& scenario, const std::string& key) {
  const protocol::Parameter* row = protocol::find(key);
  const bool is_number = row != nullptr && (row->option.kind == protocol::Kind::kNumber ||
                                            row->option.kind == protocol::Kind::kInteger);
  const double value = is_number ? std::get<double>(protocol::get(scenario, *row)) : 0.0;
  if (!is_number || !(value > 0.0) || !std::isfinite(value)) {
    return fail(ErrorCode::kInvalidArgument,
                fmt::format("--over: got {}, expected a number above zero of this preset", printable(key)));
  }
  const double factor = key.find("weight") != std::string::npos ? 10.0 : 2.0;
  Knob knob{key, std::max(value / factor, row->option.minimum), std::min(value * factor, row->option.maximum),
            value, row->option.kind == protocol::Kind::kInteger};
  if (knob.low <= 0.0) knob.low = value / factor;
  return knob;
}

class Tuner {
 public:
  Tuner(const TuneTask& task, std::vector<Knob> knobs, double latency, const std::atomic<bool>& stop,
        const std::function<void(int, const Verdict&)>& on_better)
      : task_{task},
        knobs_{std::move(knobs)},
        trials_{trials_of(latency)},
        stop_{stop},
        on_better_{on_better} {}

  void judge_by_hand() { tuning_.by_hand = tuning_.found = judge({}); }

  /// The price of a point; keeps the best.
  double price(const double* shares) {
    if (stop_) return kWorst;
    Settings values;
    for (std::size_t i = 0; i < knobs_.size(); ++i)
      values.emplace_back(knobs_[i].key, knobs_[i].at(shares[i]));
    const Verdict verdict = judge(values);
    ++tuning_.evaluations;
    const double price = price_of(verdict);
    if (price < best_) {
      best_ = price;
      tuning_.values = values;
      tuning_.found = verdict;
      if (on_better_) on_better_(tuning_.evaluations, verdict);
    }
    return price;
  }

  [[nodiscard]] Tuning result() {
    tuning_.is_better = tuning_.found.is_clean() && tuning_.found.margin >= tuning_.by_hand.margin &&
                        best_ < price_of(tuning_.by_hand);
    return tuning_;
  }

 private:
  static constexpr double kWorst = 1e6;

  [[nodiscard]] double price_of(const Verdict& verdict) const {
    double price = 0.0;
    if (!verdict.is_clean())
      price +=
          1000.0 + 100.0 * verdict.unfinished + std::min(verdict.off_track_events, 1000) - verdict.margin;
    price += 50.0 * std::max(0.0, tuning_.by_hand.margin - verdict.margin);
    const double lap = std::isfinite(verdict.lap_time) ? verdict.lap_time : 1000.0;
    switch (task_.objective) {
      case Objective::kLap:
        return price + lap;
      case Objective::kComfort:
        return price + 100.0 * verdict.steering_rate + 0.1 * lap;
      case Objective::kRobust:
        break;
    }
    return price - 10.0 * verdict.margin + 0.1 * lap;
  }

  [[nodiscard]] Verdict judge(const Settings& values) {
    std::vector<Result<std::optional<telemetry::RunSummary>>> runs(trials_.size());
    run::for_each_run(trials_.size(), task_.jobs, [&](std::uint64_t i, run::Roads&) {
      Settings settings{{"guard.mode", "off"}, {"laps", "2"}, {"time_limit_s", "300"}};
      for (const Settings* more :
           std::initializer_list<const Settings*>{&task_.settings, &values, &trials_[i]})
        settings.insert(settings.end(), more->begin(), more->end());
      run::Roads& roads = roads_[i];
      runs[i] = drive(settings, roads, stop_);
      return true;
    });
    Verdict verdict{.margin = std::numeric_limits<double>::infinity()};
    for (std::size_t i = 0; i < runs.size(); ++i) {
      if (!runs[i] || !*runs[i]) {
        ++verdict.unfinished;
        verdict.margin = std::min(verdict.margin, -100.0);
        continue;
      }
      const telemetry::RunSummary& run = **runs[i];
      if (i == 0) {
        verdict.lap_time = run.completed ? run.laps.back().lap_time : telemetry::kNotMeasured;
        verdict.steering_rate = run.total.steering_rate_rms;
      }
      if (!run.completed) ++verdict.unfinished;
      verdict.off_track_events += run.off_track_events;
      verdict.margin = std::min(verdict.margin, run.total.min_edge_distance);
    }
    return verdict;
  }

  const TuneTask& task_;
  std::vector<Knob> knobs_;
  std::vector<Settings> trials_;
  const std::atomic<bool>& stop_;
  const std::function<void(int, const Verdict&)>& on_better_;
  std::array<run::Roads, 5> roads_;  ///< one for each trial: no two of them share one
  Tuning tuning_;
  double best_ = std::numeric_limits<double>::infinity();
};

#ifdef CHICANE_HAS_NLOPT
Result<void> search(const TuneTask& task, const std::vector<Knob>& knobs, Tuner& tuner) {
  constexpr std::array kAlgorithms{NLOPT_GN_CRS2_LM, NLOPT_GN_DIRECT_L, NLOPT_LN_SBPLX};
  nlopt_srand(static_cast<unsigned long>(task.seed));
  const auto count = static_cast<unsigned>(knobs.size());
  nlopt_opt const search = nlopt_create(kAlgorithms[static_cast<std::size_t>(task.optimizer)], count);
  std::vector<double> point(count);
  for (std::size_t i = 0; i < knobs.size(); ++i) point[i] = knobs[i].share();
  nlopt_set_min_objective(
      search,
      [](unsigned, const double* x, double*, void* data) { return static_cast<Tuner*>(data)->price(x); },
      &tuner);
  nlopt_set_lower_bounds1(search, 0.0);
  nlopt_set_upper_bounds1(search, 1.0);
  nlopt_set_initial_step1(search, 0.1);
  nlopt_set_maxeval(search, task.evaluations);
  double price = 0.0;
  const nlopt_result result = nlopt_optimize(search, point.data(), &price);
  nlopt_destroy(search);
  if (result >= 0 || result == NLOPT_ROUNDOFF_LIMITED || result == NLOPT_FORCED_STOP) return {};
  return fail(ErrorCode::kInvalidArgument, fmt::format("NLopt ended with {}", static_cast<int>(result)));
}
#else
Result<void> search(const TuneTask&, const std::vector<Knob>&, Tuner&) {
  return fail(ErrorCode::kIo,
              "this program was built without NLopt: install libnlopt-dev and build it again");
}
#endif

}  // namespace

std::vector<std::string> default_keys(const scenario::Scenario& scenario) {
  std::vector<std::string> keys;
  for (const protocol::Parameter& row : protocol::list()) {
    if (row.controller != scenario.controller) continue;
    const std::string_view name = row.option.name;
    const bool is_wanted = name.starts_with("weight_") || name == "horizon_steps" || name == "step_length" ||
                           name.starts_with("speed_");
    if (is_wanted && knob_of(scenario, std::string(row.key))) keys.emplace_back(row.key);
  }
  return keys;
}

Result<Tuning> tune(const TuneTask& task, const std::atomic<bool>& stop,
                    const std::function<void(int, const Verdict&)>& on_better) {
  const Result<protocol::Request> request = request_of(task.settings);
  if (!request) return fail(request.error());
  const Result<scenario::Scenario> scenario = protocol::compose(*request);
  if (!scenario) return fail(scenario.error());
  std::vector<Knob> knobs;
  for (const std::string& key : task.over.empty() ? default_keys(*scenario) : task.over) {
    Result<Knob> knob = knob_of(*scenario, key);
    if (!knob) return fail(knob.error());
    knobs.push_back(std::move(*knob));
  }
  if (knobs.empty())
    return fail(ErrorCode::kInvalidArgument,
                fmt::format("--over: {} has nothing to tune", scenario->controller));
  Tuner tuner(task, knobs, 1e3 * scenario->latency, stop, on_better);
  tuner.judge_by_hand();
  if (const Result<void> done = search(task, knobs, tuner); !done) return fail(done.error());
  return tuner.result();
}

}  // namespace chicane::sweep
