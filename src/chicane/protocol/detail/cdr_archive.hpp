// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "chicane/base/math.hpp"
#include "chicane/model/state.hpp"
#include "chicane/protocol/detail/cdr_source.hpp"
#include "chicane/protocol/detail/cdr_writer.hpp"

/// A message names its fields once, in order, in `fields(archive, message)`. One archive writes them, one
/// reads them.
namespace chicane::protocol {

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
  /// Values that nobody here reads.
  void constant(auto... values) { to_.put(values...); }
  /// Values at the end of a message that are left unread.
  void trailing(auto... values) { to_.put(values...); }
  void zeros(int number) { to_.zeros(number); }
  /// A sequence, of elements with at least `smallest` bytes.
  template <class Item, class Each>
  void list(const std::vector<Item>& items, std::size_t /*smallest*/, std::size_t /*capacity*/, Each each) {
    to_.count(items.size());
    for (const Item& item : items) each(item);
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

/// Reads bytes of other programs.
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
  /// A sequence that nobody here reads.
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
  [[nodiscard]] bool ok() const { return fits_ && from_.ok(); }

 private:
  void get(std::string& text) { text = from_.text(); }
  void get(std::vector<double>& numbers) {
    list(numbers, sizeof(double), kMostTexts, [&](double& number) { get(number); });
  }
  void get(std::vector<std::string>& texts) {
    list(texts, 4, kMostTexts, [&](std::string& text) { get(text); });
  }
  void get(bool& flag) { flag = from_.flag(); }
  /// Position and the yaw of an orientation that may also lean.
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

  static constexpr std::size_t kMostTexts = 1'000'000;

  CdrSource from_;
  bool fits_ = true;
};

/// The bytes of a message.
template <class Message>
[[nodiscard]] std::string encode(const Message& message) {
  WritingArchive archive;
  Message::fields(archive, message);
  return archive.bytes();
}

/// Nothing where the bytes are no such message, or it is not sound.
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
