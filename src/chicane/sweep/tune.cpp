// SPDX-License-Identifier: MIT
// Tuning: an optimiser varies numbers of a preset. Each evaluation drives a set of trials; a log keeps its
// verdict, so that none is driven twice.
#include "chicane/sweep/tune.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <type_traits>
#include <utility>

#include "chicane/base/instruction_set.hpp"
#include "chicane/base/math.hpp"
#include "chicane/base/text.hpp"
#include "chicane/protocol/json.hpp"
#include "chicane/protocol/library.hpp"
#include "chicane/protocol/schema.hpp"
#include "chicane/protocol/yaml_codec.hpp"
#include "chicane/run/parallel.hpp"
#include "chicane/sweep/result_file.hpp"
#include "chicane/sweep/sweep.hpp"
#include "chicane/sweep/trial.hpp"

#ifdef CHICANE_HAS_NLOPT
#include <nlopt.h>
#endif

namespace chicane::sweep {
namespace {

using protocol::Json;

/// Log of all evaluations, so that none is driven twice: in memory, and optionally in a file with a JSON
/// object in each line. The first line identifies the task.
class TuneLog {
 public:
  /// Opens the log, and reads a file that exists; an empty path: no file. kInvalidArgument for a file with
  /// another first line than `head`; kParse "FILE:LINE: …"; kIo.
  [[nodiscard]] static Result<TuneLog> open(const std::string& path, const std::string& head) {
    TuneLog log;
    if (path.empty()) return log;
    const auto refuse = [&](const std::string&) {
      return Error{ErrorCode::kInvalidArgument,
                   fmt::format("{}: got the log of another search or program, expected one of this; --log "
                               "names another file",
                               path)};
    };
    const auto take = [&](const LinePlace&, const std::string& line) -> Result<void> {
      try {
        log.verdicts_.insert(evaluation_in(line));
      } catch (const Json::exception&) {
        return fail(ErrorCode::kParse, fmt::format("got {}, expected an evaluation", printable(line)));
      }
      return {};
    };
    Result<LineFile> file = LineFile::open(path, head, refuse, take);
    if (!file) return fail(file.error());
    log.file_ = std::move(*file);
    return log;
  }

  /// Verdict on a tuning; null: not driven yet.
  [[nodiscard]] const Verdict* find(const Settings& values) const {
    const auto found = verdicts_.find(values);
    return found == verdicts_.end() ? nullptr : &found->second;
  }

  /// Adds a verdict. kIo if its line cannot be written.
  [[nodiscard]] Result<void> add(const Settings& values, const Verdict& verdict) {
    verdicts_[values] = verdict;
    Json json{{"values", json_of(values)}};
    Verdict::rows(verdict, [&](const char* name, auto value) { json[name] = value; });
    return file_.append(protocol::json_text(json));
  }

 private:
  /// Tuning and verdict of a line. Throws Json::exception for another line.
  static std::pair<Settings, Verdict> evaluation_in(const std::string& line) {
    const Json json = protocol::parse_json(line);
    std::pair<Settings, Verdict> read{settings_in(json.at("values")), {}};
    Verdict::rows(read.second, [&](const char* name, auto& value) {
      const Json& member = json.at(name);
      value = std::numeric_limits<std::remove_reference_t<decltype(value)>>::quiet_NaN();
      if (!member.is_null()) member.get_to(value);
    });
    return read;
  }

