// SPDX-License-Identifier: MIT
// Pages and files that the server of the dashboard answers to GET, and the description of a run for viewers.
#pragma once

#include <string>
#include <vector>

#include "chicane/live/live_settings.hpp"
#include "chicane/live/what_if.hpp"
#include "chicane/net/server.hpp"
#include "chicane/protocol/ros_messages.hpp"
#include "chicane/recording/html_report.hpp"
#include "chicane/road/track.hpp"
#include "chicane/run/closed_loop.hpp"
#include "chicane/wire/endpoint.hpp"

namespace chicane::live {

/// Recording that the dashboard opens.
struct ServedLog {
  std::string name;        ///< name for people: "run.mcap", "branch at 12.0 s"
  std::string file;        ///< path of the recording
  std::string settings{};  ///< /schema.json of the settings for other futures; empty: none
};

/// Pages of a live run: /mode.json with {"mode":"live"}.
[[nodiscard]] wire::Pages live_pages();
/// Pages of a live run with settings: /mode.json, /schema.json, /preset.yaml. `settings` outlives the server.
[[nodiscard]] wire::Pages live_pages(const LiveSettings& settings);
/// Adds /what_if.json; `what_if` outlives the server.
void add_what_if(wire::Pages& pages, WhatIf& what_if);
/// Adds /rival.json; `rival` outlives the server.
void add_rival(wire::Pages& pages, const Rival& rival);
/// Pages of a replay: /mode.json names the logs, /log/0.mcap, /log/1.mcap, ... are their files, and
/// /log/0.settings.json, ... their settings. `start`: beginning of the dashboard's time line [s].
[[nodiscard]] wire::Pages replay_pages(const std::vector<ServedLog>& logs, double start);

/// Writes the road into the description of a run for viewers and recordings: name, length, lines.
void describe(const road::Track& track, protocol::Run& run);

/// Writes car, notices, and the origin of car and road into the description of a run; reads their files.
void describe(const scenario::Scenario& scenario, protocol::Run& run);

/// Description of a run with our simulator for viewers and recordings; without its limit.
[[nodiscard]] protocol::Run description(const run::ClosedLoop& loop);

/// Files of the dashboard, gzip-compressed inside the program (target chicane_web_assets,
/// cmake/EmbedWeb.cmake). A program built without Node holds one plain page that says so.
[[nodiscard]] std::vector<net::Asset> embedded_assets();

/// Page that draws reports of recordings (recording/html_report.hpp) and documents (protocol/json.hpp).
[[nodiscard]] recording::ReportBundle document_bundle();

}  // namespace chicane::live
