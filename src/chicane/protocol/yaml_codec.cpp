// SPDX-License-Identifier: MIT
// YAML settings: reads a file into a Document with all its faults, applies layers of documents to a scenario,
// and writes scenarios and presets back.
#include "chicane/protocol/yaml_codec.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "chicane/base/text.hpp"
#include "chicane/protocol/schema_json.hpp"

namespace chicane::protocol {
namespace {

constexpr int kMostNodes = 10000;  // limit of settings in a file, aliases followed; chosen: bounds the time
constexpr int kMostDepth = static_cast<int>(YamlTree::kMostDepth);

/// Words as a list: "name, about or keep".
std::string alternatives(const std::vector<std::string_view>& words) {
  std::string text(words.front());
  for (std::size_t i = 1; i < words.size(); ++i)
    text += fmt::format("{}{}", i + 1 == words.size() ? " or " : ", ", words[i]);
  return text;
}

/// Reader of one file of settings.
class Reader : private YamlReader {
 public:
  explicit Reader(const std::string& file) : YamlReader{file} { document_.file = file; }

  void read(const YamlNode& root) {
    if (!root.is_map()) {
      fault(1, "file",
            fmt::format("got {}, expected a map of settings",
                        root.kind == YamlNode::Kind::kNothing ? "an empty file" : shown(root)));
      return;
    }
    read_settings(root, "", 0);
  }

  [[nodiscard]] Result<Document> result() && {
    return is_faultless() ? Result<Document>(std::move(document_)) : fail(error());
  }

 private:
  /// Reads a map of settings, whose keys have `prefix` before them.
  void read_settings(const YamlNode& map, const std::string& prefix, int depth) {
    for (const YamlEntry& entry : map.entries()) {
      if (++nodes_ == kMostNodes)
        fault(0, "file", fmt::format("got more than {} settings, expected fewer", kMostNodes));
      if (nodes_ >= kMostNodes || is_full()) return;
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
        read_settings(entry.value, "", depth + 1);
      } else {
        read_entry(prefix.empty() ? name : fmt::format("{}.{}", prefix, name), entry, depth);
      }
    }
  }

  void read_entry(const std::string& key, const YamlEntry& entry, int depth) {
    const auto [first, is_new] = lines_.emplace(key, entry.key.line);
    const Parameter* parameter = find(key);
    if (!is_new && !entry.value.is_map()) {
      fault(entry.key.line, printable(key),
            fmt::format("got it a second time, expected it once (first on line {})", first->second));
    } else if (key == "preset") {
      text(document_.preset.emplace(), "the name of a preset")(entry);
      document_.preset_line = entry.key.line;
    } else if (key == "faults") {
      document_.faults.emplace();
      list(
          "faults", [this](const YamlNode& item) { read_fault_event(item); },
          sim::FaultLab::kCapacity)(entry);
    } else if (parameter != nullptr) {
      read_value(*parameter, entry.value, entry.key.line);
    } else if (!is_group(key)) {
      fault(entry.key.line, printable(key), unknown_key(key));
    } else if (!entry.value.is_map()) {
      fault(entry.key.line, printable(key),
            fmt::format("got {}, expected a map of settings", shown(entry.value)));
    } else if (depth < kMostDepth) {
      read_settings(entry.value, key, depth + 1);
    }
  }

  static bool is_group(const std::string& key) {
    return std::any_of(protocol::list().begin(), protocol::list().end(),
                       [&](const Parameter& p) { return p.group == key; });
  }

  void read_fault_event(const YamlNode& item) {
    FaultText event;
    const bool is_read = read_map(item, "faults", "{name: half_grip, at_s: 12}",
                                  {{"name", text(event.name)},
                                   {"at_s", text(event.at)},
                                   {"for_s", text(event.duration)},
                                   {"strength", text(event.strength)}});
    if (!is_read) return;
    const Result<sim::FaultEvent> read = read_fault(event);
    if (!read) return fault(item.line, read.error());
    document_.faults->push_back(*read);
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
    if (!value) return fault(line, value.error());
    document_.assignments.push_back({&parameter, *value, line});
  }

  Document document_;
  std::map<std::string, int> lines_;  ///< line on which each key was first seen
  int nodes_ = 0;                     ///< nodes read so far
};

/// Value of a setting as YAML.
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

/// Writes the settings that `wants` accepts, group by group, below a comment.
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

/// Derives the vehicle model from the plant's parameters, if the plant has any. Settings of the vehicle are
/// applied afterwards and replace derived values.
void derive_model(std::span<const Document> layers, scenario::Scenario& scenario) {
  scenario::Scenario plant = scenario;
  for (const Document& layer : layers) {
    for (const Assignment& assignment : layer.assignments) {
      const Parameter& row = *assignment.parameter;
      // Faults are ignored here: apply_layers() reports them with their position.
      if (row.key == "plant" || row.group == "plant_params")
        static_cast<void>(set(plant, row, assignment.value));
    }
  }
  if (plant.plant == sim::DoubleTrack::kName)
    scenario.vehicle = sim::model_of(plant.plant_params, scenario.vehicle);
}

/// Settings that a file of `scenario` leaves out: defaults, and the vehicle model derived from the plant.
scenario::Scenario implied_settings(const scenario::Scenario& scenario) {
  scenario::Scenario implied;
  if (scenario.plant == sim::DoubleTrack::kName)
    implied.vehicle = sim::model_of(scenario.plant_params, implied.vehicle);
  return implied;
}

}  // namespace