  LineFile file_{};
  std::map<Settings, Verdict> verdicts_{};
};

/// First line of the log of a task: settings and their scenario, keys, objective, program and its arithmetic.
/// It leaves out the optimiser, which changes no evaluation.
std::string tune_head(const TuneTask& task, const scenario::Scenario& scenario,
                      const std::vector<std::string>& keys) {
  const Json json{{"tune", json_of(task.settings)},
                  {"scenario", protocol::write_preset(scenario, scenario::Scenario{}, "")},
                  {"over", keys},
                  {"objective", kObjectiveNames[static_cast<std::size_t>(task.objective)]},
                  {"program", program_name()},
                  {"arithmetic", arithmetic(chosen_instruction_set())}};
  return protocol::json_text(json);
}

constexpr int kTuningDigits = 6;            // significant digits of a tuned value; chosen
constexpr double kTimeLimitByHand = 600.0;  // [s] limit of a trial of the tuning by hand; chosen
constexpr double kPatience = 1.5;           // time limit of another tuning over the time by hand; chosen
constexpr double kWeightFactor = 10.0;      // factor down and up of searched weights; chosen
constexpr double kOtherFactor = 2.0;        // factor down and up of other searched numbers; chosen

/// Number that is tuned, on a logarithmic scale between its bounds.
struct Knob {
  std::string key;
  double low = 0.0, high = 0.0, by_hand = 0.0;  ///< bounds, and the value of the preset
  bool is_integer = false;
  /// Value at a share of the scale, as text.
  [[nodiscard]] std::string at(double share) const {
    const double value = std::clamp(low * exp(share * log(high / low)), low, high);
    return number_text(is_integer ? std::round(value) : value, kTuningDigits);
  }
  /// Share of the scale at which the value by hand is.
  [[nodiscard]] double share() const { return std::clamp(log(by_hand / low) / log(high / low), 0.0, 1.0); }
};

/// Knob of a key. kInvalidArgument if the key is no number above zero.
Result<Knob> knob_of(const scenario::Scenario& scenario, const std::string& key) {
  const protocol::Parameter* row = protocol::find(key);
  const bool is_number = row != nullptr && (row->option.kind == protocol::Kind::kNumber ||
                                            row->option.kind == protocol::Kind::kInteger);
  const double value = is_number ? std::get<double>(protocol::get(scenario, *row)) : 0.0;
  if (!is_number || !(value > 0.0) || !std::isfinite(value)) {
    return fail(refusal("--over", key, "a number above zero of this preset"));
  }
  const double factor = key.find("weight") != std::string::npos ? kWeightFactor : kOtherFactor;
  Knob knob{key, std::max(value / factor, row->option.minimum), std::min(value * factor, row->option.maximum),
            value, row->option.kind == protocol::Kind::kInteger};
  if (knob.low <= 0.0) knob.low = value / factor;
  return knob;
}

/// Judge of tunings: drives their trials, and keeps the best one.
class Tuner {
 public:
  Tuner(const TuneTask& task, std::vector<Knob> knobs, double latency, TuneLog& log,
        const std::atomic<bool>& stop, const std::function<void(int, const Verdict*)>& on_evaluation)
      : task_{task},
        knobs_{std::move(knobs)},
        trials_{tune_trials(latency)},
        by_hand_(trials_.size()),
        roads_(trials_.size()),
        log_{log},
        stop_{stop},
        on_evaluation_{on_evaluation} {}

  /// Drives the tuning by hand, before all others.
  void judge_by_hand() {
    is_by_hand_ = true;
    for (std::size_t i = 0; i < trials_.size(); ++i)
      count_in(tuning_.by_hand, i, run(i, {}, kTimeLimitByHand));
    is_by_hand_ = false;
    tuning_.by_hand.passed = tuning_.by_hand.driven;
    tuning_.found = tuning_.by_hand;
  }

  /// Whether enough different tunings were tried, or the search was stopped.
  [[nodiscard]] bool is_over() const { return stop_ || failure_ || tuning_.evaluations >= task_.evaluations; }
  [[nodiscard]] int evaluations() const { return tuning_.evaluations; }
  /// Shares of the knobs of the best tuning so far; of the tuning by hand if there is none.
  [[nodiscard]] std::vector<double> best_point() const {
    std::vector<double> point = best_point_;
    if (point.empty())
      for (const Knob& knob : knobs_) point.push_back(knob.share());
    return point;
  }

