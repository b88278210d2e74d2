// SPDX-License-Identifier: MIT
// Our own ROS 2 messages as lists of rows, from which bytes and definitions are made.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "chicane/protocol/detail/cdr_archive.hpp"
#include "chicane/protocol/ros_messages.hpp"
#include "chicane/telemetry/frame.hpp"

namespace chicane::protocol {

using Numbers = std::vector<double>;
using Texts = std::vector<std::string>;

/// Visitor of rows that writes their values as bytes.
class WrittenRows {
 public:
  void title(std::string_view /*text*/) {}
  void operator()(std::string_view /*name*/, std::string_view /*meaning*/, const auto& value) { to_(value); }
  [[nodiscard]] std::string bytes() { return to_.bytes(); }

 private:
  WritingArchive to_;
};

/// Visitor of rows that reads their values from bytes of another program.
class ReadRows {
 public:
  explicit ReadRows(std::string_view bytes) : from_{bytes} {}
  void operator()(std::string_view /*name*/, std::string_view /*meaning*/, auto& value) { from_(value); }
  void operator()(std::string_view /*name*/, std::string_view /*meaning*/, StampNs& stamp) {
    from_.time(stamp.nanoseconds);
  }
  [[nodiscard]] bool ok() const { return from_.ok(); }
  [[nodiscard]] bool is_at_end() const { return from_.is_at_end(); }

 private:
  ReadingArchive from_;
};

/// Visitor of rows that writes the definition of a message: a declaration in each line, and its meaning as a
/// comment.
class DefinedRows {
 public:
  /// `about`: sentence at the top; `width`: column at which meanings begin.
  explicit DefinedRows(std::string_view about, int width = 39);
  /// Begins a group of rows.
  void title(std::string_view text);
  template <class Value>
  void operator()(std::string_view name, std::string_view meaning, const Value& value) {
    line(std::string(type_of(value)).append(" ").append(name), meaning);
  }
  /// Adds a line: a field or a constant.
  void line(const std::string& declaration, std::string_view meaning);
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  static std::string_view type_of(Stamp) { return "builtin_interfaces/Time"; }
  static std::string_view type_of(std::string_view) { return "string"; }
  static std::string_view type_of(const Texts&) { return "string[]"; }
  static std::string_view type_of(const Numbers&) { return "float64[]"; }
  static std::string_view type_of(const std::array<double, 3>&) { return "float64[3]"; }
  static std::string_view type_of(bool) { return "bool"; }
  static std::string_view type_of(std::int8_t) { return "int8"; }
  static std::string_view type_of(std::uint32_t) { return "uint32"; }
  static std::string_view type_of(std::uint64_t) { return "uint64"; }
  static std::string_view type_of(double) { return "float64"; }

  int width_;
  std::string text_;
};

/// Bytes of the rows that `rows_of` passes to a visitor.
[[nodiscard]] std::string written(auto rows_of) {
  WrittenRows rows;
  rows_of(rows);
  return rows.bytes();
}

/// Message of chicane_msgs.
struct OwnMessage {
  std::string_view name;   ///< "chicane_msgs/Run"
  std::string definition;  ///< text in ROS 2's .msg language
  /// Bytes of the message for a frame of a run; null: the message is not made from frames.
  std::string (*encode)(const telemetry::Frame& frame, const Run& run) = nullptr;
};

/// All messages of chicane_msgs.
[[nodiscard]] const std::vector<OwnMessage>& own_messages();

/// Road and car as foxglove_msgs/msg/SceneUpdate, for the 3D panels of Foxglove and Lichtblick: the road in
/// the frame `map`, the car in `base_link`, with which it moves. The bytes do not depend on `frame`.
[[nodiscard]] std::string encode_scene(const telemetry::Frame& frame, const Run& run);

}  // namespace chicane::protocol
