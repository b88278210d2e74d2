// SPDX-License-Identifier: MIT
// Claims: reads the statements of a write-up with cases and conditions, and evaluates them on results.
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
#include "chicane/protocol/yaml_tree.hpp"
#include "chicane/sweep/plan_codec.hpp"
#include "chicane/sweep/trial.hpp"
#include "chicane/telemetry/metrics.hpp"

namespace chicane::sweep {
namespace {

using protocol::YamlEntry;
using protocol::YamlNode;

/// Name of a column, and the index of an entry of its list: "lap_times_s[-1]". Negative: counted from the
/// end.
struct ColumnPlace {
  std::string name;
  std::optional<int> index;
};

ColumnPlace column_place(std::string_view text) {
  const std::size_t open = text.find('[');
  if (open == std::string_view::npos || !text.ends_with(']')) return {std::string(text), std::nullopt};
  const auto index = number_in(text.substr(open + 1, text.size() - open - 2));
  return {std::string(text.substr(0, open)), index ? std::optional(static_cast<int>(*index)) : std::nullopt};
}

/// Whether a condition may name the column.
bool is_column(std::string_view text) {
  return text == "clean" || find_column(column_place(text).name) != nullptr;
}

/// Name that stands for every other clean case, on the right of a comparison.
constexpr std::string_view kEach = "each";

/// One side of a condition: a number or CASE.column; none for other texts.
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

/// Condition of its text; none for a text of another form.
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

/// Reader of the claims of one file; collects its faults.
class ClaimReader : private detail::SettingsReader {
 public:
  ClaimReader(const std::string& file, std::string_view quotations) : SettingsReader{file}, file_{file} {
    std::istringstream lines{std::string(quotations)};
    for (std::string line; std::getline(lines, line);)
      if (!line.starts_with('#')) quotations_ += line + '\n';
  }

  Result<std::vector<Claim>> read(const YamlNode& root) {
    Claim shared;
    std::vector<const YamlNode*> claims;
    read_map(root, "file", "a map with settings and claims",
             {{"settings", settings(shared.settings)},
              {"ours", text(shared.ours)},
              {"claims", list("claims", [&](const YamlNode& node) { claims.push_back(&node); })}});
    for (const YamlNode* node : claims) read_claim(*node, shared);
    return is_faultless() ? Result<std::vector<Claim>>(std::move(claims_)) : fail(error());
  }

 private:
  /// Adds the points of a grid as cases: {horizon_steps: [7, 20], step_length_s: [0.1, 0.2]} makes four, from
  /// "7/0.1" to "20/0.2".
  void read_grid(const YamlEntry& grid, Claim& claim) {
    std::vector<Case> points{{}};
    for (const YamlEntry& entry : named(grid)) {
      std::vector<std::string> texts;
      values(entry.key.text, texts)(entry);
      if (texts.empty() && is_faultless()) refuse(entry, "values");
      std::vector<Case> finer;
      for (const Case& point : points) {
        for (const std::string& text : texts) {
          Case next = point;
          next.name += (next.name.empty() ? "" : "/") + text;
          next.settings.emplace_back(entry.key.text, text);
          finer.push_back(std::move(next));
        }
      }
      points = std::move(finer);
    }
    claim.grid_size = points.size();
    claim.cases.insert(claim.cases.end(), points.begin(), points.end());
  }

  /// Adds named cases.
  void read_cases(const YamlEntry& entry, Claim& claim) {
    for (const YamlEntry& each : named(entry))
      read_settings(each.value, claim.cases.emplace_back(Case{.name = each.key.text}).settings);
  }

  /// Adds one column to show.
  void read_column(const YamlNode& node, Claim& claim) {
    if (!is_column(node.text)) refuse(node, "shows", "a column");
    claim.shows.push_back(node.text);
  }

  /// Adds a fault if a quotation is too long, or is not among the fragments of the write-up.
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

  /// Adds one claim; `shared`: settings and words of all claims of the file.
  void read_claim(const YamlNode& node, const Claim& shared) {
    Claim claim = shared;
    std::vector<const YamlNode*> conditions;
    read_map(node, "claims", "a map with id and says",
             {{"id", text(claim.id)},
              {"says", text(claim.says)},
              {"quotes",
               [&](const YamlEntry& entry) {
                 claim.quotes = entry.value.text;
                 check_quotation(entry.value.line, claim.quotes);
               }},
              {"settings", settings(claim.settings)},
              {"cases", [&](const YamlEntry& entry) { read_cases(entry, claim); }},
              {"grid", [&](const YamlEntry& entry) { read_grid(entry, claim); }},
              {"true_when", list("conditions", [&](const YamlNode& each) { conditions.push_back(&each); })},
              {"shows", list("columns", [&](const YamlNode& column) { read_column(column, claim); })},
              {"found", text(claim.found)},
              {"see", text(claim.see)}});
    for (const YamlNode* each : conditions) {
      const auto condition = condition_in(each->text, claim.cases);
      if (condition) claim.conditions.push_back(*condition);
      if (!condition) refuse(*each, "true_when", "CASE.column > CASE.column * 1.02, or a number");
    }
    if (claim.id.empty() || claim.says.empty() || !ids_.insert(claim.id).second)
      fault(node.line, "id", "expected an id of its own, and what is said");
    if (claim.is_tried() == claim.conditions.empty() || claim.is_tried() != claim.found.empty())
      fault(node.line, claim.id, "expected either cases and true_when, or found");
    claims_.push_back(std::move(claim));
  }

  const std::string& file_;
  std::string quotations_;  ///< fragments of the write-up, one a line
  std::vector<Claim> claims_;
  std::set<std::string> ids_;
};

/// Whether the run of a line drove all laps and no tyre left the road.
bool is_clean(const protocol::Json& line) { return number_of(line, "clean") > 0.0; }

/// Number of one side of a condition; NaN if it was not measured.
double value_of(const Condition::Value& value, const CaseResults& results) {
  if (value.name.empty()) return value.constant;
  const auto found = results.find(value.name);
  return found == results.end() ? telemetry::kNotMeasured : number_of(found->second, value.column);
}

}  // namespace

double number_of(const protocol::Json& line, std::string_view column) {
  if (!line.is_object()) return telemetry::kNotMeasured;
  if (column == "clean")
    return line.value("completed", false) && line.value("off_track_events", 1) == 0 ? 1.0 : 0.0;
  const ColumnPlace at = column_place(column);
  const auto found = line.find(at.name);
  if (found == line.end()) return telemetry::kNotMeasured;
  const int size = found->is_array() ? static_cast<int>(found->size()) : 0;
  const int index = at.index ? (*at.index < 0 ? size + *at.index : *at.index) : 0;
  if (at.index && (index < 0 || index >= size)) return telemetry::kNotMeasured;
  const protocol::Json& value = at.index ? (*found)[static_cast<std::size_t>(index)] : *found;
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
