// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "net/raw_socket.hpp"
#include "net/recorder.hpp"

namespace chicane::net {
namespace {

using test::RawSocket;
using test::Recorder;
using test::upgraded;
using testing::HasSubstr;

std::string status(unsigned code) { return {static_cast<char>(code >> 8U), static_cast<char>(code)}; }

/// The status of the one close frame that answers a close frame with this payload.
std::string answer_to_close(const Recorder& recorder, const std::string& payload) {
  RawSocket socket = upgraded(recorder.port());
  socket.send(RawSocket::masked(payload, 8));
  const auto frame = socket.frame();
  if (!frame || frame->opcode != 8) return "none";
  EXPECT_EQ(socket.rest(), "");
  return frame->payload.substr(0, 2);
}

TEST(CloseFrame, AnswersAClosingStatusThatNobodyMaySendWithAProtocolError) {
  Recorder recorder;
  for (const unsigned code : {0U, 999U, 1004U, 1005U, 1006U, 1015U, 1016U, 2999U, 5000U, 12345U, 65535U})
    EXPECT_EQ(answer_to_close(recorder, status(code) + "why"), status(1002)) << code;
  for (const unsigned code : {1000U, 1001U, 1011U, 3000U, 4999U})
    EXPECT_EQ(answer_to_close(recorder, status(code) + "why"), status(code)) << code;
  EXPECT_EQ(answer_to_close(recorder, "\x03"), status(1002));
}

TEST(CloseFrame, AnswersAClosingReasonThatIsNoUtf8WithABadPayload) {
  Recorder recorder;
  EXPECT_EQ(answer_to_close(recorder, status(1000) + "\xff"), status(1007));
  EXPECT_EQ(answer_to_close(recorder, status(4000) + "torn \xe2\x82"), status(1007));
  EXPECT_EQ(answer_to_close(recorder, status(5000) + "\xff"), status(1002));
  EXPECT_EQ(answer_to_close(recorder, status(1000) + "gr\xc3\xbc\xc3\x9f"), status(1000));
  EXPECT_THAT(recorder.closed(4).at(0), HasSubstr("breaks RFC 6455"));
}

TEST(CloseFrame, FindsAWrongCloseBehindMessagesAndInPieces) {
  Recorder recorder;
  RawSocket socket = upgraded(recorder.port());
  const std::string bytes = RawSocket::masked("hello") + RawSocket::masked(std::string(300, 'x')) +
                            RawSocket::masked(status(1000) + "\xff", 8);
  for (const char byte : bytes) socket.send({&byte, 1});
  const auto frame = socket.frame();
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->opcode, 8);
  EXPECT_EQ(frame->payload.substr(0, 2), status(1007));
}

TEST(CloseFrame, AnswersAWrongCloseWhileItSends) {
  Recorder recorder;
  RawSocket socket = upgraded(recorder.port());
  const ConnectionId id = recorder.opened(1).front();
  const auto message = std::make_shared<const std::string>(4'000'000, 'x');
  for (int i = 0; i < 4; ++i) recorder.server().send(id, message, false, Delivery::kReliable, 0);
  socket.send(RawSocket::masked(status(6000), 8));
  std::vector<RawSocket::Frame> frames;
  while (const auto frame = socket.frame()) frames.push_back(*frame);
  ASSERT_FALSE(frames.empty());
  EXPECT_EQ(frames.back().opcode, 8);
  EXPECT_EQ(frames.back().payload.substr(0, 2), status(1002));
}

}  // namespace
}  // namespace chicane::net
