// SPDX-License-Identifier: MIT
#include "chicane/protocol/occupancy_map.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <utility>
#include <vector>

#include "chicane/base/text.hpp"
#include "chicane/protocol/csv_text.hpp"
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

class MapReader {
 public:
  explicit MapReader(std::string file) : file_{std::move(file)} {}

  Result<OccupancyMap> read(std::string_view text) {
    const Result<YamlTree> tree = parse_yaml(text, file_);
    if (!tree) return fail(tree.error());
    const YamlNode& root = *tree->root;
    if (!root.is_map())
      return fail(ErrorCode::kParse, fmt::format("{}:1: got {}, expected a map with image, resolution and "
                                                 "origin, as map_server has it",
                                                 file_, shown_value(root)));
    for (const YamlEntry& entry : root.entries()) read_key(entry);
    if (image_.empty()) fault(1, "image", "got none, expected the name of a PGM or PNG file");
    if (map_.resolution <= 0.0) fault(1, "resolution", "got none, expected the side of a cell > 0 m");
    if (!has_origin_) fault(1, "origin", "got none, expected [x, y, yaw]");
    if (!faults_.empty()) return fail(ErrorCode::kParse, faults_);
    return read_cells();
  }

 private:
  void fault(int line, std::string_view key, const std::string& what) {
    if (!faults_.empty()) faults_ += '\n';
    faults_ += fmt::format("{}:{}: {}: {}", file_, line, key, what);
  }

  void read_key(const YamlEntry& entry) {
    const std::string& key = entry.key.text;
    const YamlNode& value = entry.value;
    if (key == "image") {
      image_ = value.text;
    } else if (key == "resolution") {
      read_number(entry, 1e-4, 100.0, map_.resolution);
    } else if (key == "occupied_thresh") {
      read_number(entry, 0.0, 1.0, map_.occupied);
    } else if (key == "free_thresh") {
      read_number(entry, 0.0, 1.0, map_.free);
    } else if (key == "negate") {
      double negate = 0.0;
      if (value.text == "true" || value.text == "false")
        negate = value.text == "true" ? 1.0 : 0.0;
      else
        read_number(entry, 0.0, 1.0, negate);
      map_.is_negated = negate != 0.0;
    } else if (key == "origin") {
      read_origin(entry);
    } else if (key == "mode" && value.text != "trinary" && value.text != "scale") {
      fault(entry.value.line, key, fmt::format("got {}, expected trinary or scale", shown_value(value)));
    }  // others are map_server's own
  }

  void read_number(const YamlEntry& entry, double least, double most, double& to) {
    const auto value = entry.value.is_scalar() ? number(entry.value.text) : std::nullopt;
    if (value && *value >= least && *value <= most) return void(to = *value);
    fault(entry.value.line, entry.key.text,
          fmt::format("got {}, expected a number in [{}, {}]", shown_value(entry.value), least, most));
    to = least;  // said once
  }

  void read_origin(const YamlEntry& entry) {
    has_origin_ = true;
    std::vector<double> numbers;
    for (const YamlNode* node : entry.value.children)
      if (const auto read = node->is_scalar() ? number(node->text) : std::nullopt) numbers.push_back(*read);
    const bool is_sound = entry.value.is_list() && numbers.size() == entry.value.children.size() &&
                          (numbers.size() == 2 || numbers.size() == 3);
    if (!is_sound) return fault(entry.value.line, "origin", "got something else, expected [x, y, yaw]");
    map_.origin = {numbers[0], numbers[1]};
    map_.yaw = numbers.size() > 2 ? numbers[2] : 0.0;
  }

  Result<OccupancyMap> read_cells() {
    const std::string path = (std::filesystem::path(file_).parent_path() / image_).string();
    const Result<std::string> bytes = read_file(path);
    if (!bytes) return fail(bytes.error());
    Result<survey::GreyImage> image = survey::read_image(*bytes, path);
    if (!image) return fail(image.error());
    map_.image = std::move(*image);
    return std::move(map_);
  }

  std::string file_, image_{}, faults_{};
  OccupancyMap map_;
  bool has_origin_ = false;
};

}  // namespace

Result<OccupancyMap> parse_map(std::string_view text, const std::string& file) {
  return MapReader(file).read(text);
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
