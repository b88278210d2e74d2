// SPDX-License-Identifier: MIT
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

/// Rows as bytes.
class WrittenRows {
 public:
  void title(std::string_view /*text*/) {}
  void operator()(std::string_view /*name*/, std::string_view /*meaning*/, const auto& value) { to_(value); }
  [[nodiscard]] std::string bytes() { return to_.bytes(); }

 private:
  WritingArchive to_;
};

/// Rows that another program wrote.
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

/// Rows as the definition of the message: meanings in one column.
class DefinedRows {
 public:
  /// `width`: columns of the declarations.
  explicit DefinedRows(std::string_view about, int width = 39);
  void title(std::string_view text);
  template <class Value>
  void operator()(std::string_view name, std::string_view meaning, const Value& value) {
    line(std::string(type_of(value)).append(" ").append(name), meaning);
  }
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

[[nodiscard]] std::string written(auto rows_of) {
  WrittenRows rows;
  rows_of(rows);
  return rows.bytes();
}

/// A message of chicane_msgs: a list of rows, name, meaning and value, from which its bytes and its
/// definition are made.
struct OwnMessage {
  std::string_view name;   ///< "chicane_msgs/Run"
  std::string definition;  ///< text in ROS 2's .msg language
  std::string (*encode)(const telemetry::Frame& frame, const Run& run) = nullptr;  ///< null: not of a frame
};

[[nodiscard]] const std::vector<OwnMessage>& own_messages();

/// Road and car as foxglove_msgs/msg/SceneUpdate, for the 3D panels of Foxglove and Lichtblick: the road in
/// `map`, the car in `base_link`, with which it moves. Nothing of it depends on the frame.
[[nodiscard]] std::string encode_scene(const telemetry::Frame& frame, const Run& run);

}  // namespace chicane::protocol
