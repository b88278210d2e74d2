// SPDX-License-Identifier: MIT
#include "chicane/base/latest.hpp"
#include "support/chicane_test.hpp"

#include <thread>

namespace chicane {
namespace {

TEST(Latest, GivesTheNewestValueOnce) {
  Latest<int> latest;
  int value = 7;
  EXPECT_FALSE(latest.take(value));
  EXPECT_EQ(value, 7);
  for (int i = 1; i <= 5; ++i) latest.put(i);
  EXPECT_TRUE(latest.take(value));
  EXPECT_EQ(value, 5);
  EXPECT_FALSE(latest.take(value));
  latest.put(6);
  EXPECT_TRUE(latest.take(value));
  EXPECT_EQ(value, 6);
}

TEST(Latest, ReaderSeesWholeValuesInOrderAndTheLastOne) {
  using Block = std::array<std::uint64_t, 64>;
  constexpr std::uint64_t kLast = 100000;
  Latest<Block> latest;
  std::jthread writer([&latest] {
    Block block{};
    for (std::uint64_t i = 1; i <= kLast; ++i) {
      block.fill(i);
      latest.put(block);
    }
  });
  Block block{};
  std::uint64_t seen = 0;
  while (seen < kLast) {
    if (!latest.take(block)) {
      std::this_thread::yield();
      continue;
    }
    ASSERT_GT(block.front(), seen);
    for (const std::uint64_t word : block) ASSERT_EQ(word, block.front());
    seen = block.front();
  }
  writer.join();
  EXPECT_FALSE(latest.take(block));
}

}  // namespace
}  // namespace chicane
