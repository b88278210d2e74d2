// SPDX-License-Identifier: MIT
// Shadow runs for viewers: WhatIf computes both futures of a question, Rival drives a second car beside a
// live run. Answers are JSON.
#include "chicane/live/what_if.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <variant>

#include "chicane/base/math.hpp"
#include "chicane/base/text.hpp"
#include "chicane/protocol/json.hpp"
#include "chicane/protocol/schema.hpp"
#include "chicane/telemetry/metrics.hpp"

namespace chicane::live {
namespace {

/// Rounds to millimetres and milliseconds. A value that is not finite becomes null in JSON.
double rounded(double value) { return std::round(value * 1e3) / 1e3; }

/// Rows of numbers as JSON by columns, {"time_s": [...], ...}: each row is in the order of `names`. Keeps
/// every `stride`-th row and the last.
template <std::size_t kCount, class Rows>
protocol::Json columns(const std::array<const char*, kCount>& names, const Rows& rows,
                       std::size_t stride = 1) {
  protocol::Json all = protocol::Json::object();
  for (std::size_t column = 0; column < kCount; ++column) {
    protocol::Json& values = all[names[column]] = protocol::Json::array();
    for (std::size_t row = 0; row < rows.size(); ++row)
      if (row % stride == 0 || row + 1 == rows.size()) values.push_back(rounded(rows[row][column]));
  }
  return all;
}

using protocol::Json;

// Most rows of a trace in an answer; chosen: as many as a screen shows.
constexpr std::size_t kMostRows = 1500;

/// Error in a question: the name of a field, and its expected content.
tl::unexpected<Error> refuse(std::string_view what, std::string_view expected) {
  return fail(ErrorCode::kInvalidArgument, fmt::format("what if: {}: expected {}", what, expected));
}

/// Trace of one future: rows of numbers, sent as columns.
struct Trace {
  static constexpr std::size_t kColumns = 10;
  static constexpr std::array<const char*, kColumns> kNames{
      "time_s",          "distance_m",     "x_m", "y_m", "yaw_rad", "steer_rad", "speed_mps", "throttle",
      "lateral_error_m", "edge_distance_m"};
  std::vector<std::array<double, kColumns>> rows;

  void add(const recording::FutureStep& step) {
    const telemetry::Frame& frame = step.frame;
    const model::State& car = frame.truth;
    const double speed = hypot(car.vx, car.vy);
    rows.push_back({frame.time, step.distance, car.x, car.y, car.psi, frame.applied.steer, speed,
                    frame.applied.throttle, frame.lateral_error, frame.edge_distance});
  }
};

Json json_of(const recording::Future& future, const Trace& trace) {
  const std::size_t stride = std::max<std::size_t>(1, (trace.rows.size() + kMostRows - 1) / kMostRows);
  Json passages = Json::array();
  for (const recording::Passage& each : future.passages) {
    passages.push_back({{"lap", each.lap}, {"sector", each.sector}, {"time_s", rounded(each.time)}});
  }
  Json laps = Json::array();
  for (const double time : future.lap_times) laps.push_back(rounded(time));
  return {{"duration_s", rounded(future.duration)},
          {"lap_times_s", std::move(laps)},
          {"max_abs_lateral_error_m", rounded(future.max_lateral_error)},
          {"min_edge_distance_m", rounded(future.min_edge_distance)},
          {"mean_speed_mps", rounded(future.mean_speed)},
          {"top_speed_mps", rounded(future.top_speed)},
          {"off_track_events", future.off_track_events},
          {"interventions", future.interventions},
          {"passages", std::move(passages)},
          {"trace", columns(Trace::kNames, trace.rows, stride)}};
}

Json json_of(const std::vector<std::pair<std::string, std::string>>& settings) {
  Json json = Json::object();
  for (const auto& [key, value] : settings) json[key] = value;
  return json;
}

/// Number in [least, most] under `name`; `otherwise` if it is absent or null.
Result<double> number_of(const Json& json, const char* name, double least, double most, double otherwise) {
  const auto found = json.find(name);
  if (found == json.end() || found->is_null()) return otherwise;
  const double value = found->is_number() ? found->get<double>() : std::nan("");
  if (!(value >= least && value <= most))
    return refuse(name, fmt::format("a number in [{}, {}]", least, most));
  return value;
}

Result<std::string> text_of(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_boolean()) return std::string(value.get<bool>() ? "true" : "false");
  if (value.is_number()) return fmt::format("{}", value.get<double>());
  return fail(ErrorCode::kInvalidArgument, "a number, a text, true or false");
}

}  // namespace

