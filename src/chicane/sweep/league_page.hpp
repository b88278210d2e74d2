// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "chicane/sweep/league.hpp"

namespace chicane::sweep {

/// A document (protocol/json.hpp): the standings, a table for each track and car, times that were
/// measured, and the command of each run.
[[nodiscard]] std::string league_document(const League& league, const LeagueResults& results);
/// The same tables for a page of docs/, without the commands.
[[nodiscard]] std::string league_markdown(const League& league, const LeagueResults& results);
/// A row for each run (RFC 4180).
[[nodiscard]] std::string league_csv(const LeagueResults& results);
/// A list of objects, one for each run, with what is in the table of CSV.
[[nodiscard]] std::string league_json(const LeagueResults& results);

}  // namespace chicane::sweep
