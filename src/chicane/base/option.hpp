// SPDX-License-Identifier: MIT
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

/// `value` in [low, high]; nothing when it is outside. What lies beyond a border by no more than the rounding
/// of single precision, a millionth of the larger border (or of 1), is the border: programs that compute with
/// floats mean it. Not-a-number is outside. Requires finite low <= high.
[[nodiscard]] inline std::optional<double> within(double value, double low, double high) noexcept {
  const double rounding = 1e-6 * std::max({1.0, std::fabs(low), std::fabs(high)});
  if (!(value >= low - rounding && value <= high + rounding)) return std::nullopt;
  return std::clamp(value, low, high);
}

// Settings: each options struct has a table of its fields with name, unit, range and meaning, beside the code
// that uses them. Configuration keys, command line, range checks and docs/reference/configuration.md follow
// from these rows.

/// Unit of a number outside C++, where keys carry it as a suffix; inside all is SI. SI value = value outside
/// · factor / divisor.
struct Unit {
  std::string_view name;    ///< unit for people: "m/s", "ms", "deg"; empty for pure numbers
  std::string_view suffix;  ///< the end of the key: "_mps", "_ms", "_deg"; empty where the name needs none
  double factor = 1.0;
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
/// Unit of weights and gains: shown to people; the key names the weighed quantity and has no suffix.
[[nodiscard]] constexpr Unit per(std::string_view name) noexcept { return {name, "", 1.0, 1.0}; }
}  // namespace unit

enum class OptionKind { kNumber, kInteger, kBool, kChoice, kText };

/// A number or integer is double, a choice or text std::string.
using OptionValue = std::variant<double, bool, std::string>;

/// One row: a field of some options struct. Made by option<&PidOptions::integral_gain>(...).
struct Option {
  std::string_view name;  ///< name of the field, without its unit: "speed_reference"
  OptionKind kind = OptionKind::kNumber;
  Unit unit;
  double minimum = 0.0;  ///< least value in `unit`, allowed itself; numbers and integers only
  double maximum = 0.0;
  std::string_view meaning;                            ///< one sentence
  std::span<const std::string_view> choices{};         ///< names in the order of the enum, if it is one
  bool may_be_infinite = false;                        ///< accepts "inf" (no limit) beside [minimum, maximum]
  OptionValue (*read)(const void*) = nullptr;          ///< reads the field: SI, an enum as its number
  void (*write)(void*, const OptionValue&) = nullptr;  ///< the same way

  [[nodiscard]] constexpr Option or_infinite() const noexcept {
    Option copy = *this;
    copy.may_be_infinite = true;
    return copy;
  }
};

/// Two options of a struct that are each in range and exclude each other.
struct OptionContradiction {
  std::string_view option;  ///< the one to change: Option::name
  std::string message;      ///< "got 50 ms, expected ..."
};

namespace detail {
template <class Pointer>
struct MemberPointer;
template <class Struct, class Member>
struct MemberPointer<Member Struct::*> {
  using Owner = Struct;
};

/// The way to a field through members: &PidOptions::speed, &SpeedHoldOptions::speed_gain.
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

/// A number or an integer in [minimum, maximum] `unit`.
template <auto... Members>
[[nodiscard]] constexpr Option option(std::string_view name, Unit unit, double minimum, double maximum,
                                      std::string_view meaning) {
  using Access = detail::OptionAccess<Members...>;
  static_assert(Access::kind() == OptionKind::kNumber || Access::kind() == OptionKind::kInteger);
  return {name, Access::kind(), unit, minimum, maximum, meaning, {}, false, Access::read, Access::write};
}
/// A switch or a text.
template <auto... Members>
[[nodiscard]] constexpr Option option(std::string_view name, std::string_view meaning) {
  using Access = detail::OptionAccess<Members...>;
  static_assert(Access::kind() == OptionKind::kBool || Access::kind() == OptionKind::kText);
  return {name, Access::kind(), {}, 0.0, 0.0, meaning, {}, false, Access::read, Access::write};
}
/// One of `choices`: a text, or an enum counted from 0. They outlive the row.
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

/// The value in the option's unit; `owner` is the struct that the row was made for, here and below.
[[nodiscard]] OptionValue get(const Option& option, const void* owner);
/// Sets a value. Fails with refusal(), and changes nothing, for a wrong type or a value out of range; `key`
/// is the name in the message.
[[nodiscard]] Result<void> set(const Option& option, std::string_view key, void* owner,
                               const OptionValue& value);

/// Fails with refusal() for the first option that is out of its range; not-a-number is.
[[nodiscard]] Result<void> check_options(std::string_view group, std::span<const Option> options,
                                         const void* owner);

}  // namespace chicane