Result<WhatIfQuestion> read_question(std::string_view text) {
  const Json json = protocol::parse_json(text);
  if (!json.is_object()) return refuse("the question", "a JSON object");
  // Limits are chosen; kEver is later than any run [s].
  constexpr double kEver = 1e9, kMostLaps = 10.0, kMostLogs = 1000.0;
  const auto at = number_of(json, "at_s", 0.0, kEver, kEver);
  if (!at) return fail(at.error());
  const auto duration = number_of(json, "for_s", 0.1, WhatIfQuestion::kLongest, WhatIfQuestion::kLongest);
  if (!duration) return fail(duration.error());
  const auto laps = number_of(json, "laps", 0.0, kMostLaps, 0.0);
  if (!laps) return fail(laps.error());
  const auto log = number_of(json, "log", 0.0, kMostLogs, 0.0);
  if (!log) return fail(log.error());
  WhatIfQuestion question;
  question.log = static_cast<std::size_t>(*log);
  question.options.at = *at;
  question.options.duration = *duration;
  question.options.more_laps = static_cast<int>(*laps);
  question.options.drives_both = true;
  if (const auto settings = json.find("settings"); settings != json.end()) {
    if (!settings->is_object() || settings->size() > WhatIfQuestion::kMostSettings)
      return refuse("settings", fmt::format("an object of at most {}", WhatIfQuestion::kMostSettings));
    for (const auto& [key, value] : settings->items()) {
      const auto as_text = text_of(value);
      if (!as_text) return refuse(printable(key), as_text.error().message);
      if (!decltype(telemetry::Change::name)::fits(key)) return refuse(printable(key), "a setting");
      question.options.settings.emplace_back(key, *as_text);
    }
  }
  return question;
}

WhatIf::WhatIf(Compute compute)
    : compute_{std::move(compute)},
      task_{[this](const Request& request, const std::function<bool()>& is_wanted) {
        return computed(request, is_wanted);
      }} {}

Result<std::string> WhatIf::ask(std::string_view json) {
  Result<WhatIfQuestion> question = read_question(json);
  if (!question) return fail(question.error());
  share_ = 0.0;
  answer_.clear();
  task_.begin({.number = ++newest_, .question = std::move(*question)});
  return fmt::format("{}", newest_);
}

std::string WhatIf::answer() {
  if (auto answer = task_.take()) answer_ = std::move(*answer);
  if (!answer_.empty()) return answer_ + "\n";
  return protocol::json_text({{"id", newest_}, {"state", "computing"}, {"share", rounded(share_)}}) + "\n";
}

std::string WhatIf::computed(const Request& request, const std::function<bool()>& is_wanted) {
  const WhatIfQuestion& question = request.question;
  Trace was, branch;
  recording::BranchHooks hooks;
  hooks.on_future = [&](const recording::FutureStep& step) { (step.is_branch ? branch : was).add(step); };
  std::optional<double> begin;
  hooks.go_on = [&](double time) {
    if (!begin) begin = time;
    const double way = std::max(0.0, std::min(question.options.at, time) - *begin);
    share_ = std::min(1.0, (time - *begin) / (way + question.options.duration));
    return is_wanted();
  };
  const Result<recording::BranchReport> report = compute_(question, hooks);
  Json answer{{"id", request.number},
              {"state", report ? "done" : "failed"},
              {"asked", {{"log", question.log}, {"settings", json_of(question.options.settings)}}}};
  if (!report) {
    answer["why"] = report.error().message;
    return protocol::json_text(answer);
  }
  answer["at_s"] = rounded(report->at);
  answer["cycle"] = report->cycle;
  answer["known_until_s"] = rounded(report->known_until);
  answer["is_exact"] = !report->first_difference;
  answer["end_reason"] = report->end_reason.empty() ? Json(nullptr) : Json(report->end_reason);
  if (const auto& stand_in = report->stand_in) {
    answer["stand_in"] = {{"plant", stand_in->plant},
                          {"compared_s", rounded(stand_in->compared)},
                          {"apart_m", rounded(stand_in->apart)}};
  }
  answer["was"] = json_of(report->recorded, was);
  answer["branch"] = json_of(report->branched, branch);
  return protocol::json_text(answer);
}

