// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "chicane/net/server.hpp"
#include "chicane/protocol/ros_messages.hpp"
#include "chicane/recording/html_report.hpp"
#include "chicane/road/track.hpp"
#include "chicane/run/closed_loop.hpp"

namespace chicane::live {

/// The road of a run, for viewers and recordings: name, length, lines.
void describe(const road::Track& track, protocol::Run& run);

/// Car, notices and where car and road come from; reads their files.
void describe(const scenario::Scenario& scenario, protocol::Run& run);

/// A run with our simulator, for viewers and recordings; without its limit.
[[nodiscard]] protocol::Run description(const run::ClosedLoop& loop);

/// The files of the dashboard, gzip-compressed inside the program (target chicane_web_assets,
/// cmake/EmbedWeb.cmake). A program built without Node holds one plain page with that message.
[[nodiscard]] std::vector<net::Asset> embedded_assets();

/// The page that draws reports of recordings (recording/html_report.hpp) and documents
/// (protocol/json.hpp).
[[nodiscard]] recording::ReportBundle document_bundle();

}  // namespace chicane::live
