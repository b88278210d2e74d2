// SPDX-License-Identifier: MIT
// Claims: statements of a write-up, each with the runs that try it and the conditions on their results.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/protocol/json.hpp"
#include "chicane/sweep/plan.hpp"

namespace chicane::sweep {

/// One run that tries a claim.
struct Case {
  std::string name{};
  Settings settings{};  ///< additions to the claim's settings
};

/// Condition on the results of cases, `N40.top_speed_mps > N25.top_speed_mps * 1.02`: a column of a case, a
/// comparison, and a number or a column of another case, times a factor or plus a term. The name `each` on
/// the right stands for every other clean case: the left one is then an optimum among runs on the road.
struct Condition {
  /// One side of a condition.
  struct Value {
    std::string name{};    ///< name of the case; empty: the number is `constant`
    std::string column{};  ///< column of trial.hpp, "lap_times_s[-1]", or "clean": all laps driven, no tyre
                           ///< off the road
    double constant = 0.0;
  };
  std::string text{};  ///< condition as written
  Value left{}, right{};
  char comparison = '>';            ///< one of > < = (equal)
  double factor = 1.0, term = 0.0;  ///< right side: value · factor + term
};

/// Statement of a write-up. It is either tried by cases and conditions, or has a verdict in words.
struct Claim {
  std::string id{};      ///< "B7"
  std::string says{};    ///< paraphrase of the statement
  std::string quotes{};  ///< quotation, at most kMostQuotedWords; empty: not found in the write-up
  /// Values that are ours and not the write-up's, in words for the verdict: "with our weights".
  std::string ours{};
  Settings settings{};  ///< settings of all cases, the preset among them
  std::vector<Case> cases{};
  std::size_t grid_size = 0;  ///< number of points of a grid, the last ones of `cases`, named by their values
  std::vector<Condition> conditions{};  ///< the claim is true if all hold
  std::vector<std::string> shows{};     ///< columns shown with the verdict
  /// Verdict on a statement that no run can try: "works", "partly" or "not so", and where to see it.
  std::string found{}, see{};

  [[nodiscard]] bool is_tried() const noexcept { return !cases.empty(); }
};

constexpr std::size_t kMostQuotedWords = 10;  ///< short enough for a quotation of a text by others; chosen

/// Lines of results of a claim's cases on one track and in one reading, by the names of the cases.
using CaseResults = std::map<std::string, protocol::Json>;

/// Whether all conditions of the claim hold. A number that was not measured makes its condition false.
[[nodiscard]] bool holds(const Claim& claim, const CaseResults& results);
/// Number of a column in a line of results; also of "clean", and of an entry of a list ("lap_times_s[-1]").
/// True is 1. NaN if the line has no such number.
[[nodiscard]] double number_of(const protocol::Json& line, std::string_view column);

/// Reads the claims of one file: `settings`, `ours`, and a list `claims` of {id, says, quotes, settings,
/// cases: {name: {settings}}, grid: {key: [values]}, true_when: [conditions], shows: [columns]} or {id, says,
/// quotes, found, see}. The points of the grid are cases, too: each has a value of each key, and consecutive
/// points differ in the last key. `quotations`: text of quotations_file(file), with a fragment of the
/// write-up in each line, and comments with #. kParse with all faults and their lines.
[[nodiscard]] Result<std::vector<Claim>> parse_claims(std::string_view text, const std::string& file,
                                                      std::string_view quotations = "");
/// File of quotations: "claims/quotations/NAME.txt" for "claims/NAME.yaml".
[[nodiscard]] std::string quotations_file(const std::string& file);

}  // namespace chicane::sweep
