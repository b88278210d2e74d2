// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "chicane/net/server.hpp"

namespace chicane::runtime {

/// The files of the dashboard, gzip-compressed inside the program (target chicane_web_assets,
/// cmake/EmbedWeb.cmake). A program built without Node holds one plain page that says so.
[[nodiscard]] std::vector<net::Asset> embedded_assets();

}  // namespace chicane::runtime
