// SPDX-License-Identifier: MIT
// Numbers and words to text and back, the same in every locale.
#include "chicane/base/text.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <utility>

namespace chicane {
namespace {

/// `value` by std::to_chars, in the format of its further arguments.
std::string written(double value, auto... format) {
  std::array<char, 64> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, format...).ptr;
  return {buffer.data(), end};
}

/// Number written by the whole text.
template <class Number>
std::optional<Number> parse_whole(std::string_view text) noexcept {
  Number value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size() ? std::optional(value) : std::nullopt;
}

}  // namespace

std::optional<double> number_in(std::string_view text) noexcept {
  const std::optional<double> value = parse_whole<double>(text);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

std::optional<std::uint64_t> count_in(std::string_view text) noexcept {
  return parse_whole<std::uint64_t>(text);
}

Result<double> number_in(std::string_view key, std::string_view text, double low, double high) {
  const std::optional<double> value = number_in(text);
  // 1e-6: rounding of single precision, with which other programs compute their numbers.
  const auto rounding = [](double border) { return 1e-6 * std::max(1.0, std::fabs(border)); };
  if (value && *value >= low - rounding(low) && *value <= high + rounding(high))
    return std::clamp(*value, low, high);
  return fail(refusal(key, text, "a number in [" + number_text(low) + ", " + number_text(high) + "]"));
}

Error refusal(std::string_view key, std::string_view text, std::string_view expected, ErrorCode code) {
  std::string message(key);
  message.append(": got ").append(printable(text)).append(", expected ").append(expected);
  return {code, std::move(message)};
}

std::string number_text(double value) {
  const double magnitude = std::fabs(value);
  // No exponent from 1e-4 to 1e16: chosen because doubles have 16 digits, which need no more zeros there.
  const bool is_plain = magnitude == 0.0 || !std::isfinite(value) || (magnitude >= 1e-4 && magnitude < 1e16);
  return written(value, is_plain ? std::chars_format::fixed : std::chars_format::scientific);
}

std::string number_text(double value, int digits) {
  return written(value, std::chars_format::general, digits);
}

std::string printable(std::string_view text) {
  constexpr std::size_t kMost = 60;  // [byte] chosen: fits a line of a terminal with the message around it
  std::string shown(text.substr(0, kMost));
  std::replace_if(
      shown.begin(), shown.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; }, '?');
  return shown.empty() ? "nothing" : text.size() > kMost ? shown + "…" : shown;
}

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return result;
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    unsigned group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8U | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k) text += k <= count ? kDigits[group >> (18 - 6 * k) & 63U] : '=';
  }
  return text;
}

std::string joined(std::span<const std::string_view> words) {
  std::string text;
  for (const std::string_view word : words) text.append(text.empty() ? "" : ", ").append(word);
  return text;
}

}  // namespace chicane
