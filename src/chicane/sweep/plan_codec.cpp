// SPDX-License-Identifier: MIT
#include "chicane/sweep/plan_codec.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <set>

#include "chicane/base/text.hpp"
#include "chicane/protocol/schema.hpp"
#include "chicane/protocol/yaml_codec.hpp"
#include "chicane/protocol/yaml_tree.hpp"
#include "chicane/sweep/detail/settings_reader.hpp"
#include "chicane/sweep/outcome.hpp"
#include "chicane/sweep/sampling.hpp"
#include "chicane/sweep/trial.hpp"

namespace chicane::sweep {
namespace {

using protocol::YamlEntry;
using protocol::YamlNode;

using detail::shown;

constexpr std::size_t kMostAxes = 20;
constexpr std::string_view kFolder = "/*.csv";  ///< after a folder: all tracks in it
constexpr double kMostSamples = 4294967295.0;

class PlanReader : private detail::SettingsReader {
 public:
  using SettingsReader::SettingsReader;

  Result<Plan> read(const YamlNode& root) {
    if (!root.is_map()) {
      fault(1, "file", fmt::format("got {}, expected a plan with settings and axes", shown(root)));
    } else {
      for (const YamlEntry& entry : root.entries()) read_part(entry);
    }
    check_size(root.line);
    check_marks();
    if (is_faultless()) return std::move(plan_);
    return fail(error());
  }

 private:
  void read_part(const YamlEntry& entry) {
    const std::string& name = entry.key.text;
    const int line = entry.key.line;
    if (!parts_.insert(name).second)
      return fault(line, printable(name), "got it a second time, expected it once");
    if (name == "name" || name == "about") {
      if (!entry.value.is_scalar())
        return fault(line, name, fmt::format("got {}, expected text", shown(entry.value)));
      if (name == "name") plan_.name = entry.value.text;
    } else if (name == "settings") {
      read_settings(entry.value, plan_.fixed);
    } else if (name == "axes") {
      read_axes(entry.value);
    } else if (name == "search") {
      plan_.search = read_search(entry.value);
    } else if (name == "marks") {
      read_marks(entry.value);
    } else if (name == "keep") {
      read_keep(entry.value);
    } else {
      fault(line, printable(name),
            "got an unknown key, expected name, about, settings, axes, search, marks or keep");
    }
  }

  void read_axes(const YamlNode& list) {
    if (!list.is_list() || list.children.size() > kMostAxes)
      return fault(list.line, "axes",
                   fmt::format("got {}, expected a list of at most {} axes", shown(list), kMostAxes));
    for (const YamlNode* node : list.children) {
      if (node->is_map()) {
        read_axis(*node);
      } else {
        fault(node->line, "axes", fmt::format("got {}, expected {{key: [values]}}", shown(*node)));
      }
    }
  }

  void read_axis(const YamlNode& map) {
    Axis axis;
    for (const YamlEntry& entry : map.entries()) {
      if (entry.key.text == "sample") read_sample(entry.value, axis);
    }
    std::optional<std::uint64_t> size;
    if (axis.kind != Axis::Kind::kTogether) size = axis.size;
    for (const YamlEntry& entry : map.entries()) {
      if (entry.key.text == "sample") continue;
      if (!keys_.insert(entry.key.text).second) {
        fault(entry.key.line, printable(entry.key.text), "got it in two axes, expected it in one");
        continue;
      }
      const std::optional<std::uint64_t> length = read_dimension(entry, axis);
      if (!length || axis.kind != Axis::Kind::kTogether) continue;
      if (size && *size != *length)
        fault(entry.key.line, entry.key.text,
              fmt::format("got {} values, expected {} as the other keys of this axis", *length, *size));
      size = length;
    }
    axis.size = size.value_or(0);
    const bool is_sample = axis.kind != Axis::Kind::kTogether;
    if (is_sample && axis.dimensions.size() > static_cast<std::size_t>(kSobolDimensions))
      fault(map.line, "axes",
            fmt::format("got {} keys, expected at most {} in a sample", axis.dimensions.size(),
                        kSobolDimensions));
    if (axis.dimensions.empty() && is_faultless())
      fault(map.line, "axes", "got an axis without keys, expected one");
    plan_.axes.push_back(std::move(axis));
  }

  void read_sample(const YamlNode& map, Axis& axis) {
    if (!map.is_map())
      return fault(map.line, "sample",
                   fmt::format("got {}, expected {{method: sobol, count: 64, seed: 1}}", shown(map)));
    axis.kind = Axis::Kind::kSobol;
    for (const YamlEntry& entry : map.entries()) {
      const std::string& key = entry.key.text;
      if (key == "method") {
        if (entry.value.text == "latin-hypercube") axis.kind = Axis::Kind::kLatinHypercube;
        if (entry.value.text != "sobol" && entry.value.text != "latin-hypercube")
          fault(entry.value.line, "sample.method",
                fmt::format("got {}, expected sobol or latin-hypercube", shown(entry.value)));
      } else if (key == "count") {
        axis.size = count_of(entry.value, "sample.count", 1.0);
      } else if (key == "seed") {
        axis.seed = count_of(entry.value, "sample.seed", 0.0);
      } else {
        fault(entry.key.line, printable(key), "got an unknown key, expected method, count or seed");
      }
    }
    if (axis.size == 0) fault(map.line, "sample.count", "got none, expected the number of points");
  }

  std::uint64_t count_of(const YamlNode& node, std::string_view key, double least) {
    const std::optional<double> value = node.is_scalar() ? number_in(node.text) : std::nullopt;
    if (value && *value >= least && *value <= kMostSamples && *value == std::floor(*value))
      return static_cast<std::uint64_t>(*value);
    fault(node.line, key, fmt::format("got {}, expected an integer from {} on", shown(node), least));
    return 1;
  }

