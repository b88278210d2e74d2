// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/sweep/league.hpp"
#include "chicane/sweep/result_file.hpp"
#include "chicane/telemetry/metrics.hpp"

/// What a league has found. The runs of our own controllers are the results of a sweep, the same bytes on
/// every machine; times that a clock measured, and the limits, stand in a file of their own.
namespace chicane::sweep {

/// One controller on one track, in one car and disturbance.
struct LeagueCell {
  std::string entry{}, track{}, car{}, disturbance{};
  bool is_external = false;
  bool is_clean = false;
  std::map<std::string, double, std::less<>> numbers{};  ///< by column; what was not measured is not there
  std::string why{};                                     ///< it is not clean, in a few words
  std::string command{};                                 ///< that drives it again

  /// Not-a-number where it was not measured.
  [[nodiscard]] double number(std::string_view column) const;
};

struct LeagueResults {
  std::vector<LeagueCell> cells{};                                 ///< in the order of the league
  std::map<std::pair<std::string, std::string>, double> bounds{};  ///< by track and car [s]
  std::uint64_t missing = 0;                                       ///< runs that were not driven yet
};

/// The file beside the results: one JSON object in each line, a trial under its program's command.
class BesideFile {
 public:
  /// As LineFile::open(). kInvalidArgument for the file of another league or plan.
  [[nodiscard]] static Result<BesideFile> open(const std::string& path, const League& league);

  [[nodiscard]] bool has_bound(const std::string& track, const std::string& car) const;
  [[nodiscard]] bool has_trial(const ExternalTrial& trial) const;

  /// Any thread; kIo.
  [[nodiscard]] Result<void> add_bound(const std::string& track, const std::string& car,
                                       const Result<double>& bound);
  [[nodiscard]] Result<void> add_times(std::uint64_t run, const telemetry::RunSummary& summary);
  [[nodiscard]] Result<void> add_trial(const ExternalTrial& trial, const Result<telemetry::RunSummary>& run);

 private:
  LineFile file_{};
  std::vector<std::string> keys_{};  ///< of limits and trials that are there
};

/// Both files. Fails as read_lines() does.
[[nodiscard]] Result<LeagueResults> read_results(const League& league, const std::string& results,
                                                 const std::string& beside);

}  // namespace chicane::sweep
