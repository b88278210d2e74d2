// SPDX-License-Identifier: MIT
// Options: rows that describe the fields of settings (name, unit, range, meaning), and their use by key.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>

#include "chicane/base/math.hpp"
#include "chicane/base/result.hpp"

namespace chicane {

/// `value` in [low, high]; nothing when it is outside or not a number. A value beyond a border by no more
/// than the rounding of single precision, a millionth of the larger border (or of 1), becomes the border,
/// because programs that compute with floats send such values. Pre: finite low <= high.
[[nodiscard]] inline std::optional<double> within(double value, double low, double high) noexcept {
  const double rounding = 1e-6 * std::max({1.0, std::fabs(low), std::fabs(high)});
  if (!(value >= low - rounding && value <= high + rounding)) return std::nullopt;
  return std::clamp(value, low, high);
}

// Each options struct has a table of its fields, one Option a row, beside the code that uses them.
// Configuration keys, command line, range checks and docs/reference/configuration.md follow from these rows.

/// Unit of a number outside C++, where keys have it as a suffix. Inside C++ all values are SI: SI value =
/// value outside · factor / divisor.
struct Unit {
  std::string_view name;    ///< unit for people: "m/s", "ms", "deg"; empty for pure numbers
  std::string_view suffix;  ///< end of the key: "_mps", "_ms", "_deg"; empty where the name needs none
  double factor = 1.0;      ///< beside `divisor`, so that decimal values convert with one rounding fewer
  double divisor = 1.0;

  [[nodiscard]] constexpr double to_si(double outside) const noexcept { return outside * factor / divisor; }
  [[nodiscard]] constexpr double from_si(double si) const noexcept { return si * divisor / factor; }
};

namespace unit {
inline constexpr Unit kNone{};
inline constexpr Unit kMetre{"m", "_m"};
inline constexpr Unit kSecond{"s", "_s"};
inline constexpr Unit kMillisecond{"ms", "_ms", 1.0, 1000.0};
inline constexpr Unit kSpeed{"m/s", "_mps"};
inline constexpr Unit kAcceleration{"m/s²", "_mps2"};
inline constexpr Unit kDegree{"deg", "_deg", kPi / 180.0, 1.0};
inline constexpr Unit kDegreePerSecond{"deg/s", "_degps", kPi / 180.0, 1.0};
inline constexpr Unit kKilogram{"kg", "_kg"};
inline constexpr Unit kInertia{"kg m²", "_kgm2"};
inline constexpr Unit kPowerPerMass{"W/kg", "_wpkg"};
/// Unit of weights and gains, shown to people; the key has no suffix.
[[nodiscard]] constexpr Unit per(std::string_view name) noexcept { return {name, "", 1.0, 1.0}; }
}  // namespace unit

/// Kind of value of an option. A choice is one of a list of names.
enum class OptionKind { kNumber, kInteger, kBool, kChoice, kText };

/// Value of an option outside C++: double for numbers and integers, std::string for choices and texts.
using OptionValue = std::variant<double, bool, std::string>;

/// One row: the description of a field of an options struct. Made by option<&PidOptions::integral_gain>(...).
struct Option {
  std::string_view name;  ///< name of the field, without its unit: "speed_reference"
  OptionKind kind = OptionKind::kNumber;
  Unit unit;
  double minimum = 0.0;                         ///< least allowed value in `unit`; numbers and integers only
  double maximum = 0.0;                         ///< greatest allowed value in `unit`
  std::string_view meaning;                     ///< one sentence
  std::span<const std::string_view> choices{};  ///< names in the order of the enum, if it is one
  bool may_be_infinite = false;                 ///< accepts "inf" (no limit) beside [minimum, maximum]
  OptionValue (*read)(const void*) = nullptr;   ///< reads the field: SI, an enum as its number
  void (*write)(void*, const OptionValue&) = nullptr;  ///< sets the field: SI, an enum by its number