  /// The number of values; none for a range of a sample, or after a fault.
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
      if (dimension.list.empty())
        fault(entry.key.line, printable(dimension.key), "got no values, expected some");
      length = dimension.list.size();
    }
    axis.dimensions.push_back(std::move(dimension));
    return length;
  }

  /// All tracks of `FOLDER/*.csv`, by name.
  void add_folder(const YamlNode& node, std::vector<std::string>& list) {
    const std::string folder = node.text.substr(0, node.text.size() - kFolder.size());
    std::vector<std::string> files;
    std::error_code error;
    for (std::filesystem::directory_iterator each(folder, error), end; !error && each != end;
         each.increment(error))
      if (each->path().extension() == ".csv") files.push_back(each->path().string());
    if (files.empty()) fault(node.line, "track", fmt::format("got {}, expected tracks there", shown(node)));
    std::sort(files.begin(), files.end());
    list.insert(list.end(), files.begin(), files.end());
  }

  /// `{cases: {name: {settings}, …}}`.
  static bool is_cases(const YamlNode& node) {
    return node.is_map() && node.entries().size() == 1 && node.entries().front().key.text == "cases";
  }
  std::uint64_t read_cases(const YamlEntry& entry, Dimension& dimension) {
    const YamlNode& cases = entry.value.entries().front().value;
    if (check_setting(dimension.key, "1") || protocol::find(dimension.key) != nullptr)
      fault(entry.key.line, printable(dimension.key), "got a setting, expected a name of your own for cases");
    if (!cases.is_map() || cases.entries().empty()) {
      fault(entry.key.line, "cases", fmt::format("got {}, expected {{name: {{settings}}}}", shown(cases)));
      return 0;
    }
    for (const YamlEntry& each : cases.entries()) {
      if (std::find(dimension.list.begin(), dimension.list.end(), each.key.text) != dimension.list.end())
        fault(each.key.line, printable(each.key.text), "got it a second time, expected it once");
      dimension.list.push_back(each.key.text);
      read_settings(each.value, dimension.cases.emplace_back());
    }
    return dimension.list.size();
  }

  std::optional<std::uint64_t> read_range(const YamlNode& map, const Axis& axis, Dimension& dimension) {
    std::optional<double> from, to, step;
    std::optional<std::uint64_t> count;
    for (const YamlEntry& entry : map.entries()) {
      const std::string& key = entry.key.text;
      if (key == "from" || key == "to") {
        if (takes(dimension.key, entry.value)) (key == "from" ? from : to) = number_in(entry.value.text);
      } else if (key == "step") {
        step = number_in(entry.value.text);
        if (!step || *step <= 0.0) fault(entry.value.line, "step", "expected a positive number");
      } else if (key == "count") {
        count = count_of(entry.value, "count", 1.0);
      } else if (key == "scale" && (entry.value.text == "log" || entry.value.text == "linear")) {
        dimension.is_logarithmic = entry.value.text == "log";
      } else {
        fault(entry.key.line, printable(key),
              fmt::format("got {}, expected from, to, count or step, and scale: linear or log",
                          shown(entry.value)));
      }
    }
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
    if (!count && !step && dimension.is_integer) step = 1.0;
    if (count.has_value() == step.has_value()) {
      fault(map.line, printable(dimension.key), "expected either count or step");
      return std::nullopt;
    }
    if (count) return count;
    const double steps = std::floor((*to - *from) / *step + 1e-9);
    if (!(steps < kMostSamples)) {
      fault(map.line, printable(dimension.key), "expected fewer steps");
      return std::nullopt;
    }
    dimension.to = *from + steps * *step;
    return static_cast<std::uint64_t>(steps) + 1;
  }

  void read_marks(const YamlNode& list) {
    if (!list.is_list())
      return fault(list.line, "marks", fmt::format("got {}, expected a list of places", shown(list)));
    for (const YamlNode* node : list.children) {
      Settings& mark = plan_.marks.emplace_back();
      if (!node->is_map()) fault(node->line, "marks", fmt::format("got {}, expected a place", shown(*node)));
      for (const YamlEntry& entry : node->is_map() ? node->entries() : std::vector<YamlEntry>{}) {
        mark.emplace_back(entry.key.text, entry.value.text);
        marked_.emplace_back(entry.key.line, entry.key.text);
      }
    }
  }

  void check_marks() {
    for (const auto& [line, key] : marked_)
      if (!keys_.contains(key))
        fault(line, printable(key), "got no key of an axis, expected marks at values of axes");
  }

  void read_keep(const YamlNode& list) {
    if (!list.is_list())
      return fault(list.line, "keep", fmt::format("got {}, expected a list of columns", shown(list)));
    std::vector<std::string_view> names;
    for (const Column& column : columns()) names.push_back(column.name);
    for (const YamlNode* node : list.children) {
      if (find_column(node->text) != nullptr) {
        plan_.keep.push_back(node->text);
      } else {
        fault(node->line, "keep", fmt::format("got {}, expected one of {}", shown(*node), joined(names)));
      }
    }
  }

  void check_size(int line) {
    double size = 1.0;
    for (const Axis& axis : plan_.axes) size *= static_cast<double>(axis.size);
    if (is_faultless() && size > static_cast<double>(Plan::kMostRuns))
      fault(
          line, "axes",
          fmt::format("got {:.3g} runs, expected at most {:g}", size, static_cast<double>(Plan::kMostRuns)));
  }

  Plan plan_;
  std::set<std::string> parts_, keys_;
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
