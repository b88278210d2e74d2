// SPDX-License-Identifier: MIT
#include "chicane/sweep/claim.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <optional>
#include <set>
#include <sstream>

#include "chicane/base/text.hpp"
#include "chicane/protocol/json.hpp"
#include "chicane/protocol/yaml_tree.hpp"
#include "chicane/sweep/detail/settings_reader.hpp"
#include "chicane/sweep/outcome.hpp"
#include "chicane/sweep/trial.hpp"
#include "chicane/telemetry/metrics.hpp"

namespace chicane::sweep {
namespace {

using protocol::YamlEntry;
using protocol::YamlNode;

/// "lap_times_s[-1]" into name and place.
struct ColumnPlace {
  std::string name;
  std::optional<int> place;
};
ColumnPlace place_in(std::string_view text) {
  const std::size_t open = text.find('[');
  if (open == std::string_view::npos || !text.ends_with(']')) return {std::string(text), std::nullopt};
  const auto place = number_in(text.substr(open + 1, text.size() - open - 2));
  return {std::string(text.substr(0, open)), place ? std::optional(static_cast<int>(*place)) : std::nullopt};
}

bool is_column(std::string_view text) {
  return text == "clean" || find_column(place_in(text).name) != nullptr;
}

/// Stands for every other clean case on the right of a comparison.
constexpr std::string_view kEach = "each";

std::optional<Condition::Value> value_in(const std::string& text, const std::vector<Case>& cases) {
  if (const auto number = number_in(text)) return Condition::Value{.constant = *number};
  const std::size_t dot = text.find('.');
  if (dot == std::string::npos) return std::nullopt;
  Condition::Value value{.name = text.substr(0, dot), .column = text.substr(dot + 1)};
  const bool is_known = value.name == kEach || std::any_of(cases.begin(), cases.end(), [&](const Case& each) {
                          return each.name == value.name;
                        });
  if (!is_known || !is_column(value.column)) return std::nullopt;
  return value;
}

std::optional<Condition> condition_in(const std::string& text, const std::vector<Case>& cases) {
  std::istringstream words(text);
  std::string left, comparison, right, sign, amount, more;
  words >> left >> comparison >> right >> sign >> amount >> more;
  Condition condition{.text = text};
  const auto a = value_in(left, cases);
  const auto b = value_in(right, cases);
  if (!a || !b || a->name.empty() || a->name == kEach || comparison.size() != 1 || !more.empty())
    return std::nullopt;
  condition.left = *a;
  condition.right = *b;
  condition.comparison = comparison[0];
  if (std::string_view("<>=").find(condition.comparison) == std::string_view::npos) return std::nullopt;
  if (sign.empty()) return condition;
  const auto number = number_in(amount);
  if (!number || (sign != "*" && sign != "+")) return std::nullopt;
  (sign == "*" ? condition.factor : condition.term) = *number;
  return condition;
}

class ClaimReader : private detail::SettingsReader {
 public:
  ClaimReader(const std::string& file, std::string_view quotations) : SettingsReader{file}, file_{file} {
    std::istringstream lines{std::string(quotations)};
    for (std::string line; std::getline(lines, line);)
      if (!line.starts_with('#')) quotations_ += line + '\n';
  }

  Result<std::vector<Claim>> read(const YamlNode& root) {
    if (!root.is_map()) fault(1, "file", "expected a map with settings and claims");
    Claim shared;
    for (const YamlEntry& entry : root.entries()) {
      if (entry.key.text == "settings") shared.settings = settings_of(entry.value);
      if (entry.key.text == "ours") shared.ours = entry.value.text;
    }
    for (const YamlEntry& entry : root.entries()) {
      if (entry.key.text == "settings" || entry.key.text == "ours") continue;
      if (entry.key.text != "claims" || !entry.value.is_list()) {
        fault(entry.key.line, printable(entry.key.text), "expected settings, ours, or a list of claims");
        continue;
      }
      for (const YamlNode* node : entry.value.children) read_claim(*node, shared);
    }
    return is_faultless() ? Result<std::vector<Claim>>(std::move(claims_)) : fail(error());
  }

 private:
  Settings settings_of(const YamlNode& map) {
    Settings settings;
    read_settings(map, settings);
    return settings;
  }

  /// `{horizon_steps: [7, 20], step_length_s: [0.1, 0.2]}` as four cases, "7/0.1" to "20/0.2".
  std::vector<Case> grid_of(const YamlNode& map) {
    std::vector<Case> points{{}};
    for (const YamlEntry& entry : map.entries()) {
      if (!entry.value.is_list() || entry.value.children.empty()) {
        fault(entry.key.line, printable(entry.key.text), "expected a list of values");
        continue;
      }
      std::vector<Case> finer;
      for (const Case& point : points) {
        for (const YamlNode* value : entry.value.children) {
          static_cast<void>(takes(entry.key.text, *value));
          Case next = point;
          next.name += (next.name.empty() ? "" : "/") + value->text;
          next.settings.emplace_back(entry.key.text, value->text);
          finer.push_back(std::move(next));
        }
      }
      points = std::move(finer);
    }
    return points;
  }

  void check_quotation(int line, const std::string& quotation) {
    std::istringstream words(quotation);
    const auto count = std::distance(std::istream_iterator<std::string>(words), {});
    if (count == 0 || count > static_cast<std::ptrdiff_t>(kMostQuotedWords))
      fault(line, "quotes", fmt::format("got {} words, expected 1 to {}", count, kMostQuotedWords));
    else if (quotations_.find(quotation) == std::string::npos)
      fault(line, "quotes",
            fmt::format("got {}, expected words of a line of {}", printable(quotation),
                        quotations_file(file_)));
  }

