// SPDX-License-Identifier: MIT
// CDR, the bytes of ROS 2 messages: a reader, a writer, and archives by which a message names its fields
// once.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "chicane/base/math.hpp"
#include "chicane/model/state.hpp"
#include "chicane/protocol/frame_fields.hpp"
#include "chicane/protocol/ros_messages.hpp"

namespace chicane::protocol {

/// Reader of one message of another program: CDR (XCDR1) of either byte order with its four-byte header.
/// Reads beyond the end give zero, and ok() is false from then on.
class CdrSource {
 public:
  explicit CdrSource(std::string_view bytes) : bytes_{bytes} {
    ok_ = bytes.size() >= kHeader && bytes[0] == '\0' && (bytes[1] == '\0' || bytes[1] == '\1');
    swaps_ = ok_ && bytes[1] == '\0';
  }

  /// Whether every read so far succeeded.
  [[nodiscard]] bool ok() const { return ok_; }
  [[nodiscard]] bool is_at_end() const { return ok_ && at_ == bytes_.size(); }

  /// Number of type T, aligned to its size.
  template <class T>
  T get() {
    static_assert(std::is_arithmetic_v<T>);
    const std::size_t past = (at_ - kHeader) % sizeof(T);
    skip(past == 0 ? 0 : sizeof(T) - past);
    std::array<char, sizeof(T)> raw{};
    if (!take(raw.data(), sizeof(T))) return T{};
    if (swaps_) std::reverse(raw.begin(), raw.end());
    return std::bit_cast<T>(raw);
  }
  double number() { return get<double>(); }
  /// Boolean; any byte but zero is true.
  bool flag() { return get<std::uint8_t>() != 0; }

  /// String, without the zero at its end.
  std::string_view text() {
    const auto size = get<std::uint32_t>();
    if (!ok_ || size > bytes_.size() - at_) return fail();
    const std::string_view value = bytes_.substr(at_, size);
    at_ += size;
    if (value.empty()) return value;  // some writers send no zero for an empty string
    if (value.back() != '\0') return fail();
    return value.substr(0, value.size() - 1);
  }

  /// Number of elements of a sequence with at least `smallest` bytes each; 0 if so many cannot follow.
  std::uint32_t count(std::size_t smallest) {
    const auto value = get<std::uint32_t>();
    if (ok_ && value <= (bytes_.size() - at_) / smallest) return value;
    ok_ = ok_ && value == 0;
    return 0;
  }

  /// builtin_interfaces/Time in nanoseconds.
  std::int64_t stamp() {
    const auto seconds = get<std::int32_t>();
    return std::int64_t{seconds} * 1'000'000'000 + get<std::uint32_t>();
  }

 private:
  static constexpr std::size_t kHeader = 4;

  std::string_view fail() {
    ok_ = false;
    return {};
  }
  void skip(std::size_t size) {
    if (ok_ && size <= bytes_.size() - at_) {
      at_ += size;
    } else {
      ok_ = false;
    }
  }
  bool take(char* to, std::size_t size) {
    if (!ok_ || size > bytes_.size() - at_) return ok_ = false;
    std::memcpy(to, bytes_.data() + at_, size);
    at_ += size;
    return true;
  }

  std::string_view bytes_;
  std::size_t at_ = kHeader;  ///< position of the next byte
  bool ok_ = false;           ///< see ok()
  bool swaps_ = false;        ///< the message is big-endian
};

/// Time since 1970 in a message.
struct StampNs {
  std::int64_t nanoseconds = 0;
};

/// Writer of one message: XCDR1 with its header, each primitive aligned to its size counted from the end of
/// the header (OMG DDSI-RTPS 2.3, chapter 10). Padding is zero, so that equal messages have equal bytes.
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
  /// Number of elements of a sequence.
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
  /// geometry_msgs/Quaternion of a yaw [rad].
  CdrWriter& orientation(double yaw) {
    return put(0.0, 0.0, chicane::sin(0.5 * yaw), chicane::cos(0.5 * yaw));
  }
  /// float64 fields that are zero.
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

// A message names its fields once, in order, in `fields(archive, message)`. The two archives below have the
// same functions: one writes fields, the other reads them.

/// Archive that writes.
class WritingArchive {
 public:
  /// Numbers, booleans, texts and poses, as they are.
  void operator()(const auto&... values) { (put(values), ...); }
  /// Numbers as another type.
  template <class Type>
  void as(const auto&... values) {
    (to_.put(static_cast<Type>(values)), ...);
  }
  /// builtin_interfaces/Time.
  void time(std::int64_t nanoseconds) { to_.stamp_ns(nanoseconds); }
  /// Values without a field in the struct: written, skipped when read.
  void constant(auto... values) { to_.put(values...); }
  /// Values at the end of a message: written, not read.
  void trailing(auto... values) { to_.put(values...); }
  /// float64 values without a field in the struct: written as zero, skipped when read.
  void zeros(int number) { to_.zeros(number); }
  /// Sequence of at most `capacity` elements of at least `smallest` bytes, by which a reader bounds its
  /// memory.
  template <class Item, class Each>
  void list(const std::vector<Item>& items, std::size_t /*smallest*/, std::size_t /*capacity*/, Each each) {
    to_.count(items.size());
    for (const Item& item : items) each(item);
  }
  template <class Item, class Each>
  void optional(const std::optional<Item>& item, Each each) {
    to_.put(item.has_value());
    if (item) each(*item);
  }
  [[nodiscard]] std::string bytes() { return to_.bytes(); }