  /// Score of a point, given as shares of the knobs: lower is better. Keeps the best point.
  double score(const double* shares) {
    if (is_over()) return kWorst;
    Settings values;
    for (std::size_t i = 0; i < knobs_.size(); ++i)
      values.emplace_back(knobs_[i].key, knobs_[i].at(shares[i]));
    const std::optional<Verdict> verdict = known_or_driven(values);
    if (!verdict) return kWorst;
    if (tried_.insert(values).second) {
      ++tuning_.evaluations;
      tuning_.runs += verdict->driven;
    }
    const double score = score_of(*verdict);
    const bool is_better = score < best_;
    if (is_better) {
      best_ = score;
      best_point_.assign(shares, shares + knobs_.size());
      tuning_.values = values;
      tuning_.found = *verdict;
    }
    if (on_evaluation_) on_evaluation_(tuning_.evaluations, is_better ? &*verdict : nullptr);
    return score;
  }

  /// Best tuning, or the error of writing the log.
  [[nodiscard]] Result<Tuning> result() {
    if (failure_) return fail(failure_->code, failure_->message);
    tuning_.is_better = has_passed(tuning_.found) && tuning_.found.is_clean() &&
                        objective(tuning_.found) < objective(tuning_.by_hand);
    return tuning_;
  }

  /// Score of a tuning that was not driven: above all others.
 private:
  static constexpr double kWorst = 1e6;
  using Run = Result<std::optional<telemetry::RunSummary>>;  ///< as drive() returns it
  /// Result of a trial with the tuning by hand.
  struct ByHand {
    double distance = 0.0;    ///< [m]
    double time_limit = 0.0;  ///< limit for other tunings [s]
  };

  /// Whether the tuning passed all trials.
  [[nodiscard]] bool has_passed(const Verdict& verdict) const {
    return verdict.passed == static_cast<int>(trials_.size());
  }

  /// Objective of a verdict: lower is better. Further trials can only worsen it, because lap and steering
  /// come from the first trial and the margin is the least of all. The factors are chosen: they bring metres,
  /// rad/s and seconds to one scale. 1000 [s] stands for no lap.
  [[nodiscard]] double objective(const Verdict& verdict) const {
    const double lap = std::isfinite(verdict.lap_time) ? verdict.lap_time : 1000.0;
    switch (task_.objective) {
      case Objective::kLap:
        return lap;
      case Objective::kComfort:
        return 100.0 * verdict.steering_rate + 0.1 * lap;
      case Objective::kRobust:
        break;
    }
    return -10.0 * verdict.margin + 0.1 * lap;
  }

  /// Score of a verdict: lower is better. Only the order of scores counts. The numbers are chosen so that
  /// ranges do not overlap: 1e4 for each trial that was not passed; for the failed trial up to 6000 by
  /// objective and margin if it was clean, else 7000 to 8000 by its progress.
  [[nodiscard]] double score_of(const Verdict& verdict) const {
    const int missing = static_cast<int>(trials_.size()) - verdict.passed;
    if (missing == 0) return objective(verdict);
    const double deficit = std::max(0.0, tuning_.by_hand.margin - verdict.margin);
    const double failure = verdict.is_clean()
                               ? std::min(objective(verdict), 2000.0) + (deficit > 0.0 ? 2000.0 : 0.0) +
                                     std::min(100.0 * deficit, 2000.0)
                               : 8000.0 - 1000.0 * verdict.progress;
    return 1e4 * missing + failure;
  }

  /// Verdict from the log, or by driving; empty if the search was stopped or the log cannot be written.
  [[nodiscard]] std::optional<Verdict> known_or_driven(const Settings& values) {
    if (const Verdict* const known = log_.find(values)) return *known;
    const Verdict verdict = judge(values);
    if (stop_) return std::nullopt;
    if (const Result<void> written = log_.add(values, verdict); !written) {
      failure_ = written.error();
      return std::nullopt;
    }
    return verdict;
  }

