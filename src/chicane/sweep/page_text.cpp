// SPDX-License-Identifier: MIT
#include "chicane/sweep/page_text.hpp"

#include <fmt/format.h>

namespace chicane::sweep {

std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '&':
        result += "&amp;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

std::string page_head(std::string_view title) {
  return fmt::format(
      "<!doctype html><html lang=en><meta charset=utf-8><meta name=viewport content='width=device-width'>"
      "<title>{0}</title><style>body{{font:15px/1.5 system-ui,sans-serif;max-width:72rem;margin:2rem "
      "auto;padding:0 1rem;color:#1c2430;background:#fff}}table{{border-collapse:collapse;margin:.5rem 0 "
      "1.5rem}}td,th{{padding:.15rem .6rem;text-align:right;border-bottom:1px solid "
      "#dde3ea}}th{{font-weight:600}}td:first-child,th:first-child{{text-align:left}}"
      "code{{font:12px ui-monospace,monospace;overflow-wrap:anywhere}}.map td{{border:1px solid "
      "#fff;min-width:2.6rem;text-align:center}}.map td.mark{{outline:3px solid #1c2430;outline-offset:-3px;"
      "font-weight:700}}.scroll{{overflow-x:auto}}figure{{margin:.5rem 0 1.5rem;display:inline-block}}"
      "figcaption{{font-size:13px}}</style><h1>{0}</h1>",
      escaped(title));
}

std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

}  // namespace chicane::sweep
