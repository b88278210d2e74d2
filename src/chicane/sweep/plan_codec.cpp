// SPDX-License-Identifier: MIT
// Reader of plans: the grammar of docs/sweep.md, with a fault for each line that breaks it.
#include "chicane/sweep/plan_codec.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "chicane/base/text.hpp"
#include "chicane/protocol/schema.hpp"
#include "chicane/sweep/trial.hpp"

namespace chicane::sweep::detail {
namespace {

constexpr double kMostCount = 4294967295.0;  // largest 32-bit number: index of a point of a sample
constexpr double kLeastFactor = 1.01;        // least factor of a search: bounds its trials; chosen
constexpr double kLeastWithin = 1e-4;        // finest accuracy of a search; chosen

}  // namespace

void SettingsReader::read_settings(const protocol::YamlNode& map, Settings& settings,
                                   const std::string& prefix) {
  if (!map.is_map()) return refuse(map, prefix.empty() ? "settings" : prefix, "a map of settings");
  for (const protocol::YamlEntry& entry : map.entries()) {
    const std::string key = prefix.empty() ? entry.key.text : fmt::format("{}.{}", prefix, entry.key.text);
    if (entry.value.is_map()) {
      read_settings(entry.value, settings, key);
    } else if (takes(key, entry.value)) {
      settings.emplace_back(key, entry.value.text);
    }
  }
}

bool SettingsReader::takes(const std::string& key, const protocol::YamlNode& node) {
  if (!node.is_scalar()) {
    refuse(node, key, "one value");
    return false;
  }
  const Result<void> checked = check_setting(key, node.text);
  if (!checked) fault(node.line, checked.error());
  return checked.has_value();
}

std::vector<protocol::YamlEntry> SettingsReader::named(const protocol::YamlEntry& entry) {
  std::vector<protocol::YamlEntry> entries = entry.value.entries();
  if (!entry.value.is_map() || entries.size() > kMostNames) {
    refuse(entry, fmt::format("a map of at most {} names", kMostNames));
    return {};
  }
  std::set<std::string_view> names;
  for (const protocol::YamlEntry& each : entries)
    if (!names.insert(each.key.text).second)
      fault(each.key.line, printable(each.key.text), "got it a second time, expected it once");
  return entries;
}

SettingsReader::Take SettingsReader::count(std::uint64_t& to, std::uint64_t least) {
  return [this, &to, least](const protocol::YamlEntry& entry) {
    const auto number = number_in(entry.value.text);
    if (!number || *number < static_cast<double>(least) || *number > kMostCount ||
        *number != std::floor(*number))
      return refuse(entry, fmt::format("an integer from {} on", least));
    to = static_cast<std::uint64_t>(*number);
  };
}

SettingsReader::Take SettingsReader::settings(Settings& to) {
  return [this, &to](const protocol::YamlEntry& entry) { read_settings(entry.value, to); };
}

SettingsReader::Take SettingsReader::values(const std::string& key, std::vector<std::string>& to) {
  return list("values", [this, key, &to](const protocol::YamlNode& node) {
    if (takes(key, node)) to.push_back(node.text);
  });
}

SettingsReader::Take SettingsReader::search(std::optional<Search>& to) {
  return [this, &to](const protocol::YamlEntry& entry) { to = read_search(entry.value); };
}

std::optional<Search> SettingsReader::read_search(const protocol::YamlNode& map) {
  constexpr std::string_view kExpected = "{a key: {from: a number above zero, to: a larger one}}";
  if (!map.is_map() || map.entries().size() != 1) {
    refuse(map, "search", kExpected);
    return std::nullopt;
  }
  const protocol::YamlEntry range = map.entries().front();
  Search search{.key = range.key.text};
  const auto bound = [&](double& to) -> Take {
    return [this, &search, take = number(to)](const protocol::YamlEntry& entry) {
      if (takes(search.key, entry.value)) take(entry);
    };
  };
  const bool is_read = read_map(range.value, "search", kExpected,
                                {{"from", bound(search.from)},
                                 {"to", bound(search.to)},
                                 {"factor", number(search.factor)},
                                 {"within", number(search.within)}});
  if (!is_read) return std::nullopt;
  if (search.from > 0.0 && search.to >= search.from && search.factor >= kLeastFactor &&
      search.within >= kLeastWithin)
    return search;
  fault(map.line, "search",
        fmt::format("expected {}, factor from {} and within from {} on", kExpected, kLeastFactor,
                    kLeastWithin));
  return std::nullopt;
}

}  // namespace chicane::sweep::detail

namespace chicane::sweep {
namespace {

using protocol::YamlEntry;
using protocol::YamlNode;

constexpr std::size_t kMostAxes = 20;           // bounds memory and time; chosen
constexpr std::string_view kFolder = "/*.csv";  // end of a value that stands for all tracks of a folder

/// Reader of one plan; collects the faults of the file.
class PlanReader : private detail::SettingsReader {
 public:
  using SettingsReader::SettingsReader;

