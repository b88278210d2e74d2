// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

/// Text of pages and tables.
namespace chicane::sweep {

/// For HTML, within an element or a quoted attribute.
[[nodiscard]] std::string escaped(std::string_view text);
/// The beginning of a page with its title as heading.
[[nodiscard]] std::string page_head(std::string_view title);
/// A value of RFC 4180, in quotes where it has to be.
[[nodiscard]] std::string csv_cell(const std::string& text);

}  // namespace chicane::sweep
