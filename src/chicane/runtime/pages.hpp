// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "chicane/net/http_response.hpp"
#include "chicane/runtime/live_settings.hpp"

namespace chicane::runtime {

/// What the program answers to GET beside the dashboard's files, by path ("/mode.json"). Called on the
/// network thread.
using Pages = std::map<std::string, std::function<net::Content()>, std::less<>>;

/// A recording for the dashboard to open.
struct ServedLog {
  std::string name;  ///< for people: "run.mcap", "branch at 12.0 s"
  std::string file;
};

/// GET /mode.json of a run that is going on: {"mode":"live"}.
[[nodiscard]] Pages live_pages();
/// The same, /schema.json and /preset.yaml of its settings, which must outlive the server.
[[nodiscard]] Pages live_pages(const LiveSettings& settings);
/// GET /mode.json that names the logs, and each of them as /log/0.mcap, /log/1.mcap, ...; `start` is where
/// the dashboard's time line begins [s].
[[nodiscard]] Pages replay_pages(const std::vector<ServedLog>& logs, double start);

}  // namespace chicane::runtime
