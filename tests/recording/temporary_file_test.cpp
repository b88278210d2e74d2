// SPDX-License-Identifier: MIT
#include "chicane/recording/replay.hpp"
#include "support/chicane_test.hpp"

namespace chicane::recording {
namespace {

TEST(TemporaryFile, NamesAPlaceWhereNothingIsAndClearsUp) {
  std::string path;
  {
    const recording::TemporaryFile file{".mcap"};
    path = file.path();
    EXPECT_TRUE(path.ends_with(".mcap"));
    EXPECT_FALSE(std::filesystem::exists(path));
    std::ofstream{path} << "text";
    EXPECT_TRUE(std::filesystem::exists(path));
  }
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(TemporaryFile, IsAnotherOneEachTime) {
  const recording::TemporaryFile one{".txt"};
  const recording::TemporaryFile other{".txt"};
  EXPECT_NE(one.path(), other.path());
}

}  // namespace
}  // namespace chicane::recording