  /// The same row, which accepts "inf", too.
  [[nodiscard]] constexpr Option or_infinite() const noexcept {
    Option copy = *this;
    copy.may_be_infinite = true;
    return copy;
  }
};

/// Contradiction of two options of a struct, each of which is in range.
struct OptionContradiction {
  std::string_view option;  ///< Option::name of the option to change
  std::string message;      ///< "got 50 ms, expected ..."
};

namespace detail {
/// Struct to which a pointer to a member belongs.
template <class Pointer>
struct MemberPointer;
template <class Struct, class Member>
struct MemberPointer<Member Struct::*> {
  using Owner = Struct;
};

/// Access to a field by a chain of pointers to members: &PidOptions::speed, &SpeedHoldOptions::speed_gain.
template <auto First, auto... Rest>
struct OptionAccess {
  using Owner = typename MemberPointer<decltype(First)>::Owner;
  static auto& field(auto& owner) { return ((owner.*First).*....*Rest); }
  using Field = std::remove_reference_t<decltype(field(std::declval<Owner&>()))>;

  static constexpr OptionKind kind() {
    if (std::same_as<Field, bool>) return OptionKind::kBool;
    if (std::same_as<Field, std::string>) return OptionKind::kText;
    if (std::is_enum_v<Field>) return OptionKind::kChoice;
    return std::integral<Field> ? OptionKind::kInteger : OptionKind::kNumber;
  }
  static OptionValue read(const void* owner) {
    const Field& value = field(*static_cast<const Owner*>(owner));
    if constexpr (std::same_as<Field, bool> || std::same_as<Field, std::string>)
      return value;
    else
      return static_cast<double>(value);
  }
  static void write(void* owner, const OptionValue& value) {
    Field& target = field(*static_cast<Owner*>(owner));
    if constexpr (std::same_as<Field, bool> || std::same_as<Field, std::string>)
      target = std::get<Field>(value);
    else if constexpr (std::is_enum_v<Field>)
      target = static_cast<Field>(static_cast<int>(std::get<double>(value)));
    else
      target = static_cast<Field>(std::get<double>(value));
  }
};
}  // namespace detail

/// Row of a number or an integer in [minimum, maximum] `unit`.
template <auto... Members>
[[nodiscard]] constexpr Option option(std::string_view name, Unit unit, double minimum, double maximum,
                                      std::string_view meaning) {
  using Access = detail::OptionAccess<Members...>;
  static_assert(Access::kind() == OptionKind::kNumber || Access::kind() == OptionKind::kInteger);
  return {name, Access::kind(), unit, minimum, maximum, meaning, {}, false, Access::read, Access::write};
}
/// Row of a switch or a text.
template <auto... Members>
[[nodiscard]] constexpr Option option(std::string_view name, std::string_view meaning) {
  using Access = detail::OptionAccess<Members...>;
  static_assert(Access::kind() == OptionKind::kBool || Access::kind() == OptionKind::kText);
  return {name, Access::kind(), {}, 0.0, 0.0, meaning, {}, false, Access::read, Access::write};
}
/// Row of one of `choices`: a text, or an enum counted from 0. `choices` outlives the row.
template <auto... Members>
[[nodiscard]] constexpr Option option(std::string_view name, std::span<const std::string_view> choices,
                                      std::string_view meaning) {
  using Access = detail::OptionAccess<Members...>;
  static_assert(Access::kind() == OptionKind::kChoice || Access::kind() == OptionKind::kText);
  return {name, OptionKind::kChoice, {}, 0.0, 0.0, meaning, choices, false, Access::read, Access::write};
}

/// The key of an option outside C++: "pid.speed_reference_mps"; without a group "latency_ms".
[[nodiscard]] std::string option_key(std::string_view group, const Option& option);
/// Expected value for messages: "an integer in [2, 200]", "a number in [0, 500] ms", "one of pid, stanley",
/// "true or false".
[[nodiscard]] std::string expectation(const Option& option);
/// Error of a value: "pid.integral_gain: got -1, expected a number in [0, 10] rad/(m s)".
[[nodiscard]] Error refusal(std::string_view key, std::string_view got, const Option& option);

/// Value of the field in the option's unit. `owner`, here and below, points to the struct that has the field.
[[nodiscard]] OptionValue get(const Option& option, const void* owner);
/// Sets a value. Fails with refusal(), and changes nothing, for a wrong type or a value out of range; `key`
/// is the name in the message.
[[nodiscard]] Result<void> set(const Option& option, std::string_view key, void* owner,
                               const OptionValue& value);

/// Fails with refusal() for the first option that is out of its range or not a number.
[[nodiscard]] Result<void> check_options(std::string_view group, std::span<const Option> options,
                                         const void* owner);

}  // namespace chicane
