// SPDX-License-Identifier: MIT
#include "chicane/protocol/yaml_codec.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "chicane/base/text.hpp"
#include "chicane/protocol/fault_codec.hpp"
#include "chicane/protocol/yaml_tree.hpp"

namespace chicane::protocol {
namespace {

constexpr int kMostNodes = 10000;  // counted with aliases followed
constexpr int kMostDepth = static_cast<int>(YamlTree::kMostDepth);
constexpr std::size_t kMostFaults = 50;

/// Walks the nodes of one file and collects settings and faults.
class Reader {
 public:
  explicit Reader(const std::string& file) { document_.file = file; }

  void read(const YamlNode& root) {
    if (!root.is_map()) {
      fault(1, "file",
            fmt::format("got {}, expected a map of settings",
                        root.kind == YamlNode::Kind::kNothing ? "an empty file" : shown(root)));
      return;
    }
    read_map(root, "", 0);
  }

  [[nodiscard]] Result<Document> result() && {
    if (faults_.empty()) return std::move(document_);
    if (faults_.size() >= kMostFaults) faults_.push_back(fmt::format("{}: and perhaps more", document_.file));
    return fail(ErrorCode::kParse, fmt::format("{}", fmt::join(faults_, "\n")));
  }

 private:
  void fault(int line, std::string_view key, std::string_view what) {
    faults_.push_back(fmt::format("{}{}: {}", place(document_.file, line), key, what));
  }

  static std::string shown(const YamlNode& node) {
    if (node.is_map()) return "a map";
    if (node.is_list()) return "a list";
    if (!node.is_scalar()) return "nothing";
    return node.tag == "!" ? fmt::format("\"{}\" in quotes", printable(node.text)) : printable(node.text);
  }

  void read_map(const YamlNode& map, const std::string& prefix, int depth) {
    for (const YamlEntry& entry : map.entries()) {
      if (++nodes_ == kMostNodes)
        fault(0, "file", fmt::format("got more than {} settings, expected fewer", kMostNodes));
      if (nodes_ >= kMostNodes || faults_.size() >= kMostFaults) return;
      const int line = entry.key.line;
      if (!entry.key.is_scalar()) {
        fault(line, prefix.empty() ? "key" : prefix,
              fmt::format("got {} as a key, expected a name", shown(entry.key)));
        continue;
      }
      const std::string& name = entry.key.text;
      const bool is_ros_wrapper =
          prefix.empty() && entry.value.is_map() && (name == "ros__parameters" || name.starts_with("/"));
      if (is_ros_wrapper && depth < kMostDepth) {
        read_map(entry.value, "", depth + 1);
      } else {
        read_entry(prefix.empty() ? name : fmt::format("{}.{}", prefix, name), entry.value, line, depth);
      }
    }
  }

  void read_entry(const std::string& key, const YamlNode& node, int line, int depth) {
    const auto [first, is_new] = lines_.emplace(key, line);
    if (!is_new && !node.is_map()) {
      fault(line, printable(key),
            fmt::format("got it a second time, expected it once (first on line {})", first->second));
      return;
    }
    if (key == "preset") {
      read_preset(node, line);
    } else if (key == "faults") {
      read_faults(node, line);
    } else if (const Parameter* parameter = find(key); parameter != nullptr) {
      read_value(*parameter, node, line);
    } else if (!is_group(key)) {
      fault(line, printable(key), unknown_key(key));
    } else if (!node.is_map()) {
      fault(line, printable(key), fmt::format("got {}, expected a map of settings", shown(node)));
    } else if (depth < kMostDepth) {
      read_map(node, key, depth + 1);
    }
  }

  static bool is_group(const std::string& key) {
    return std::any_of(list().begin(), list().end(), [&](const Parameter& p) { return p.group == key; });
  }

  void read_preset(const YamlNode& node, int line) {
    if (node.is_scalar() && !node.text.empty()) {
      document_.preset = node.text;
      document_.preset_line = line;
    } else {
      fault(line, "preset", fmt::format("got {}, expected the name of a preset", shown(node)));
    }
  }

