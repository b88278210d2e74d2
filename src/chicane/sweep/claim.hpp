// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/protocol/json.hpp"
#include "chicane/sweep/plan.hpp"

/// A statement of a write-up, and how it is tried.
namespace chicane::sweep {

/// One run of the trial, with its additions to the claim's settings.
struct Case {
  std::string name{};
  Settings settings{};
};

/// `N40.top_speed_mps > N25.top_speed_mps * 1.02`: one number of a case, a comparison, and a number or one of
/// another case, times a factor or plus a term. The other case `each` means every other clean one: an optimum
/// among runs on the road.
struct Condition {
  struct Value {
    std::string name{};    ///< name of the case; empty: the number is `constant`
    std::string column{};  ///< column of trial.hpp, "lap_times_s[-1]", or "clean": all laps driven, no tyre
                           ///< off the road
    double constant = 0.0;
  };
  std::string text{};
  Value left{}, right{};
  char comparison = '>';  ///< > < = (equal)
  double factor = 1.0, term = 0.0;
};

struct Claim {
  std::string id{};      ///< "B7"
  std::string says{};    ///< paraphrased
  std::string quotes{};  ///< the write-up's own words, at most kMostQuotedWords; empty: they were not found
  std::string ours{};    ///< our additions to the preset, for the verdict: "with our weights"
  Settings settings{};   ///< settings of all cases, the preset among them
  std::vector<Case> cases{};
  std::size_t grid_size = 0;  ///< number of last cases that are points of a grid, named by their values
  std::vector<Condition> conditions{};  ///< true when all hold
  std::vector<std::string> shows{};     ///< columns
  /// Verdict on a statement that no run can try: "works", "partly" or "not so", and where to see it.
  std::string found{}, see{};

  [[nodiscard]] bool is_tried() const noexcept { return !cases.empty(); }
};

constexpr std::size_t kMostQuotedWords = 10;

/// The lines of a claim's cases in one world (sweep.hpp), by their names.
using CaseResults = std::map<std::string, protocol::Json>;

/// Whether all conditions hold; a number that was not measured makes its condition false.
[[nodiscard]] bool holds(const Claim& claim, const CaseResults& results);
/// The number of a column in a line of results, "clean" or a place in a list ("lap_times_s[-1]") included;
/// true is 1, and NaN where there is none.
[[nodiscard]] double number_of(const protocol::Json& line, std::string_view column);

/// Reads the claims of one file: `settings`, `ours`, and a list `claims` of {id, says, quotes, settings,
/// cases: {name: {settings}}, grid: {key: [values]}, true_when: [conditions], shows: [columns]} or {id, says,
/// quotes, found, see}. The points of the grid are cases, too: a value of each key, the last key turning
/// fastest. `quotations` is the text of quotations_file(file): fragments of the write-up, one a line, and
/// comments with #. kParse with all faults and their lines.
[[nodiscard]] Result<std::vector<Claim>> parse_claims(std::string_view text, const std::string& file,
                                                      std::string_view quotations = "");
/// File of quotations: "claims/quotations/NAME.txt" for "claims/NAME.yaml".
[[nodiscard]] std::string quotations_file(const std::string& file);

}  // namespace chicane::sweep
