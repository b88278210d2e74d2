// SPDX-License-Identifier: MIT
#include "chicane/ros/nodes.hpp"
#include "support/chicane_test.hpp"
#include "support/folder.hpp"

#include <unistd.h>

namespace chicane::ros {
namespace {

class MapFile : public testing::Test, protected test::Folder {
 protected:
  /// What is wrong with a map file of that text, without the folder.
  [[nodiscard]] std::string fault_of(std::string_view text) const {
    const auto map = read_map(write("map.yaml", std::string(text)));
    if (map) return "nothing";
    std::string message = map.error().message;
    for (std::size_t at = message.find(folder_.string()); at != std::string::npos;
         at = message.find(folder_.string()))
      message.erase(at, folder_.string().size() + 1);
    return message;
  }
};

/// Three cells by two: the upper row black, unknown and white, the lower row white, white and black.
constexpr std::string_view kText = "P2\n# made by hand\n3 2 255\n0 205 254\n254 254 0\n";
constexpr std::string_view kMap =
    "image: m.pgm\nresolution: 0.05\norigin: [-1.5, 2.0, 0.1]\nnegate: 0\noccupied_thresh: "
    "0.65\nfree_thresh: "
    "0.196\n";

TEST_F(MapFile, PutsTheLowestRowFirstAndTakesUnknownCellsAsFree) {
  write("m.pgm", std::string(kText));
  const auto map = test::good(read_map(write("map.yaml", std::string(kMap))));
  EXPECT_EQ(map->width, 3);
  EXPECT_EQ(map->height, 2);
  EXPECT_EQ(map->resolution, 0.05);
  EXPECT_EQ(map->origin.x, -1.5);
  EXPECT_EQ(map->origin.psi, 0.1);
  EXPECT_EQ(map->is_wall, (std::vector<bool>{false, false, true, true, false, false}));
}

TEST_F(MapFile, SaysWhatIsWrongWithALine) {
  write("m.pgm", std::string(kText));
  EXPECT_EQ(fault_of("image: m.pgm\nresolution: -1\norigin: [0, 0]\n"),
            "map.yaml:2: resolution: got -1, expected a number in [0.0001, 100]");
  EXPECT_EQ(fault_of("image: m.pgm\nresolution: 0.05\norigin: [0, a]\nmode: raw\n"),
            "map.yaml:3: origin: y: got a, expected a finite number\n"
            "map.yaml:4: mode: got raw, expected trinary or scale");
  EXPECT_EQ(fault_of("resolution: 0.05\norigin: [0, 0, 0]\n"),
            "map.yaml:1: image: got none, expected the name of a PGM or PNG file");
  EXPECT_EQ(
      fault_of("- 1\n"),
      "map.yaml:1: file: got a list, expected a map with image, resolution and origin, as map_server has it");
}

}  // namespace
}  // namespace chicane::ros