  void read_faults(const YamlNode& node, int line) {
    if (!node.is_list() || node.children.size() > sim::FaultLab::kCapacity) {
      fault(line, "faults",
            fmt::format("got {}, expected a list of at most {} faults",
                        node.is_list() ? fmt::format("{} of them", node.children.size()) : shown(node),
                        sim::FaultLab::kCapacity));
      return;
    }
    document_.faults.emplace();
    for (const YamlNode* item : node.children) read_fault_event(*item);
  }

  void read_fault_event(const YamlNode& item) {
    const int line = item.line;
    if (!item.is_map()) {
      fault(line, "faults", fmt::format("got {}, expected {{name: half_grip, at_s: 12}}", shown(item)));
      return;
    }
    FaultText text;
    const std::array<std::pair<std::string_view, std::string*>, 4> fields{
        {{"name", &text.name}, {"at_s", &text.at}, {"for_s", &text.duration}, {"strength", &text.strength}}};
    for (const YamlEntry& entry : item.entries()) {
      const int entry_line = entry.key.line;
      const std::string name = entry.key.is_scalar() ? entry.key.text : "";
      const auto* const field =
          std::find_if(fields.begin(), fields.end(), [&](const auto& each) { return each.first == name; });
      if (field == fields.end()) {
        fault(entry_line, "faults",
              fmt::format("got {}, expected name, at_s, for_s or strength", shown(entry.key)));
        return;
      }
      if (!entry.value.is_scalar() || entry.value.text.empty()) {
        fault(entry_line, fmt::format("faults.{}", name),
              fmt::format("got {}, expected one value", shown(entry.value)));
        return;
      }
      *field->second = entry.value.text;
    }
    const Result<sim::FaultEvent> event = read_fault(text);
    if (!event) {
      faults_.push_back(place(document_.file, line) + event.error().message);
      return;
    }
    document_.faults->push_back(*event);
  }

  void read_value(const Parameter& parameter, const YamlNode& node, int line) {
    const bool is_text = parameter.option.kind == Kind::kText || parameter.option.kind == Kind::kChoice;
    const bool is_plain = node.is_scalar() && (node.tag == "?" || (is_text && node.tag == "!"));
    if (!is_plain) {
      const bool has_tag = node.is_scalar() && node.tag != "!" && node.tag != "?";
      fault(line, parameter.key,
            fmt::format("got {}, expected {}",
                        has_tag ? fmt::format("the tag {}", printable(node.tag)) : shown(node),
                        expectation(parameter.option)));
      return;
    }
    const Result<Value> value = parse(parameter, node.text);
    if (!value) {
      faults_.push_back(place(document_.file, line) + value.error().message);
      return;
    }
    document_.assignments.push_back({&parameter, *value, line});
  }

