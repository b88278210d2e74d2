// SPDX-License-Identifier: MIT
#include "chicane/ros/map_file.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <filesystem>
#include <optional>
#include <utility>
#include <vector>

#include "chicane/base/text.hpp"
#include "chicane/protocol/library.hpp"
#include "chicane/protocol/yaml_tree.hpp"

#ifdef CHICANE_HAVE_PNG
#include <png.h>
#endif

namespace chicane::ros {
namespace {

using protocol::YamlEntry;
using protocol::YamlNode;

std::optional<double> number_of(std::string_view text) {
  double value = 0.0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  if (read.ec != std::errc() || read.ptr != text.data() + text.size() || !std::isfinite(value))
    return std::nullopt;
  return value;
}

std::string shown_value(const YamlNode& node) {
  return node.is_scalar() ? printable(node.text)
         : node.is_list() ? "a list"
         : node.is_map()  ? "a map"
                          : "nothing";
}

Result<void> check_size(double width, double height, const std::string& file) {
  const bool is_sound =
      width >= 1.0 && height >= 1.0 && width * height <= static_cast<double>(sim::OccupancyGrid::kMostCells);
  if (is_sound) return {};
  return fail(ErrorCode::kParse, fmt::format("{}: size: got {} x {}, expected 1 to {} cells", file, width,
                                             height, sim::OccupancyGrid::kMostCells));
}

/// The next word of a PGM header; comments go from # to the end of the line.
std::string_view next_word(std::string_view& rest) {
  const auto is_space = [](char c) { return c == ' ' || (c >= '\t' && c <= '\r'); };
  while (!rest.empty() && (is_space(rest.front()) || rest.front() == '#')) {
    const std::size_t end = rest.front() == '#' ? rest.find('\n') : 0;
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
  }
  std::size_t size = 0;
  while (size < rest.size() && !is_space(rest[size])) ++size;
  const std::string_view word = rest.substr(0, size);
  rest.remove_prefix(size);
  return word;
}

Result<GreyImage> read_pgm(std::string_view bytes, const std::string& file) {
  const bool is_text = bytes.starts_with("P2");
  std::string_view rest = bytes.substr(2);
  const double width = number_of(next_word(rest)).value_or(0.0);
  const double height = number_of(next_word(rest)).value_or(0.0);
  if (const Result<void> sound = check_size(width, height, file); !sound) return fail(sound.error());
  const std::string_view most_text = next_word(rest);
  const double most = number_of(most_text).value_or(0.0);
  if (!(most >= 1.0 && most <= 255.0))
    return fail(ErrorCode::kParse,
                fmt::format("{}: largest grey value: got {}, expected 1 to 255", file, printable(most_text)));
  GreyImage image{.width = static_cast<int>(width), .height = static_cast<int>(height)};
  const auto cells = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  if (!is_text && !rest.empty()) rest.remove_prefix(1);  // the one space behind the header
  image.values.reserve(cells);
  for (std::size_t i = 0; i < cells; ++i) {
    const std::optional<double> value = is_text ? number_of(next_word(rest))
                                        : i < rest.size()
                                            ? std::optional<double>(static_cast<unsigned char>(rest[i]))
                                            : std::nullopt;
    if (!value || *value < 0.0 || *value > most)
      return fail(ErrorCode::kParse,
                  fmt::format("{}: grey value {} of {}: got {}, expected 0 to {:.0f}", file, i + 1, cells,
                              value ? fmt::format("{}", *value) : "none", most));
    image.values += static_cast<char>(static_cast<unsigned char>(std::lround(*value * 255.0 / most)));
  }
  return image;
}

#ifdef CHICANE_HAVE_PNG
Result<GreyImage> read_png(std::string_view bytes, const std::string& file) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_memory(&png, bytes.data(), bytes.size()) == 0)
    return fail(ErrorCode::kParse, fmt::format("{}: got a PNG that cannot be read: {}", file, png.message));
  if (const Result<void> sound = check_size(png.width, png.height, file); !sound) {
    png_image_free(&png);
    return fail(sound.error());
  }
  png.format = PNG_FORMAT_GRAY;
  GreyImage image{.width = static_cast<int>(png.width), .height = static_cast<int>(png.height)};
  image.values.resize(PNG_IMAGE_SIZE(png));
  const png_color white{255, 255, 255};
  if (png_image_finish_read(&png, &white, image.values.data(), 0, nullptr) == 0)
    return fail(ErrorCode::kParse, fmt::format("{}: got a PNG that cannot be read: {}", file, png.message));
  return image;
}
#endif

class MapReader {
 public:
  explicit MapReader(std::string file) : file_{std::move(file)} {}