 private:
  void put(const std::string& text) { to_.text(text); }
  void put(std::string_view text) { to_.text(text); }
  void put(const std::vector<std::string>& texts) { to_.texts(texts); }
  void put(const std::vector<double>& numbers) { to_.put(std::span<const double>(numbers)); }
  template <std::size_t kSize>
  void put(const std::array<double, kSize>& numbers) {
    for (const double number : numbers) to_.put(number);
  }
  void put(const model::Pose& pose) { to_.put(pose.x, pose.y, 0.0).orientation(pose.psi); }
  template <class Number>
  void put(const Number& value) {
    to_.put(value);
  }

  CdrWriter to_;
};

/// Archive that reads bytes of other programs.
class ReadingArchive {
 public:
  explicit ReadingArchive(std::string_view bytes) : from_{bytes} {}

  void operator()(auto&... values) { (get(values), ...); }
  template <class Type>
  void as(auto&... values) {
    ((values = static_cast<std::remove_reference_t<decltype(values)>>(from_.get<Type>())), ...);
  }
  void time(std::int64_t& nanoseconds) { nanoseconds = from_.stamp(); }
  template <class... Values>
  void constant(Values... /*values*/) {
    (static_cast<void>(from_.get<Values>()), ...);
  }
  void trailing(auto... /*values*/) {}
  void zeros(int number) {
    for (int i = 0; i < number; ++i) from_.number();
  }
  /// Sequence without a field in the struct.
  template <class Number>
  void skip_list() {
    for (std::uint32_t i = from_.count(sizeof(Number)); i > 0; --i) from_.get<Number>();
  }
  template <class Item, class Each>
  void list(std::vector<Item>& items, std::size_t smallest, std::size_t capacity, Each each) {
    const std::uint32_t count = from_.count(smallest);
    fits_ = fits_ && count <= capacity;
    for (std::uint32_t i = 0; i < count && ok(); ++i) each(items.emplace_back());
  }
  template <class Item, class Each>
  void optional(std::optional<Item>& item, Each each) {
    if (from_.flag()) each(item.emplace());
  }
  [[nodiscard]] bool ok() const { return fits_ && from_.ok(); }
  /// Whether every read succeeded and nothing is left.
  [[nodiscard]] bool is_at_end() const { return fits_ && from_.is_at_end(); }

 private:
  void get(std::string& text) { text = from_.text(); }
  void get(std::vector<double>& numbers) {
    list(numbers, sizeof(double), kMostTexts, [&](double& number) { get(number); });
  }
  void get(std::vector<std::string>& texts) {
    list(texts, 4, kMostTexts, [&](std::string& text) { get(text); });
  }
  void get(bool& flag) { flag = from_.flag(); }
  /// Position in the plane, and yaw of an orientation that may also have roll and pitch.
  void get(model::Pose& pose) {
    pose.x = from_.number();
    pose.y = from_.number();
    from_.number();
    const double x = from_.number(), y = from_.number(), z = from_.number(), w = from_.number();
    pose.psi = chicane::atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z));
  }
  template <class Number>
  void get(Number& value) {
    value = from_.get<Number>();
  }

  static constexpr std::size_t kMostTexts = 1'000'000;  ///< limit of texts or numbers in one field

  CdrSource from_;
  bool fits_ = true;  ///< no list so far was longer than its capacity
};

/// Bytes of a message.
template <class Message>
[[nodiscard]] std::string encode(const Message& message) {
  WritingArchive archive;
  Message::fields(archive, message);
  return archive.bytes();
}

/// Message from its bytes; none for other bytes, and for a message whose is_sound() is false.
template <class Message>
[[nodiscard]] std::optional<Message> decode(std::string_view bytes) {
  ReadingArchive archive{bytes};
  std::optional<Message> message{std::in_place};
  Message::fields(archive, *message);
  bool is_sound = archive.ok();
  if constexpr (requires { message->is_sound(); }) is_sound = is_sound && message->is_sound();
  if (!is_sound) message.reset();
  return message;
}

}  // namespace chicane::protocol
