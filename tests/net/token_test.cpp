// SPDX-License-Identifier: MIT
#include "chicane/net/http_response.hpp"
#include "support/chicane_test.hpp"

namespace chicane::net {
namespace {

TEST(Token, IsLongFitsIntoALinkAndIsNeverTheSame) {
  std::set<std::string> seen;
  for (int i = 0; i < 1000; ++i) {
    const Result<std::string> token = make_token();
    ASSERT_TRUE(token) << token.error().message;
    EXPECT_EQ(token->size(), 32U);  // 6 bits each
    EXPECT_EQ(token->find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_"),
              std::string::npos);
    seen.insert(*token);
  }
  EXPECT_EQ(seen.size(), 1000U);
}

TEST(Token, IsTheSameLetterForLetterOnly) {
  EXPECT_TRUE(is_token("abc", "abc"));
  for (const char* given : {"", "ab", "abcd", "abC", "bbc", "xyz"})
    EXPECT_FALSE(is_token(given, "abc")) << given;
  EXPECT_FALSE(is_token("", ""));
}

}  // namespace
}  // namespace chicane::net