std::string place(const std::string& file, int line) {
  if (file.empty()) return "";
  return line > 0 ? fmt::format("{}:{}: ", file, line) : fmt::format("{}: ", file);
}

std::string shown(const YamlNode& node) {
  if (node.is_map()) return "a map";
  if (node.is_list()) return "a list";
  if (!node.is_scalar()) return "nothing";
  const bool is_quoted = node.tag == "!" && !node.text.empty();
  return is_quoted ? fmt::format("\"{}\" in quotes", printable(node.text)) : printable(node.text);
}

void YamlReader::fault(int line, std::string_view key, std::string_view what) {
  fault(line, Error{ErrorCode::kParse, fmt::format("{}: {}", key, what)});
}

void YamlReader::fault(int line, const Error& error) {
  std::string text = place(file_, line) + error.message;
  if (!is_full() && (faults_.empty() || faults_.back() != text)) faults_.push_back(std::move(text));
}

void YamlReader::refuse(const YamlNode& node, std::string_view key, std::string_view expected) {
  fault(node.line, printable(key), fmt::format("got {}, expected {}", shown(node), expected));
}

void YamlReader::refuse(const YamlEntry& entry, std::string_view expected) {
  fault(entry.key.line, entry.key.text, fmt::format("got {}, expected {}", shown(entry.value), expected));
}

Error YamlReader::error() const {
  const std::string more = is_full() ? fmt::format("\n{}: and perhaps more", file_) : "";
  return {ErrorCode::kParse, fmt::format("{}{}", fmt::join(faults_, "\n"), more)};
}

bool YamlReader::read_map(const YamlNode& node, std::string_view name, std::string_view expected,
                          const std::vector<Key>& keys, Others others) {
  const std::size_t before = faults_.size();
  if (!node.is_map()) refuse(node, name, expected);
  std::set<std::string_view> seen;
  for (const YamlEntry& entry : node.entries()) {
    const std::string& key = entry.key.text;
    const auto row =
        std::find_if(keys.begin(), keys.end(), [&](const Key& each) { return each.name == key; });
    if (row == keys.end()) {
      std::vector<std::string_view> names;
      for (const Key& each : keys) names.push_back(each.name);
      if (others == Others::kRefused)
        fault(entry.key.line, printable(key),
              fmt::format("got an unknown key, expected {}", alternatives(names)));
    } else if (!seen.insert(row->name).second) {
      fault(entry.key.line, key, "got it a second time, expected it once");
    } else {
      row->take(entry);
    }
  }
  return faults_.size() == before;
}

YamlReader::Take YamlReader::text(std::string& to, std::string_view expected) {
  return [this, &to, expected](const YamlEntry& entry) {
    if (!entry.value.is_scalar() || entry.value.text.empty()) return refuse(entry, expected);
    to = entry.value.text;
  };
}

YamlReader::Take YamlReader::choice(std::string& to, std::vector<std::string_view> words) {
  return [this, &to, words = std::move(words)](const YamlEntry& entry) {
    if (std::find(words.begin(), words.end(), entry.value.text) == words.end())
      return refuse(entry, alternatives(words));
    to = entry.value.text;
  };
}

YamlReader::Take YamlReader::number(double& to, double least, double most) {
  return [this, &to, least, most](const YamlEntry& entry) {
    const auto number = number_in(entry.value.text);
    if (!number || *number < least || *number > most)
      return refuse(entry, most == kEver ? "a number" : fmt::format("a number in [{}, {}]", least, most));
    to = *number;
  };
}

YamlReader::Take YamlReader::list(std::string what, std::function<void(const YamlNode&)> take,
                                  std::size_t most) {
  return [this, what = std::move(what), take = std::move(take), most](const YamlEntry& entry) {
    if (!entry.value.is_list() || entry.value.children.size() > most)
      return fault(entry.key.line, entry.key.text,
                   fmt::format("got {}, expected a list of at most {} {}",
                               entry.value.is_list() ? fmt::format("{} of them", entry.value.children.size())
                                                     : shown(entry.value),
                               most, what));
    for (const YamlNode* node : entry.value.children) take(*node);
  };
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
  derive_model(layers, changed);
  for (const Document& layer : layers) {
    for (const Assignment& assignment : layer.assignments) {
      const std::string where = place(layer.file, assignment.line);
      const Result<void> done = set(changed, *assignment.parameter, assignment.value);
      if (!done) faults.push_back(where + done.error().message);
      places[assignment.parameter->key] = where;
    }
    if (layer.faults) changed.faults = *layer.faults;
  }
  // Contradictions are reported where their key was set.
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
  const scenario::Scenario defaults = implied_settings(scenario);
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