namespace {

constexpr auto kLook = std::chrono::milliseconds(5);  // period of reading the run's log; chosen

/// Whether a setting acts on the world, and so on both cars, rather than on the controller.
bool acts_on_both(std::string_view key) {
  return key.starts_with("fault.") || key.starts_with("plant_options.") || key.starts_with("sensor.") ||
         key == "latency_ms";
}

Json json_of(const std::vector<telemetry::CompletedLap>& laps) {
  Json all = Json::array();
  for (const telemetry::CompletedLap& each : laps) {
    const auto& [first, second, third] = each.sector_times;
    all.push_back({{"lap", each.lap},
                   {"lap_time_s", rounded(each.lap_time)},
                   {"sector_times_s", {rounded(first), rounded(second), rounded(third)}},
                   {"is_clean", each.is_clean},
                   {"mean_speed_mps", rounded(each.mean_speed)},
                   {"top_speed_mps", rounded(each.top_speed)}});
  }
  return all;
}

/// Scenario with `settings`. Fails for a setting that is unknown, fixed during a run, out of range, or acts
/// on the world.
Result<scenario::Scenario> with_settings(scenario::Scenario scenario,
                                         const std::vector<std::pair<std::string, std::string>>& settings) {
  for (const auto& [key, value] : settings) {
    const protocol::Parameter* row = protocol::find(key);
    if (row == nullptr || !protocol::is_live(*row) || acts_on_both(key)) {
      return fail(ErrorCode::kInvalidArgument, printable(key) + ": got " + printable(value) +
                                                   ", expected a setting of the controller or its car");
    }
    if (const Result<void> set = protocol::set_text(scenario, key, value); !set) return fail(set.error());
  }
  for (const protocol::Contradiction& found : protocol::contradictions(scenario))
    return fail(ErrorCode::kInvalidArgument, std::string(found.key) + ": " + found.message);
  scenario.laps = 0;  // the race lasts as long as the run
  return scenario;
}

}  // namespace

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
  json["settings"] = json_of(settings_);
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
  car_.emplace(run::RunHooks{.on_frame = [this](const telemetry::Frame&) { note(car_->loop()); },
                             .on_lap = [this](const telemetry::CompletedLap& lap) { keep(laps_, lap); }});
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

void Rival::catch_up() {
  const Result<RunLog::Excerpt> news = log_.since(place_);
  if (!news && is_racing()) return end("this computer could not keep up with both cars");
  if (!news) return;
  const RunLog::Place before = std::exchange(place_, news->end);
  if (before.scenario != 0 && before.scenario != place_.scenario)
    return end("the run began with other choices");
  if (news->begin != before) begin();
  if (!is_racing()) return;  // the race starts with the run's next start
  for (const RunLog::Event& event : *news->events) {
    std::visit([this](const auto& one) { take(one); }, event);
    if (!car_) return;
  }
}

void Rival::take(const RunLog::Step& step) {
  constexpr double kRounding = 1e-9;  // rounding of times [s]
  const run::ClosedLoop& loop = car_->loop();
  car_->drive([&] { return loop.time() >= step.time + kRounding; });
  if (loop.is_over()) end(loop.summary().end_reason);
}

void Rival::take(const RunLog::Change& change) {
  if (!acts_on_both(change.name)) return;
  if (const Result<run::Setting> setting = run::read_setting(change.as_recorded())) car_->apply(*setting);
}

void Rival::note(const run::ClosedLoop& loop) {
  const telemetry::Frame& frame = loop.frame();
  const model::State& car = frame.truth;
  const double speed = hypot(car.vx, car.vy);
  const std::lock_guard lock(mutex_);
  trace_.push_back({frame.time, car.x, car.y, car.psi, frame.applied.steer, speed, loop.world().progress});
  if (trace_.size() > kTrace) trace_.pop_front();
}

void Rival::begin() {
  car_->loop().restart();
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

void Rival::end(std::string why) {
  car_.reset();
  const std::lock_guard lock(mutex_);
  state_ = State::kEnded;
  why_ = std::move(why);
}

void Rival::keep(std::vector<telemetry::CompletedLap>& laps, const telemetry::CompletedLap& lap) const {
  const std::lock_guard lock(mutex_);
  laps.push_back(lap);
  if (laps.size() > kMostLaps) laps.erase(laps.begin());
}

}  // namespace chicane::live
