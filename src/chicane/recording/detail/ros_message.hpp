// SPDX-License-Identifier: MIT
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

/// The content of a message: all elements of each field, in their order. Fields of nested messages have their
/// path as name: "poses.pose.position.x" holds the x of all poses.
struct RosContent {
  std::map<std::string, std::vector<double>, std::less<>> numbers{};
  std::map<std::string, std::vector<std::string>, std::less<>> texts{};

  /// First element of a field; `missing` if it has none.
  [[nodiscard]] double number(std::string_view name, double missing = 0.0) const;
  [[nodiscard]] std::string text(std::string_view name) const;
  /// All elements of a field; may be empty.
  [[nodiscard]] const std::vector<double>& list(std::string_view name) const;
};

/// Reads CDR messages (XCDR1) by the definition that their recording holds: one reader for all
/// versions of a message.
class RosReader {
 public:
  /// Reader for a `definition` in MCAP's "ros2msg" form: the message, then each type it refers to behind a
  /// line of `=` and "MSG: NAME". kParse for a type that is not defined in it.
  [[nodiscard]] static Result<RosReader> create(std::string_view definition);

  /// Content of a message. kParse for bytes that end too early.
  [[nodiscard]] Result<RosContent> read(std::string_view bytes) const;

 private:
  struct Field {
    std::string type{}, name{};
    enum class Many { kOne, kFixed, kCounted } many = Many::kOne;
    std::size_t count = 1;
  };
  [[nodiscard]] bool read_type(const std::string& type, const std::string& name, protocol::CdrSource& source,
                               int depth, RosContent& content) const;

  std::map<std::string, std::vector<Field>, std::less<>> types_{};  ///< by type; "" is the message
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
