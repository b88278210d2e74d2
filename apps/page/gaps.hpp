// SPDX-License-Identifier: MIT
// Parts of the C++20 library that Emscripten 3.1.6 (LLVM 13) lacks. The compiler includes this file before
// all others.
#pragma once

#include <bit>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <string>
#include <system_error>
#include <type_traits>

#if defined(_LIBCPP_VERSION) && _LIBCPP_VERSION < 14000
namespace std {  // NOLINT(cert-dcl58-cpp): this version of the library does not define them

template <class To, class From>
requires(sizeof(To) == sizeof(From) && is_trivially_copyable_v<To> &&
         is_trivially_copyable_v<From>) constexpr To bit_cast(const From& from) noexcept {
  return __builtin_bit_cast(To, from);
}

/// Text of `value` by printf: with the fewest digits, from `least` to `most`, that read back the same number.
inline to_chars_result chicane_print(char* first, char* last, double value, const char* format, int least,
                                     int most) {
  char text[400];  // longest: 309 digits, or 330 decimals, with sign and point
  int size = 0;
  for (int digits = least; digits <= most; ++digits) {
    size = snprintf(text, sizeof(text), format, digits, value);
    if (strtod(text, nullptr) == value) break;
  }
  if (size > last - first) return {last, errc::value_too_large};
  memcpy(first, text, static_cast<size_t>(size));
  return {first + size, errc{}};
}

inline to_chars_result to_chars(char* first, char* last, double value, chars_format format, int digits) {
  const char* form = format == chars_format::scientific ? "%.*e"
                     : format == chars_format::fixed    ? "%.*f"
                                                        : "%.*g";
  return chicane_print(first, last, value, form, digits, digits);
}

inline to_chars_result to_chars(char* first, char* last, double value, chars_format format) {
  constexpr int kMostDigits = 17, kMostDecimals = 330;  // enough for any double above 1e-307
  if (format == chars_format::scientific) return chicane_print(first, last, value, "%.*e", 0, kMostDigits);
  return chicane_print(first, last, value, "%.*f", 0, kMostDecimals);
}

inline to_chars_result to_chars(char* first, char* last, double value) {
  return chicane_print(first, last, value, "%.*g", 1, 17);
}

/// Reads a decimal number as from_chars does: no space, no plus sign, no hexadecimal.
inline from_chars_result from_chars(const char* first, const char* last, double& value) {
  const string text(first, last);
  const size_t size = text.find_first_not_of("0123456789+-.eEinfatyINFATY");
  const string number = text.substr(0, size);
  if (number.empty() || number[0] == '+') return {first, errc::invalid_argument};
  char* end = nullptr;
  errno = 0;
  const double read = strtod(number.c_str(), &end);
  if (end == number.c_str()) return {first, errc::invalid_argument};
  const char* const stop = first + (end - number.c_str());
  if (errno == ERANGE) return {stop, errc::result_out_of_range};
  value = read;
  return {stop, errc{}};
}

}  // namespace std
#endif
