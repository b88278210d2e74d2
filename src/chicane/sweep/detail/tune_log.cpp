// SPDX-License-Identifier: MIT
#include "chicane/sweep/detail/tune_log.hpp"

#include <fmt/format.h>

#include <limits>
#include <type_traits>
#include <utility>

#include "chicane/base/instruction_set.hpp"
#include "chicane/base/text.hpp"
#include "chicane/protocol/json.hpp"
#include "chicane/protocol/yaml_codec.hpp"

namespace chicane::sweep::detail {
namespace {

using protocol::Json;

Json json_of(const Settings& settings) {
  Json json = Json::object();
  for (const auto& [key, text] : settings) json[key] = text;
  return json;
}

std::string line_of(const Settings& values, const Verdict& verdict) {
  Json json{{"values", json_of(values)}};
  Verdict::rows(verdict, [&](const char* name, auto value) { json[name] = value; });
  return protocol::json_text(json);
}

std::pair<Settings, Verdict> read_line(const std::string& line) {
  const Json json = protocol::parse_json(line);
  std::pair<Settings, Verdict> read;
  for (const auto& [key, text] : json.at("values").items()) read.first.emplace_back(key, text);
  Verdict::rows(read.second, [&](const char* name, auto& value) {
    const Json& member = json.at(name);
    value = std::numeric_limits<std::remove_reference_t<decltype(value)>>::quiet_NaN();
    if (!member.is_null()) member.get_to(value);
  });
  return read;
}

}  // namespace

Result<TuneLog> TuneLog::open(const std::string& path, const std::string& head) {
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
      log.verdicts_.insert(read_line(line));
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

const Verdict* TuneLog::find(const Settings& values) const {
  const auto found = verdicts_.find(values);
  return found == verdicts_.end() ? nullptr : &found->second;
}

Result<void> TuneLog::add(const Settings& values, const Verdict& verdict) {
  verdicts_[values] = verdict;
  return file_.append(line_of(values, verdict));
}

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
