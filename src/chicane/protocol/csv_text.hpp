// SPDX-License-Identifier: MIT
// Lines of text files and their fields: for tables of roads, of cones and of logs.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "chicane/base/text.hpp"

namespace chicane::protocol {

/// Text without blanks at both ends.
inline std::string_view trim(std::string_view text) {
  constexpr std::string_view kBlank = " \t\v\f\r";
  const std::size_t begin = text.find_first_not_of(kBlank);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlank) - begin + 1);
}

/// Separator of a line's fields: semicolon, comma or tab, the first of these that occurs; else a blank.
inline char separator_of(std::string_view line) {
  for (const char candidate : {';', ',', '\t'}) {
    if (line.find(candidate) != std::string_view::npos) return candidate;
  }
  return ' ';
}

/// Fields of a line, trimmed and without quotes; several blanks separate as one does.
inline std::vector<std::string_view> split(std::string_view line, char separator) {
  std::vector<std::string_view> fields;
  std::size_t begin = 0;
  while (begin <= line.size()) {
    const std::size_t end = std::min(line.find(separator, begin), line.size());
    std::string_view field = trim(line.substr(begin, end - begin));
    if (field.size() >= 2 && field.front() == '"' && field.back() == '"')
      field = trim(field.substr(1, field.size() - 2));
    if (separator != ' ' || !field.empty()) fields.push_back(field);
    begin = end + 1;
  }
  return fields;
}

/// Finite number written by a text, also with a plus sign; none for other texts.
inline std::optional<double> number(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  return number_in(text);
}

/// Finite number with a decimal point, or with a decimal comma where fields are separated otherwise.
inline std::optional<double> number(std::string_view text, char separator) {
  const std::size_t comma = text.find(',');
  constexpr std::size_t kLongest = 40;  // [byte] of a number with a comma; chosen: bounds the copy
  if (separator == ',' || comma == std::string_view::npos || text.size() > kLongest) return number(text);
  std::string with_point{text};
  with_point[comma] = '.';
  return text.find('.') == std::string_view::npos ? number(with_point) : std::nullopt;
}

/// Whether a text is a number, finite or not, or an empty field: rows have such fields, headers have none.
inline bool stands_for_a_number(std::string_view text) {
  return text.empty() || number(text) || text == "nan" || text == "NaN" || text == "inf" || text == "-inf" ||
         text == "None";
}

/// Whether a word may name a column: "v_mps", "x[m]".
inline bool is_name(std::string_view text) {
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  const auto may_follow = [&](char c) {
    return is_letter(c) || (c >= '0' && c <= '9') ||
           std::string_view("[]()/.-").find(c) != std::string_view::npos;
  };
  return !text.empty() && is_letter(text.front()) && std::all_of(text.begin(), text.end(), may_follow);
}

/// Lines of a text, trimmed, without a byte-order mark. Lines end by LF, CRLF or CR.
class CsvLines {
 public:
  explicit CsvLines(std::string_view text) : rest_{text} {
    if (rest_.starts_with("\xef\xbb\xbf")) rest_.remove_prefix(3);
  }
  /// Next line; none after the last one.
  std::optional<std::string_view> next() {
    if (rest_.empty()) return std::nullopt;
    ++number_;
    const std::size_t end = std::min(rest_.find_first_of("\r\n"), rest_.size());
    const std::string_view line = trim(rest_.substr(0, end));
    rest_.remove_prefix(std::min(rest_.size(), end + (rest_.substr(end, 2) == "\r\n" ? 2U : 1U)));
    return line;
  }
  /// Number of the line that next() returned, from 1.
  [[nodiscard]] int number() const noexcept { return number_; }

 private:
  std::string_view rest_;  ///< text after the last line
  int number_ = 0;         ///< number of the last line
};

/// Whether a word is in a list of words that has a blank before and after each: " x y_m ".
inline bool is_among(std::string_view word, std::string_view words) {
  return words.find(' ' + std::string{word} + ' ') != std::string_view::npos;
}

}  // namespace chicane::protocol
