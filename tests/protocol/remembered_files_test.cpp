// SPDX-License-Identifier: MIT
#include "chicane/protocol/library.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "chicane/protocol/schema.hpp"

namespace chicane::protocol {
namespace {

namespace fs = std::filesystem;

std::string all_of(const scenario::Scenario& scenario) {
  std::string text;
  for (const Parameter& parameter : list()) text += get_text(scenario, parameter) + "\n";
  return text;
}

TEST(RememberedFiles, ComposeTheSameAsFiles) {
  RememberedFiles files;
  for (int round = 0; round < 2; ++round) {
    for (const char* preset : {"default", "weighted", "pid"}) {
      for (const char* car : {"udacity", "road-car"}) {
        const Request request{.scenario_file = "noisy-sensor",
                              .settings = {{"preset", preset}, {"car", car}, {"laps", "3"}},
                              .speed_mps = "20"};
        const auto once = compose(request);
        const auto remembered = compose(request, files);
        ASSERT_TRUE(once && remembered);
        EXPECT_EQ(all_of(*once), all_of(*remembered));
      }
    }
  }
}

TEST(RememberedFiles, AreReadOnceAndFailuresAgain) {
  const fs::path file =
      fs::path(::testing::TempDir()) / ("remembered_" + std::to_string(::getpid()) + ".yaml");
  const Request request{.scenario_file = {}, .settings = {{"preset", file.string()}}};
  RememberedFiles files;
  EXPECT_FALSE(compose(request, files)) << "there is none yet";
  std::ofstream(file) << "laps: 4\n";
  EXPECT_EQ(compose(request, files)->laps, 4);
  std::ofstream(file, std::ios::trunc) << "laps: 5\n";
  EXPECT_EQ(compose(request, files)->laps, 4);
  EXPECT_EQ(compose(request)->laps, 5);
  fs::remove(file);
  EXPECT_EQ(compose(request, files)->laps, 4);
}

TEST(RememberedFiles, AreBoundedInNumber) {
  RememberedFiles files;
  std::size_t reads = 0;
  const auto read = [&]() -> Result<Document> {
    ++reads;
    return Document{};
  };
  for (std::size_t i = 0; i < 3 * RememberedFiles::kMost; ++i)
    ASSERT_TRUE(files.document(Shelf::kPreset, std::to_string(i), read));
  EXPECT_EQ(reads, 3 * RememberedFiles::kMost);
  ASSERT_TRUE(files.document(Shelf::kPreset, std::to_string(3 * RememberedFiles::kMost - 1), read));
  EXPECT_EQ(reads, 3 * RememberedFiles::kMost);
}

}  // namespace
}  // namespace chicane::protocol
