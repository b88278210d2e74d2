// SPDX-License-Identifier: MIT
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

/// A recording for the dashboard to open.
struct ServedLog {
  std::string name;  ///< name for people: "run.mcap", "branch at 12.0 s"
  std::string file;
  std::string settings{};  ///< /schema.json of the settings for other futures; empty: none
};

/// GET /mode.json of a run that is going on: {"mode":"live"}.
[[nodiscard]] wire::Pages live_pages();
/// The same, /schema.json and /preset.yaml of its settings, which must outlive the server.
[[nodiscard]] wire::Pages live_pages(const LiveSettings& settings);
/// GET /what_if.json of an answer that must outlive the server.
void add_what_if(wire::Pages& pages, WhatIf& what_if);
/// GET /rival.json, the same.
void add_rival(wire::Pages& pages, const Rival& rival);
/// GET /mode.json that names the logs, and each of them as /log/0.mcap, /log/1.mcap, ..., its settings as
/// /log/0.settings.json; `start` is where the dashboard's time line begins [s].
[[nodiscard]] wire::Pages replay_pages(const std::vector<ServedLog>& logs, double start);

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
