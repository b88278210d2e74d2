// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "chicane/base/math.hpp"
#include "chicane/protocol/frame_fields.hpp"
#include "chicane/protocol/ros_messages.hpp"

namespace chicane::protocol {

/// A time of a message [ns].
struct StampNs {
  std::int64_t nanoseconds = 0;
};

/// One message under construction: XCDR1 with its header, each primitive aligned to its size counted from the
/// end of the header (OMG DDSI-RTPS 2.3, chapter 10). Padding is zero, so equal messages have equal bytes.
class CdrWriter {
 public:
  static_assert(std::endian::native == std::endian::little);

  explicit CdrWriter(std::size_t expected_size = 512) { bytes_.reserve(expected_size); }

  template <class... Values>
  CdrWriter& put(Values... values) {
    (append(values), ...);
    return *this;
  }
  CdrWriter& text(std::string_view value) {
    count(value.size() + 1);
    bytes_.append(value).push_back('\0');
    return *this;
  }
  CdrWriter& count(std::size_t value) { return put(static_cast<std::uint32_t>(value)); }
  CdrWriter& texts(const std::vector<std::string>& values) {
    count(values.size());
    for (const std::string& value : values) text(value);
    return *this;
  }
  CdrWriter& stamp(double seconds) { return put(Stamp{seconds}); }
  CdrWriter& stamp_ns(std::int64_t nanoseconds) {
    const std::int64_t ns = nanoseconds < 0 ? 0 : nanoseconds;
    return put(static_cast<std::int32_t>(ns / 1'000'000'000), static_cast<std::uint32_t>(ns % 1'000'000'000));
  }
  CdrWriter& orientation(double yaw) {
    return put(0.0, 0.0, chicane::sin(0.5 * yaw), chicane::cos(0.5 * yaw));
  }
  CdrWriter& zeros(int number) {
    for (int i = 0; i < number; ++i) append(0.0);
    return *this;
  }
  [[nodiscard]] std::string bytes() { return std::move(bytes_); }

 private:
  static constexpr std::size_t kHeader = 4;

  template <class T>
  void append(T value) {
    static_assert(std::is_arithmetic_v<T>);
    while ((bytes_.size() - kHeader) % sizeof(T) != 0) bytes_.push_back('\0');
    bytes_.append(std::bit_cast<std::array<char, sizeof(T)>>(value).data(), sizeof(T));
  }
  void append(Stamp stamp) {
    const std::uint64_t ns = to_nanoseconds(stamp.seconds);
    append(static_cast<std::int32_t>(ns / 1'000'000'000U));
    append(static_cast<std::uint32_t>(ns % 1'000'000'000U));
  }
  void append(StampNs stamp) { stamp_ns(stamp.nanoseconds); }
  void append(std::span<const double> values) {
    count(values.size());
    for (const double value : values) append(value);
  }

  std::string bytes_{'\0', '\1', '\0', '\0'};
};

}  // namespace chicane::protocol
