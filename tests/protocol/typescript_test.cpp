// SPDX-License-Identifier: MIT
#include "protocol/typescript.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <string>
#include <tuple>

namespace chicane::test {
namespace {

TEST(TypeScript, HasAFieldForEachOfTheDefinitionWithItsComments) {
  EXPECT_EQ(typescript("Sample",
                       "# Anything.\n# In two lines.\n"
                       "builtin_interfaces/Time stamp\n"
                       "uint64 cycle\n"
                       "float64 speed_mps          # along the car\n"
                       "\n"
                       "# A group\n"
                       "uint8 MODE_OFF=0\n"
                       "uint8 MODE_ON=1            # it is on\n"
                       "uint8 mode                 # which\n"
                       "int32 count\n"
                       "bool is_on\n"
                       "string word\n"
                       "string[] words\n"
                       "float64[] many\n"
                       "float64[3] three\n"
                       "====\nMSG: builtin_interfaces/Time\nint32 sec\n"),
            R"(/** chicane_msgs/msg/Sample. Anything. In two lines. */
export interface Sample {
  stamp: Stamp;
  cycle: bigint;
  /** along the car */
  speed_mps: number;

  // A group
  /** which */
  mode: number;
  count: number;
  is_on: boolean;
  word: string;
  words: string[];
  many: Float64Array;
  three: Float64Array;
}

/** Sample.mode */
export const MODE = {
  OFF: 0,
  /** it is on */
  ON: 1,
} as const;

/** What a Sample says when nothing is known. */
export const UNKNOWN_SAMPLE: Sample = {
  stamp: { sec: 0, nsec: 0 },
  cycle: 0n,
  speed_mps: NaN,
  mode: 0,
  count: -1,
  is_on: false,
  word: '',
  words: [],
  many: new Float64Array(),
  three: new Float64Array(3).fill(NaN),
};
)");
}

TEST(TypeScript, BreaksLongComments) {
  std::string words;
  for (int i = 0; i < 40; ++i) words += " words";
  const std::string text = typescript("Sample", "bool a #" + words + "\n");
  std::istringstream lines{text};
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 120U) << line;
  EXPECT_NE(text.find("  /**\n   * words words"), std::string::npos) << text;
}

TEST(TypeScript, RefusesATypeItDoesNotKnow) {
  EXPECT_THROW(std::ignore = typescript("Sample", "geometry_msgs/Point[] points\n"), std::logic_error);
}

/// CHICANE_WRITE_FIXTURES=1 renews the file: cmake --build --preset release --target renew_fixtures
TEST(TypeScript, FixturesOfTheDashboardAreUpToDate) {
  const std::filesystem::path path =
      std::filesystem::path(CHICANE_SOURCE_DIR) / "web/src/protocol/messages.ts";
  if (std::getenv("CHICANE_WRITE_FIXTURES") != nullptr)
    std::ofstream(path, std::ios::binary) << typescript_messages();
  std::ifstream stream(path, std::ios::binary);
  const std::string found{std::istreambuf_iterator<char>(stream), {}};
  EXPECT_EQ(found, typescript_messages()) << "wanted? cmake --build --preset release --target renew_fixtures";
}

}  // namespace
}  // namespace chicane::test
