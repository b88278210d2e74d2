// SPDX-License-Identifier: MIT
#include "chicane/live/what_if.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "chicane/base/math.hpp"
#include "chicane/base/text.hpp"
#include "chicane/live/detail/columns.hpp"
#include "chicane/protocol/json.hpp"
#include "chicane/telemetry/change.hpp"
#include "chicane/telemetry/frame.hpp"

namespace chicane::live {
namespace {

using protocol::Json;

constexpr std::size_t kMostRows = 1500;  // of each trace

tl::unexpected<Error> refuse(std::string_view what, std::string_view expected) {
  return fail(ErrorCode::kInvalidArgument, fmt::format("what if: {}: expected {}", what, expected));
}

/// The rows of one future, as columns.
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
  [[nodiscard]] Json json() const {
    return columns(kNames, rows, std::max<std::size_t>(1, (rows.size() + kMostRows - 1) / kMostRows));
  }
};

Json json_of(const recording::Future& future, const Trace& trace) {
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
          {"trace", trace.json()}};
}

Json json_of(const WhatIfQuestion& question) {
  Json settings = Json::object();
  for (const auto& [key, value] : question.options.settings) settings[key] = value;
  return {{"log", question.log}, {"settings", std::move(settings)}};
}

/// A number in [least, most]; absent and null: `otherwise`.
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
  constexpr double kEver = 1e9;
  const auto at = number_of(json, "at_s", 0.0, kEver, kEver);
  if (!at) return fail(at.error());
  const auto duration = number_of(json, "for_s", 0.1, WhatIfQuestion::kLongest, WhatIfQuestion::kLongest);
  if (!duration) return fail(duration.error());
  const auto laps = number_of(json, "laps", 0.0, 10.0, 0.0);
  if (!laps) return fail(laps.error());
  const auto log = number_of(json, "log", 0.0, 1000.0, 0.0);
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
  Json answer{{"id", request.number}, {"state", report ? "done" : "failed"}, {"asked", json_of(question)}};
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

}  // namespace chicane::live
