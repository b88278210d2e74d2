// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <string>

#include "net/raw_socket.hpp"
#include "net/recorder.hpp"

namespace chicane::net {
namespace {

using test::RawSocket;
using test::Recorder;
using test::upgraded;

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

TEST(CloseFrame, EchoesAStatusAndAnswersABrokenFrameWithAProtocolError) {
  Recorder recorder;
  for (const unsigned code : {1000U, 1001U, 1011U, 3000U, 4999U})
    EXPECT_EQ(answer_to_close(recorder, status(code) + "why"), status(code)) << code;
  for (const std::string& broken :
       {status(999) + "why", status(1006), std::string("\x03"), status(1000) + "\xff"})
    EXPECT_EQ(answer_to_close(recorder, broken), status(1002)) << broken;
}

}  // namespace
}  // namespace chicane::net