  Result<sim::OccupancyGrid> read() {
    const Result<std::string> text = protocol::read_file(file_);
    if (!text) return fail(text.error());
    const Result<protocol::YamlTree> tree = protocol::parse_yaml(*text, file_);
    if (!tree) return fail(tree.error());
    const YamlNode& root = *tree->root;
    if (!root.is_map())
      return fail(ErrorCode::kParse, fmt::format("{}:1: got {}, expected a map with image, resolution and "
                                                 "origin, as map_server has it",
                                                 file_, shown_value(root)));
    for (const YamlEntry& entry : root.entries()) read_key(entry);
    if (image_.empty()) fault(1, "image", "got none, expected the name of a PGM or PNG file");
    if (grid_.resolution <= 0.0) fault(1, "resolution", "got none, expected the side of a cell > 0 m");
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
      read_number(entry, 1e-4, 100.0, grid_.resolution);
    } else if (key == "occupied_thresh") {
      read_number(entry, 0.0, 1.0, occupied_);
    } else if (key == "free_thresh") {
      double unused = 0.0;  // unknown cells are free, too
      read_number(entry, 0.0, 1.0, unused);
    } else if (key == "negate") {
      double negate = 0.0;
      if (value.text == "true" || value.text == "false")
        negate = value.text == "true" ? 1.0 : 0.0;
      else
        read_number(entry, 0.0, 1.0, negate);
      is_negated_ = negate != 0.0;
    } else if (key == "origin") {
      read_origin(entry);
    } else if (key == "mode" && value.text != "trinary" && value.text != "scale") {
      fault(entry.value.line, key, fmt::format("got {}, expected trinary or scale", shown_value(value)));
    }  // others are map_server's own
  }

  void read_number(const YamlEntry& entry, double least, double most, double& to) {
    const auto value = entry.value.is_scalar() ? number_of(entry.value.text) : std::nullopt;
    if (value && *value >= least && *value <= most) return void(to = *value);
    fault(entry.value.line, entry.key.text,
          fmt::format("got {}, expected a number in [{}, {}]", shown_value(entry.value), least, most));
    to = least;  // said once
  }

  void read_origin(const YamlEntry& entry) {
    has_origin_ = true;
    std::vector<double> numbers;
    for (const YamlNode* node : entry.value.children)
      if (const auto number = node->is_scalar() ? number_of(node->text) : std::nullopt)
        numbers.push_back(*number);
    const bool is_sound = entry.value.is_list() && numbers.size() == entry.value.children.size() &&
                          (numbers.size() == 2 || numbers.size() == 3);
    if (!is_sound) return fault(entry.value.line, "origin", "got something else, expected [x, y, yaw]");
    grid_.origin = {.x = numbers[0], .y = numbers[1], .psi = numbers.size() > 2 ? numbers[2] : 0.0};
  }

  Result<sim::OccupancyGrid> read_cells() {
    const std::string path = (std::filesystem::path(file_).parent_path() / image_).string();
    const Result<std::string> bytes = protocol::read_file(path);
    if (!bytes) return fail(bytes.error());
    const Result<GreyImage> image = read_image(*bytes, path);
    if (!image) return fail(image.error());
    grid_.width = image->width;
    grid_.height = image->height;
    grid_.is_wall.reserve(image->values.size());
    for (int y = image->height - 1; y >= 0; --y)  // the image begins at the top
      for (int x = 0; x < image->width; ++x) {
        const auto value = static_cast<unsigned char>(
            image->values[static_cast<std::size_t>(y) * static_cast<std::size_t>(image->width) +
                          static_cast<std::size_t>(x)]);
        const double dark = (is_negated_ ? value : 255 - value) / 255.0;
        grid_.is_wall.push_back(dark > occupied_);
      }
    return std::move(grid_);
  }

  std::string file_, image_{}, faults_{};
  sim::OccupancyGrid grid_{.resolution = 0.0};
  double occupied_ = 0.65;
  bool is_negated_ = false, has_origin_ = false;
};

}  // namespace

Result<GreyImage> read_image(std::string_view bytes, const std::string& file) {
  if (bytes.starts_with("P2") || bytes.starts_with("P5")) return read_pgm(bytes, file);
  if (bytes.starts_with("\x89PNG")) {
#ifdef CHICANE_HAVE_PNG
    return read_png(bytes, file);
#else
    return fail(ErrorCode::kParse,
                fmt::format("{}: got a PNG, which this was built without (libpng): expected PGM", file));
#endif
  }
  return fail(ErrorCode::kParse,
              fmt::format("{}: got other bytes, expected a PGM (P2, P5) or PNG image", file));
}

Result<sim::OccupancyGrid> read_map(const std::string& file) { return MapReader(file).read(); }

}  // namespace chicane::ros
