// SPDX-License-Identifier: MIT
#include "chicane/protocol/occupancy_map.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <utility>
#include <vector>

#include "chicane/base/text.hpp"
#include "chicane/protocol/csv_text.hpp"
#include "chicane/protocol/detail/road_rows.hpp"
#include "chicane/protocol/library.hpp"
#include "chicane/protocol/yaml_tree.hpp"

namespace chicane::protocol {
namespace {

std::string shown_value(const YamlNode& node) {
  return node.is_scalar() ? printable(node.text)
         : node.is_list() ? "a list"
         : node.is_map()  ? "a map"
                          : "nothing";
}

/// The keys of a file, and all that is wrong with them.
struct MapKeys {
  OccupancyMap map = {};
  std::string file, image = {}, faults = {};
  bool has_origin = false;

  void fault(int line, std::string_view key, std::string_view got, std::string_view expected) {
    faults += (faults.empty() ? "" : "\n") + fault_of(file, line, key, got, expected).message;
  }

  void read_number(const YamlEntry& entry, double least, double most, double& to) {
    const auto value = entry.value.is_scalar() ? number(entry.value.text) : std::nullopt;
    if (value && *value >= least && *value <= most) return void(to = *value);
    fault(entry.value.line, entry.key.text, shown_value(entry.value),
          fmt::format("a number in [{}, {}]", least, most));
    to = least;  // said once
  }

  void read_origin(const YamlNode& list) {
    has_origin = true;
    std::vector<double> numbers;
    for (const YamlNode* node : list.children)
      if (const auto read = node->is_scalar() ? number(node->text) : std::nullopt) numbers.push_back(*read);
    if (!list.is_list() || numbers.size() != list.children.size() || numbers.size() < 2 || numbers.size() > 3)
      return fault(list.line, "origin", "something else", "[x, y, yaw]");
    map.origin = {numbers[0], numbers[1]};
    map.yaw = numbers.size() > 2 ? numbers[2] : 0.0;
  }

  void read(const YamlEntry& entry) {
    const std::string& key = entry.key.text;
    const std::string& text = entry.value.text;
    if (key == "image") image = text;
    if (key == "resolution") read_number(entry, 1e-4, 100.0, map.resolution);
    if (key == "occupied_thresh") read_number(entry, 0.0, 1.0, map.occupied);
    if (key == "free_thresh") read_number(entry, 0.0, 1.0, map.free);
    if (key == "origin") read_origin(entry.value);
    if (key == "mode" && text != "trinary" && text != "scale")
      fault(entry.value.line, key, shown_value(entry.value), "trinary or scale");
    if (key == "negate") {
      double negate = text == "true" ? 1.0 : 0.0;
      if (text != "true" && text != "false") read_number(entry, 0.0, 1.0, negate);
      map.is_negated = negate != 0.0;
    }
  }
};

}  // namespace

Result<OccupancyMap> parse_map(std::string_view text, const std::string& file) {
  const Result<YamlTree> tree = parse_yaml(text, file);
  if (!tree) return fail(tree.error());
  if (!tree->root->is_map())
    return fail(fault_of(file, 1, "file", shown_value(*tree->root),
                         "a map with image, resolution and origin, as map_server has it"));
  MapKeys keys{.file = file};
  for (const YamlEntry& entry : tree->root->entries()) keys.read(entry);
  if (keys.image.empty()) keys.fault(1, "image", "none", "the name of a PGM or PNG file");
  if (keys.map.resolution <= 0.0) keys.fault(1, "resolution", "none", "the side of a cell > 0 m");
  if (!keys.has_origin) keys.fault(1, "origin", "none", "[x, y, yaw]");
  if (!keys.faults.empty()) return fail(ErrorCode::kParse, keys.faults);
  const std::string path = (std::filesystem::path(file).parent_path() / keys.image).string();
  const Result<std::string> bytes = read_file(path);
  if (!bytes) return fail(bytes.error());
  Result<survey::GreyImage> image = survey::read_image(*bytes, path);
  if (!image) return fail(image.error());
  keys.map.image = std::move(*image);
  return std::move(keys.map);
}

Result<OccupancyMap> read_map(const std::string& file) {
  const Result<std::string> text = read_file(file);
  return text ? parse_map(*text, file) : fail(text.error());
}

survey::FreeSpace free_space_of(const OccupancyMap& map) {
  survey::FreeSpace space{.width = map.image.width,
                          .height = map.image.height,
                          .resolution = map.resolution,
                          .origin = map.origin,
                          .yaw = map.yaw};
  space.cells.reserve(map.image.values.size());
  for (int y = map.image.height - 1; y >= 0; --y)  // the image begins at the top
    for (int x = 0; x < map.image.width; ++x) {
      const double dark = map.darkness(x, y);
      if (map.is_unknown(x, y)) {
        space.cells.push_back(survey::Cell::kUnknown);
        continue;
      }
      space.cells.push_back(dark > map.occupied ? survey::Cell::kWall
                            : dark < map.free   ? survey::Cell::kFree
                                                : survey::Cell::kUnknown);
    }
  return space;
}

}  // namespace chicane::protocol
