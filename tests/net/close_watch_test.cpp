// SPDX-License-Identifier: MIT
#include "chicane/net/detail/close_watch.hpp"

#include <gtest/gtest.h>

#include <string>

#include "net/raw_socket.hpp"

namespace chicane::net {
namespace {

using test::RawSocket;

TEST(CloseWatch, KnowsTheStatusesThatMayBeSent) {
  std::string changes;
  for (unsigned status = 1; status < 65536; ++status) {
    if (may_be_sent(status) != may_be_sent(status - 1)) changes += std::to_string(status) + " ";
  }
  EXPECT_FALSE(may_be_sent(0));
  EXPECT_EQ(changes, "1000 1004 1007 1014 3000 5000 ");
}

TEST(CloseWatch, JudgesAStatusBeforeItsReason) {
  EXPECT_EQ(answer_to_close(""), std::nullopt);
  EXPECT_EQ(answer_to_close("\x03"), 1002);
  EXPECT_EQ(answer_to_close("\x03\xe8"), std::nullopt);
  EXPECT_EQ(answer_to_close("\x03\xe8\xff"), 1007);
  EXPECT_EQ(answer_to_close("\x13\x88\xff"), 1002);
}

TEST(CloseWatch, FindsTheCloseFrameHoweverTheBytesAreCut) {
  const std::string wrong("\x13\x88", 2);
  const std::string bytes = RawSocket::masked("") + RawSocket::masked(wrong) +
                            RawSocket::masked(std::string(200, '\x88'), 2) +
                            RawSocket::masked(std::string(70'000, '\x88'), 2) + RawSocket::masked(wrong, 8);
  for (const std::size_t piece : {1UL, 2UL, 3UL, 7UL, 1000UL, bytes.size()}) {
    CloseWatch watch;
    for (std::size_t i = 0; i < bytes.size(); i += piece) {
      const auto answer = watch.take(std::string_view(bytes).substr(i, piece));
      EXPECT_EQ(answer.has_value(), i + piece >= bytes.size()) << piece << " " << i;
    }
  }
}

TEST(CloseWatch, LeavesACloseFrameThatIsTooLongToBeast) {
  CloseWatch watch;
  EXPECT_EQ(watch.take(RawSocket::masked(std::string(126, '\xff'), 8)), std::nullopt);
}

}  // namespace
}  // namespace chicane::net