  Result<Plan> read(const YamlNode& root) {
    std::string about;
    const auto axis = [this](const YamlNode& node) { read_axis(node); };
    read_map(root, "file", "a plan with settings and axes",
             {{"name", text(plan_.name)},
              {"about", text(about)},
              {"settings", settings(plan_.fixed)},
              {"axes", list("axes", axis, kMostAxes)},
              {"search", search(plan_.search)},
              {"marks", list("places", [this](const YamlNode& node) { read_mark(node); })},
              {"keep", list("columns", [this](const YamlNode& node) { read_column(node); })}});
    check_size(root.line);
    check_marks();
    if (is_faultless()) return std::move(plan_);
    return fail(error());
  }

 private:
  /// One axis: `sample`, if it has one, before its keys.
  void read_axis(const YamlNode& map) {
    if (!map.is_map()) return refuse(map, "axes", "{key: [values]}");
    Axis axis;
    for (const YamlEntry& entry : map.entries()) {
      if (entry.key.text == "sample") read_sample(entry.value, axis);
    }
    const bool is_sample = axis.kind != Axis::Kind::kTogether;
    std::optional<std::uint64_t> size;
    if (is_sample) size = axis.size;
    for (const YamlEntry& entry : map.entries()) {
      if (entry.key.text == "sample") continue;
      if (!keys_.insert(entry.key.text).second) {
        fault(entry.key.line, printable(entry.key.text), "got it in two axes, expected it in one");
        continue;
      }
      const std::optional<std::uint64_t> length = read_dimension(entry, axis);
      if (!length || is_sample) continue;
      if (size && *size != *length)
        fault(entry.key.line, entry.key.text,
              fmt::format("got {} values, expected {} as the other keys of this axis", *length, *size));
      size = length;
    }
    axis.size = size.value_or(0);
    if (is_sample && axis.dimensions.size() > static_cast<std::size_t>(kSobolDimensions))
      fault(map.line, "axes",
            fmt::format("got {} keys, expected at most {} in a sample", axis.dimensions.size(),
                        kSobolDimensions));
    if (axis.dimensions.empty() && is_faultless())
      fault(map.line, "axes", "got an axis without keys, expected one");
    plan_.axes.push_back(std::move(axis));
  }

  /// Method, number of points and seed of a sample.
  void read_sample(const YamlNode& map, Axis& axis) {
    std::string method;
    const bool is_read = read_map(map, "sample", "{method: sobol, count: 64, seed: 1}",
                                  {{"method", choice(method, {"sobol", "latin-hypercube"})},
                                   {"count", count(axis.size, 1)},
                                   {"seed", count(axis.seed, 0)}});
    axis.kind = method == "latin-hypercube" ? Axis::Kind::kLatinHypercube : Axis::Kind::kSobol;
    if (is_read && axis.size == 0) fault(map.line, "sample.count", "got none, expected the number of points");
  }

  /// Adds one key with its values to the axis. Returns the number of values; none for a range in a sample, or
  /// after a fault.
  std::optional<std::uint64_t> read_dimension(const YamlEntry& entry, Axis& axis) {
    Dimension dimension{.key = entry.key.text};
    std::optional<std::uint64_t> length;
    if (is_cases(entry.value)) {
      length = read_cases(entry, dimension);
    } else if (entry.value.is_map()) {
      length = read_range(entry.value, axis, dimension);
    } else {
      if (entry.value.is_list()) {
        for (const YamlNode* node : entry.value.children) {
          if (!takes(dimension.key, *node)) continue;
          if (dimension.key == "track" && node->text.ends_with(kFolder)) {
            add_folder(*node, dimension.list);
          } else {
            dimension.list.push_back(node->text);
          }
        }
      } else if (takes(dimension.key, entry.value)) {
        dimension.list.push_back(entry.value.text);
      }
      if (dimension.list.empty() && is_faultless())
        fault(entry.key.line, printable(dimension.key), "got no values, expected some");
      length = dimension.list.size();
    }
    axis.dimensions.push_back(std::move(dimension));
    return length;
  }

  /// Adds all tracks of `FOLDER/*.csv`, sorted by name.
  void add_folder(const YamlNode& node, std::vector<std::string>& list) {
    const std::string folder = node.text.substr(0, node.text.size() - kFolder.size());
    std::vector<std::string> files;
    std::error_code error;
    for (std::filesystem::directory_iterator each(folder, error), end; !error && each != end;
         each.increment(error))
      if (each->path().extension() == ".csv") files.push_back(each->path().string());
    if (files.empty()) refuse(node, "track", "tracks there");
    std::sort(files.begin(), files.end());
    list.insert(list.end(), files.begin(), files.end());
  }

