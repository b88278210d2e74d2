// SPDX-License-Identifier: MIT
#include "chicane/sweep/detail/tune_log.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include "chicane/base/file.hpp"
#include "chicane/base/instruction_set.hpp"
#include "chicane/base/text.hpp"
#include "chicane/protocol/json.hpp"
#include "chicane/protocol/yaml_codec.hpp"
#include "chicane/sweep/result_file.hpp"

namespace chicane::sweep::detail {
namespace {

using protocol::Json;

Json json_of(const Settings& settings) {
  Json json = Json::object();
  for (const auto& [key, text] : settings) json[key] = text;
  return json;
}

std::string line_of(const Settings& values, const Verdict& verdict) {
  const Json json{{"values", json_of(values)},
                  {"lap_time_s", std::isfinite(verdict.lap_time) ? Json(verdict.lap_time) : Json()},
                  {"margin_m", verdict.margin},
                  {"steering_rate_radps", verdict.steering_rate},
                  {"progress", verdict.progress},
                  {"off_track_events", verdict.off_track_events},
                  {"unfinished", verdict.unfinished},
                  {"driven", verdict.driven},
                  {"passed", verdict.passed}};
  return protocol::json_text(json);
}

std::pair<Settings, Verdict> read_line(const std::string& line) {
  const Json json = protocol::parse_json(line);
  Settings values;
  for (const auto& [key, text] : json.at("values").items()) values.emplace_back(key, text);
  const Json& lap = json.at("lap_time_s");
  return {std::move(values),
          Verdict{.lap_time = lap.is_null() ? std::numeric_limits<double>::quiet_NaN() : lap.get<double>(),
                  .margin = json.at("margin_m"),
                  .steering_rate = json.at("steering_rate_radps"),
                  .progress = json.at("progress"),
                  .off_track_events = json.at("off_track_events"),
                  .unfinished = json.at("unfinished"),
                  .driven = json.at("driven"),
                  .passed = json.at("passed")}};
}

}  // namespace

Result<TuneLog> TuneLog::open(const std::string& path, const std::string& head) {
  TuneLog log(path);
  if (path.empty()) return log;
  if (!std::filesystem::exists(path)) {
    if (const Result<void> written = log.append(head); !written) return fail(written.error());
    return log;
  }
  std::ifstream stream(path, std::ios::binary);
  std::string line;
  std::uintmax_t whole = 0;  // [byte]
  for (int number = 1; std::getline(stream, line) && !stream.eof(); ++number) {
    whole += line.size() + 1;
    if (number == 1 && line != head) {
      return fail(ErrorCode::kInvalidArgument,
                  fmt::format("{}: got the log of another search or program, expected one of this; "
                              "--log names another file",
                              path));
    }
    if (number == 1) continue;
    try {
      log.verdicts_.insert(read_line(line));
    } catch (const Json::exception&) {
      return fail(refusal(fmt::format("{}:{}", path, number), line, "an evaluation", ErrorCode::kParse));
    }
  }
  stream.close();
  std::error_code error;
  std::filesystem::resize_file(path, whole, error);  // half a line, which a killed process has left
  if (error) return fail(ErrorCode::kIo, fmt::format("{}: {}", path, error.message()));
  if (whole > 0) return log;
  if (const Result<void> written = log.append(head); !written) return fail(written.error());
  return log;
}

const Verdict* TuneLog::find(const Settings& values) const {
  const auto found = verdicts_.find(values);
  return found == verdicts_.end() ? nullptr : &found->second;
}

Result<void> TuneLog::add(const Settings& values, const Verdict& verdict) {
  verdicts_[values] = verdict;
  return path_.empty() ? Result<void>{} : append(line_of(values, verdict));
}

Result<void> TuneLog::append(const std::string& line) const { return append_to_file(path_, line + '\n'); }

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

}  // namespace chicane::sweep::detail
