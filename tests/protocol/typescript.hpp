// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

namespace chicane::test {

/// TypeScript for a message of chicane_msgs: an interface with the comments of its definition, an object for
/// each set of constants (Frame.rung: RUNG), and UNKNOWN_..., what the message says when nothing is known.
/// `name` is the interface's, `schema` as ros_schema() gives it. Formatted as Biome wants it.
[[nodiscard]] std::string typescript(std::string_view name, std::string_view schema);

/// web/src/protocol/messages.ts: all messages of chicane_msgs that are among ros_topics(), and the names of
/// the numbers of a frame.
[[nodiscard]] std::string typescript_messages();

}  // namespace chicane::test
