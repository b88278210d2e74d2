// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "chicane/net/server.hpp"
#include "chicane/recording/html_report.hpp"

namespace chicane::live {

/// The files of the dashboard, gzip-compressed inside the program (target chicane_web_assets,
/// cmake/EmbedWeb.cmake). A program built without Node holds one plain page that says so.
[[nodiscard]] std::vector<net::Asset> embedded_assets();

/// The page that draws reports of recordings (recording/html_report.hpp) and documents
/// (protocol/report_document.hpp).
[[nodiscard]] recording::ReportBundle document_bundle();

}  // namespace chicane::live
