// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>
#include <vector>

#include "chicane/net/server.hpp"

namespace chicane::runtime {

/// The files of the dashboard, gzip-compressed inside the program (target chicane_web_assets,
/// cmake/EmbedWeb.cmake). A program built without Node holds one plain page that says so.
[[nodiscard]] std::vector<net::Asset> embedded_assets();

/// The dashboard once more, in two files for one page (runtime/html_report.hpp); gzip-compressed. Empty in a
/// program that was built without Node.
struct ReportBundle {
  std::string_view script;
  std::string_view style;
};
[[nodiscard]] ReportBundle report_bundle();

}  // namespace chicane::runtime
