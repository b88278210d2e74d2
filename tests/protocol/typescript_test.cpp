// SPDX-License-Identifier: MIT
#include "protocol/typescript.hpp"
#include "support/chicane_test.hpp"

namespace chicane::test {
namespace {

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