  /// Drives the trials of a tuning until it fails one.
  [[nodiscard]] Verdict judge(const Settings& values) {
    Verdict verdict;
    const auto passes = [&](std::size_t i, const Run& run) {
      count_in(verdict, i, run);
      const bool goes_on = verdict.is_clean() && verdict.margin >= tuning_.by_hand.margin &&
                           objective(verdict) <= objective(tuning_.by_hand);
      if (goes_on) ++verdict.passed;
      return goes_on;
    };
    if (!passes(0, run(0, values, by_hand_[0].time_limit))) return verdict;
    // Drive all trials ahead on several threads; the verdict does not depend on their number.
    std::vector<Run> ahead(trials_.size());
    if (task_.jobs > 1) {
      run::for_each_run(trials_.size() - 1, task_.jobs, [&](std::uint64_t i, run::Roads&) {
        ahead[i + 1] = run(i + 1, values, by_hand_[i + 1].time_limit);
        return true;
      });
    }
    for (std::size_t i = 1; i < trials_.size(); ++i)
      if (!passes(i, task_.jobs > 1 ? ahead[i] : run(i, values, by_hand_[i].time_limit))) break;
    return verdict;
  }

  /// Drives one trial of a tuning for at most `time_limit` [s].
  [[nodiscard]] Run run(std::size_t trial, const Settings& values, double time_limit) {
    Settings settings{{"guard.mode", "off"}, {"laps", "2"}};
    for (const Settings* more :
         std::initializer_list<const Settings*>{&task_.settings, &values, &trials_[trial].settings})
      settings.insert(settings.end(), more->begin(), more->end());
    settings.emplace_back("time_limit_s", number_text(time_limit, kTuningDigits));
    return drive(settings, roads_[trial], stop_, is_by_hand_ ? Until::kItsEnd : Until::kOffRoad);
  }

  /// Counts the run of a trial in a verdict.
  void count_in(Verdict& verdict, std::size_t trial, const Run& run) {
    if (verdict.driven++ == 0) verdict.margin = std::numeric_limits<double>::infinity();
    if (!run || !*run) {
      ++verdict.unfinished;
      verdict.margin = std::min(verdict.margin, -100.0);  // [m] below every real margin: nothing was driven
      verdict.progress = 0.0;
      return;
    }
    const telemetry::RunSummary& summary = **run;
    const double distance = summary.total.mean_speed * summary.duration;
    if (is_by_hand_)
      by_hand_[trial] = {distance, summary.completed ? kPatience * summary.duration : kTimeLimitByHand};
    verdict.progress = distance >= by_hand_[trial].distance ? 1.0 : distance / by_hand_[trial].distance;
    if (trial == 0) {
      verdict.lap_time = summary.completed ? summary.laps.back().lap_time : telemetry::kNotMeasured;
      verdict.steering_rate = summary.total.steering_rate_rms;
    }
    if (!summary.completed) ++verdict.unfinished;
    verdict.off_track_events += summary.off_track_events;
    verdict.margin = std::min(verdict.margin, summary.total.min_edge_distance);
  }