  void read_claim(const YamlNode& node, const Claim& shared) {
    if (!node.is_map()) return fault(node.line, "claims", "expected a map with id and says");
    Claim claim = shared;
    std::vector<const YamlNode*> conditions;
    for (const YamlEntry& entry : node.entries()) {
      const std::string& key = entry.key.text;
      const YamlNode& value = entry.value;
      if (key == "quotes") check_quotation(value.line, value.text);
      if (key == "id" || key == "says" || key == "quotes" || key == "found" || key == "see") {
        (key == "id"       ? claim.id
         : key == "says"   ? claim.says
         : key == "quotes" ? claim.quotes
         : key == "found"  ? claim.found
                           : claim.see) = value.text;
      } else if (key == "settings") {
        for (auto& setting : settings_of(value)) claim.settings.push_back(std::move(setting));
      } else if (key == "cases" && value.is_map()) {
        for (const YamlEntry& each : value.entries())
          claim.cases.push_back({each.key.text, settings_of(each.value)});
      } else if (key == "grid" && value.is_map()) {
        const std::vector<Case> points = grid_of(value);
        claim.grid_size = points.size();
        claim.cases.insert(claim.cases.end(), points.begin(), points.end());
      } else if (key == "true_when" && value.is_list()) {
        conditions = value.children;
      } else if (key == "shows" && value.is_list()) {
        for (const YamlNode* column : value.children) {
          if (!is_column(column->text))
            fault(column->line, "shows", fmt::format("got {}, expected a column", printable(column->text)));
          claim.shows.push_back(column->text);
        }
      } else {
        fault(entry.key.line, printable(key),
              "expected id, says, quotes, settings, cases, grid (behind cases), true_when, shows, found or "
              "see");
      }
    }
    for (const YamlNode* each : conditions) {
      const auto condition = condition_in(each->text, claim.cases);
      if (condition) claim.conditions.push_back(*condition);
      if (!condition)
        fault(each->line, "true_when",
              fmt::format("got {}, expected CASE.column > CASE.column * 1.02, or a number",
                          printable(each->text)));
    }
    if (claim.id.empty() || claim.says.empty() || !ids_.insert(claim.id).second)
      fault(node.line, "id", "expected an id of its own, and what is said");
    if (claim.is_tried() == claim.conditions.empty() || claim.is_tried() != claim.found.empty())
      fault(node.line, claim.id, "expected either cases and true_when, or found");
    claims_.push_back(std::move(claim));
  }

  const std::string& file_;
  std::string quotations_;  // without its comments
  std::vector<Claim> claims_;
  std::set<std::string> ids_;
};

bool is_clean(std::string_view line) { return number_of(line, "clean") > 0.0; }

double value_of(const Condition::Value& value, const CaseResults& results) {
  if (value.name.empty()) return value.constant;
  const auto found = results.find(value.name);
  return found == results.end() ? telemetry::kNotMeasured : number_of(found->second, value.column);
}

}  // namespace

double number_of(std::string_view text, std::string_view column) {
  const protocol::Json line = protocol::parse_json(text);
  if (!line.is_object()) return telemetry::kNotMeasured;
  if (column == "clean")
    return line.value("completed", false) && line.value("off_track_events", 1) == 0 ? 1.0 : 0.0;
  const ColumnPlace at = place_in(column);
  const auto found = line.find(at.name);
  if (found == line.end()) return telemetry::kNotMeasured;
  const int size = found->is_array() ? static_cast<int>(found->size()) : 0;
  const int place = at.place ? (*at.place < 0 ? size + *at.place : *at.place) : 0;
  if (at.place && (place < 0 || place >= size)) return telemetry::kNotMeasured;
  const protocol::Json& value = at.place ? (*found)[static_cast<std::size_t>(place)] : *found;
  if (value.is_boolean()) return value.get<bool>() ? 1.0 : 0.0;
  return value.is_number() ? value.get<double>() : telemetry::kNotMeasured;
}

bool holds(const Claim& claim, const CaseResults& results) {
  return std::all_of(claim.conditions.begin(), claim.conditions.end(), [&](const Condition& condition) {
    const auto compare = [&](double other) {
      const double left = value_of(condition.left, results);
      const double right = other * condition.factor + condition.term;
      if (std::isnan(left) || std::isnan(right)) return false;
      return condition.comparison == '>'   ? left > right
             : condition.comparison == '<' ? left < right
                                           : left == right;
    };
    if (condition.right.name != kEach) return compare(value_of(condition.right, results));
    return std::all_of(results.begin(), results.end(), [&](const auto& other) {
      const bool counts = other.first != condition.left.name && is_clean(other.second);
      return !counts || compare(number_of(other.second, condition.right.column));
    });
  });
}

Result<std::vector<Claim>> parse_claims(std::string_view text, const std::string& file,
                                        std::string_view quotations) {
  const Result<protocol::YamlTree> tree = protocol::parse_yaml(text, file);
  return tree ? ClaimReader(file, quotations).read(*tree->root) : fail(tree.error());
}

std::string quotations_file(const std::string& file) {
  const std::filesystem::path path(file);
  return (path.parent_path() / "quotations" / path.stem()).string() + ".txt";
}

}  // namespace chicane::sweep
