// SPDX-License-Identifier: MIT
// Reader of ROS 2 messages by the definition that a recording holds, for fields by name.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/telemetry/mcap.hpp"

namespace chicane::protocol {
class CdrSource;
}

namespace chicane::recording {

/// Content of a message: all elements of each field, in order. The name of a field in a nested message is its
/// path: "poses.pose.position.x" holds the x of all poses.
struct RosContent {
  std::map<std::string, std::vector<double>, std::less<>> numbers{};     ///< numeric fields by name
  std::map<std::string, std::vector<std::string>, std::less<>> texts{};  ///< text fields by name

  /// First element of a field; `missing` if it has none.
  [[nodiscard]] double number(std::string_view name, double missing = 0.0) const;
  /// First element of a text field; empty if it has none.
  [[nodiscard]] std::string text(std::string_view name) const;
  /// All elements of a field; may be empty.
  [[nodiscard]] const std::vector<double>& list(std::string_view name) const;
};

/// Reader of CDR messages (XCDR1) by the definition in their recording, which fits any version of a message.
class RosReader {
 public:
  /// Creates a reader for a `definition` in MCAP's form "ros2msg": the message, then each type that it refers
  /// to, after a line of `=` and a line "MSG: NAME". kParse for a type without a definition.
  [[nodiscard]] static Result<RosReader> create(std::string_view definition);

  /// Content of a message. kParse for bytes that end too early.
  [[nodiscard]] Result<RosContent> read(std::string_view bytes) const;

 private:
  /// Field of a message.
  struct Field {
    std::string type{}, name{};
    enum class Many { kOne, kFixed, kCounted } many = Many::kOne;  ///< kCounted: the message has the count
    std::size_t count = 1;                                         ///< elements of kOne and kFixed
  };
  /// Field by its line in a definition.
  [[nodiscard]] static Field field_of(std::string type, std::string name);
  /// Reads a value of a type at the source's position into `content`, under `name`. False for bytes that end.
  [[nodiscard]] bool read_type(const std::string& type, const std::string& name, protocol::CdrSource& source,
                               int depth, RosContent& content) const;

  std::map<std::string, std::vector<Field>, std::less<>>
      types_{};  ///< fields by type; "": the message itself
};

/// Readers of the channels of one recording, each made at the first message of its channel.
class RosReaders {
 public:
  /// Fails as RosReader::create() and read() do; a fault of the bytes names the topic.
  [[nodiscard]] Result<RosContent> read(const telemetry::McapMessage& message);

 private:
  std::map<std::uint16_t, RosReader> readers_{};  ///< readers by channel number
};

}  // namespace chicane::recording