  const TuneTask& task_;
  std::vector<Knob> knobs_;
  std::vector<TuneTrial> trials_;
  std::vector<ByHand> by_hand_;    ///< result of each trial by hand
  std::vector<run::Roads> roads_;  ///< one for each trial: no two of them share one
  TuneLog& log_;
  const std::atomic<bool>& stop_;
  const std::function<void(int, const Verdict*)>& on_evaluation_;
  bool is_by_hand_ = false;         ///< the tuning by hand is being driven
  std::optional<Error> failure_;    ///< error of writing the log
  Tuning tuning_;                   ///< best so far
  std::set<Settings> tried_;        ///< different tunings
  std::vector<double> best_point_;  ///< shares of the knobs of the best tuning; empty: none yet
  double best_ = std::numeric_limits<double>::infinity();  ///< score of the best tuning
};

#ifdef CHICANE_HAS_NLOPT
/// Searches once from `point` with first steps of `step`, both as shares of the knobs, until the search
/// converges or the tuner is over.
nlopt_result search_from(std::vector<double> point, double step, const TuneTask& task, Tuner& tuner) {
  constexpr std::array kAlgorithms{NLOPT_GN_CRS2_LM, NLOPT_GN_DIRECT_L, NLOPT_LN_SBPLX};
  constexpr int kSameAgain = 20;  // NLopt counts repeated tunings, too: its limit over ours; chosen
  struct Context {
    Tuner& tuner;
    nlopt_opt search;
  };
  Context context{tuner, nlopt_create(kAlgorithms[static_cast<std::size_t>(task.optimizer)],
                                      static_cast<unsigned>(point.size()))};
  nlopt_set_min_objective(
      context.search,
      [](unsigned, const double* x, double*, void* data) {
        const Context& at = *static_cast<Context*>(data);
        const double score = at.tuner.score(x);
        if (at.tuner.is_over()) nlopt_force_stop(at.search);
        return score;
      },
      &context);
  nlopt_set_lower_bounds1(context.search, 0.0);
  nlopt_set_upper_bounds1(context.search, 1.0);
  nlopt_set_initial_step1(context.search, step);
  nlopt_set_maxeval(context.search, kSameAgain * task.evaluations);
  double score = 0.0;
  const nlopt_result result = nlopt_optimize(context.search, point.data(), &score);
  nlopt_destroy(context.search);
  return result;
}

/// Searches from the best point, again and again with smaller first steps, until a search finds no new
/// tuning.
Result<void> search(const TuneTask& task, Tuner& tuner) {
  nlopt_srand(static_cast<unsigned long>(task.seed));
  constexpr double kFirstStep = 0.1,
                   kSmaller = 0.7;  // share of a knob's scale, factor of each search; chosen
  int before = -1;
  for (double step = kFirstStep; !tuner.is_over() && tuner.evaluations() > before; step *= kSmaller) {
    before = tuner.evaluations();
    const nlopt_result result = search_from(tuner.best_point(), step, task, tuner);
    if (result < 0 && result != NLOPT_ROUNDOFF_LIMITED && result != NLOPT_FORCED_STOP)
      return fail(ErrorCode::kInvalidArgument, fmt::format("NLopt ended with {}", static_cast<int>(result)));
  }
  return {};
}
#else
Result<void> search(const TuneTask&, Tuner&) {
  return fail(ErrorCode::kIo,
              "this program was built without NLopt: install libnlopt-dev and build it again");
}
#endif

}  // namespace

std::vector<TuneTrial> tune_trials(double latency) {
  const auto ms = [](double seconds) { return number_text(std::max(1e3 * seconds, 0.0), kTuningDigits); };
  return {{"as it is", {}},
          {"30 ms later", {{"latency_ms", ms(latency + 0.03)}}},
          {"10 % less grip", {{"plant_options.friction_scale", "0.9"}}},
          {"30 ms sooner", {{"latency_ms", ms(latency - 0.03)}}},
          {"noise", {{"sensor.position_noise_m", "0.05"}}},
          {"other noise", {{"sensor.position_noise_m", "0.05"}, {"seed", "2"}}}};
}

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
                    const std::function<void(int, const Verdict*)>& on_evaluation) {
  const Result<scenario::Scenario> scenario = scenario_of(task.settings);
  if (!scenario) return fail(scenario.error());
  const std::vector<std::string> keys = task.over.empty() ? default_keys(*scenario) : task.over;
  std::vector<Knob> knobs;
  for (const std::string& key : keys) {
    Result<Knob> knob = knob_of(*scenario, key);
    if (!knob) return fail(knob.error());
    knobs.push_back(std::move(*knob));
  }
  if (knobs.empty())
    return fail(ErrorCode::kInvalidArgument,
                fmt::format("--over: {} has nothing to tune", scenario->controller));
  Result<TuneLog> log = TuneLog::open(task.log, tune_head(task, *scenario, keys));
  if (!log) return fail(log.error());
  Tuner tuner(task, knobs, scenario->latency, *log, stop, on_evaluation);
  tuner.judge_by_hand();
  if (const Result<void> done = search(task, tuner); !done) return fail(done.error());
  return tuner.result();
}

}  // namespace chicane::sweep