  /// Whether the values of a key are named cases: `{cases: {name: {settings}, …}}`.
  static bool is_cases(const YamlNode& node) {
    return node.is_map() && node.entries().size() == 1 && node.entries().front().key.text == "cases";
  }
  /// Named cases and their settings. Returns their number.
  std::uint64_t read_cases(const YamlEntry& entry, Dimension& dimension) {
    const YamlEntry cases = entry.value.entries().front();
    if (check_setting(dimension.key, "1") || protocol::find(dimension.key) != nullptr)
      fault(entry.key.line, printable(dimension.key), "got a setting, expected a name of your own for cases");
    for (const YamlEntry& each : named(cases)) {
      dimension.list.push_back(each.key.text);
      read_settings(each.value, dimension.cases.emplace_back());
    }
    if (dimension.list.empty() && is_faultless()) refuse(cases.value, "cases", "{name: {settings}}");
    return dimension.list.size();
  }

  /// Range with `count` values or a `step`. Returns the number of values; none in a sample, which has its
  /// own, or after a fault.
  std::optional<std::uint64_t> read_range(const YamlNode& map, const Axis& axis, Dimension& dimension) {
    std::optional<double> from, to;
    double step = 0.0;
    std::uint64_t count = 0;
    std::string scale;
    const auto bound = [&](std::optional<double>& end) -> Take {
      return [&](const YamlEntry& entry) {
        if (takes(dimension.key, entry.value)) end = number_in(entry.value.text);
      };
    };
    read_map(map, dimension.key, "a range",
             {{"from", bound(from)},
              {"to", bound(to)},
              {"step", number(step)},
              {"count", this->count(count, 1)},
              {"scale", choice(scale, {"linear", "log"})}});
    dimension.is_logarithmic = scale == "log";
    const protocol::Parameter* row = protocol::find(dimension.key);
    dimension.is_integer = row != nullptr && row->option.kind == protocol::Kind::kInteger;
    if (!from || !to || *to < *from || (dimension.is_logarithmic && *from <= 0.0)) {
      fault(map.line, printable(dimension.key),
            "expected {from: a number, to: a larger one}, both positive where the scale is log");
      return std::nullopt;
    }
    dimension.from = *from;
    dimension.to = *to;
    if (axis.kind != Axis::Kind::kTogether) return std::nullopt;
    if (count == 0 && step == 0.0 && dimension.is_integer) step = 1.0;
    if (step < 0.0 || (count == 0) == (step == 0.0)) {
      fault(map.line, printable(dimension.key), "expected either count or step > 0");
      return std::nullopt;
    }
    if (count > 0) return count;
    const double steps = std::floor((*to - *from) / step + 1e-9);  // 1e-9: rounding of a range of whole steps
    if (!(steps < detail::kMostCount)) {
      fault(map.line, printable(dimension.key), "expected fewer steps");
      return std::nullopt;
    }
    dimension.to = *from + steps * step;
    return static_cast<std::uint64_t>(steps) + 1;
  }

  /// One marked point of the maps.
  void read_mark(const YamlNode& node) {
    if (!node.is_map()) return refuse(node, "marks", "a place");
    Settings& mark = plan_.marks.emplace_back();
    for (const YamlEntry& entry : node.entries()) {
      mark.emplace_back(entry.key.text, entry.value.text);
      marked_.emplace_back(entry.key.line, entry.key.text);
    }
  }

  /// Adds a fault for each key of a mark that no axis has.
  void check_marks() {
    for (const auto& [line, key] : marked_)
      if (!keys_.contains(key))
        fault(line, printable(key), "got no key of an axis, expected marks at values of axes");
  }

  /// One column to keep.
  void read_column(const YamlNode& node) {
    plan_.keep.push_back(node.text);
    if (find_column(node.text) != nullptr) return;
    std::vector<std::string_view> names;
    for (const Column& column : columns()) names.push_back(column.name);
    refuse(node, "keep", fmt::format("one of {}", joined(names)));
  }

  /// Adds a fault if the plan has too many runs.
  void check_size(int line) {
    double size = 1.0;
    for (const Axis& axis : plan_.axes) size *= static_cast<double>(axis.size);
    if (is_faultless() && size > static_cast<double>(Plan::kMostRuns))
      fault(
          line, "axes",
          fmt::format("got {:.3g} runs, expected at most {:g}", size, static_cast<double>(Plan::kMostRuns)));
  }

  Plan plan_;                                        ///< as far as it is read
  std::set<std::string> keys_;                       ///< keys of all axes
  std::vector<std::pair<int, std::string>> marked_;  ///< keys of the marks, with their lines
};

}  // namespace

Result<Plan> parse_plan(std::string_view text, const std::string& file) {
  const Result<protocol::YamlTree> tree = protocol::parse_yaml(text, file);
  if (!tree) return fail(tree.error());
  Result<Plan> plan = PlanReader(file).read(*tree->root);
  if (plan && plan->name.empty()) plan->name = std::filesystem::path(file).stem().string();
  return plan;
}

Result<Plan> read_plan(const std::string& file) {
  const Result<std::string> text = protocol::read_file(file);
  return text ? parse_plan(*text, file) : fail(text.error());
}

}  // namespace chicane::sweep