  Document document_;
  std::vector<std::string> faults_;
  std::map<std::string, int> lines_;  // where each key was first seen
  int nodes_ = 0;
};

std::string yaml_text(const Parameter& parameter, const scenario::Scenario& scenario) {
  const std::string text = get_text(scenario, parameter);
  if (parameter.option.kind != Kind::kText) return text == "inf" ? ".inf" : text;
  std::string escaped;
  for (const char c : text) {
    const bool is_control = static_cast<unsigned char>(c) < 0x20;
    if (c == '"' || c == '\\') escaped += '\\';
    escaped += is_control ? fmt::format("\\x{:02x}", static_cast<unsigned char>(c)) : std::string(1, c);
  }
  return fmt::format("\"{}\"", escaped);
}

/// The settings that `wants` lets in, group by group, under a comment.
template <class Wants>
std::string write(const scenario::Scenario& scenario, std::string_view description, Wants wants) {
  std::string text = fmt::format("# {}\n", description);
  std::replace_if(
      text.begin(), std::prev(text.end()), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  std::string_view group;
  for (const Parameter& parameter : list()) {
    if (!wants(parameter)) continue;
    const bool is_grouped = !parameter.group.empty();
    if (is_grouped && parameter.group != group) text += fmt::format("{}:\n", parameter.group);
    group = parameter.group;
    const std::string_view name = is_grouped ? parameter.key.substr(group.size() + 1) : parameter.key;
    text += fmt::format("{}{}: {}\n", is_grouped ? "  " : "", name, yaml_text(parameter, scenario));
  }
  return text;
}

std::string write_faults(const scenario::Scenario& scenario) {
  std::string text = scenario.faults.empty() ? "" : "faults:\n";
  for (const sim::FaultEvent& event : scenario.faults) text += fmt::format("  - {}\n", write_fault(event));
  return text;
}

/// Of a plant with parameters the model follows from them; what is set of it replaces that.
void believe_plant(std::span<const Document> layers, scenario::Scenario& scenario) {
  scenario::Scenario plant = scenario;
  for (const Document& layer : layers) {
    for (const Assignment& assignment : layer.assignments) {
      const Parameter& row = *assignment.parameter;
      // A value out of range is refused below, with its place.
      if (row.key == "plant" || row.group == "plant_params")
        static_cast<void>(set(plant, row, assignment.value));
    }
  }
  if (plant.plant == sim::DoubleTrack::kName)
    scenario.vehicle = sim::model_of(plant.plant_params, scenario.vehicle);
}

/// The settings that need no words: the defaults, and the model that follows from the plant.
scenario::Scenario silent(const scenario::Scenario& of) {
  scenario::Scenario silent;
  if (of.plant == sim::DoubleTrack::kName) silent.vehicle = sim::model_of(of.plant_params, silent.vehicle);
  return silent;
}

}  // namespace

std::string place(const std::string& file, int line) {
  if (file.empty()) return "";
  return line > 0 ? fmt::format("{}:{}: ", file, line) : fmt::format("{}: ", file);
}

Result<Document> parse_document(std::string_view text, const std::string& file) {
  const Result<YamlTree> tree = parse_yaml(text, file);
  if (!tree) return fail(tree.error());
  Reader reader(file);
  reader.read(*tree->root);
  return std::move(reader).result();
}

Result<void> apply_layers(std::span<const Document> layers, scenario::Scenario& scenario) {
  scenario::Scenario changed = scenario;
  std::map<std::string_view, std::string> places;
  std::vector<std::string> faults;
  believe_plant(layers, changed);
  for (const Document& layer : layers) {
    for (const Assignment& assignment : layer.assignments) {
      const std::string where = place(layer.file, assignment.line);
      const Result<void> done = set(changed, *assignment.parameter, assignment.value);
      if (!done) faults.push_back(where + done.error().message);
      places[assignment.parameter->key] = where;
    }
    if (layer.faults) changed.faults = *layer.faults;
  }
  for (const Contradiction& contradiction : contradictions(changed)) {
    std::string where = places[contradiction.key];
    if (where.empty()) where = layers.empty() ? "" : place(layers.back().file, 0);
    faults.push_back(fmt::format("{}{}: {}", where, contradiction.key, contradiction.message));
  }
  if (!faults.empty()) return fail(ErrorCode::kInvalidArgument, fmt::format("{}", fmt::join(faults, "\n")));
  scenario = std::move(changed);
  return {};
}

std::string write_document(const scenario::Scenario& scenario, std::string_view description, bool is_whole) {
  const scenario::Scenario defaults = silent(scenario);
  const std::string text = write(scenario, description, [&](const Parameter& parameter) {
    return parameter.key != "preset" && (is_whole || get(scenario, parameter) != get(defaults, parameter));
  });
  return text + write_faults(scenario);
}

std::string write_preset(const scenario::Scenario& scenario, const scenario::Scenario& base,
                         std::string_view description) {
  const std::string text = write(scenario, description, [&](const Parameter& parameter) {
    const bool is_named = parameter.key == "preset" || parameter.key == "car" || parameter.key == "track";
    return is_named || get(scenario, parameter) != get(base, parameter);
  });
  return text + write_faults(scenario);
}

}  // namespace chicane::protocol
