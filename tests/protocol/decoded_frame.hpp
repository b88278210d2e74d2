// SPDX-License-Identifier: MIT
#pragma once

#include "chicane/protocol/ros_messages.hpp"
#include "protocol/cdr_reader.hpp"
#include "protocol/message_definition.hpp"
#include "support/chicane_test.hpp"

namespace chicane::test {

/// Fields by name, each with its elements: one, or those of an array.
using Values = std::map<std::string, std::vector<double>>;

inline double read_one(CdrReader& reader, const std::string& type) {
  if (type == "bool") return reader.get<std::uint8_t>();
  if (type == "int8") return reader.get<std::int8_t>();
  if (type == "uint8") return reader.get<std::uint8_t>();
  if (type == "int32") return reader.get<std::int32_t>();
  if (type == "uint32") return reader.get<std::uint32_t>();
  if (type == "uint64") return static_cast<double>(reader.get<std::uint64_t>());
  if (type == "builtin_interfaces/Time") return reader.seconds();
  EXPECT_EQ(type, "float64");
  return reader.number();
}

/// The fields of a frame by name, read as the definition says that is sent with it.
inline Values decoded(const telemetry::Frame& frame) {
  const std::string bytes = protocol::ros_topics().front().encode(frame, protocol::Run{});
  CdrReader reader{bytes};
  Values values;
  for (const MessageLine& line : message_lines(protocol::ros_schema("chicane_msgs/msg/Frame"))) {
    if (!line.constant.empty()) continue;
    EXPECT_FALSE(values.contains(line.name)) << line.name << " stands twice";
    const std::uint32_t count = line.array.empty() ? 1 : reader.get<std::uint32_t>();
    std::vector<double>& elements = values[line.name];
    for (std::uint32_t i = 0; i < count; ++i) elements.push_back(read_one(reader, line.type));
  }
  EXPECT_TRUE(reader.is_at_end());
  return values;
}

}  // namespace chicane::test
