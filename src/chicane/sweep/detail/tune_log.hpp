// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>

#include "chicane/base/result.hpp"
#include "chicane/scenario/scenario.hpp"
#include "chicane/sweep/plan.hpp"
#include "chicane/sweep/result_file.hpp"
#include "chicane/sweep/tune.hpp"

namespace chicane::sweep::detail {

/// What was found out about each tuning, so that none is driven twice: in memory, and in a file where there
/// is one, a JSON object in each line. The first line says what the evaluations depend on.
class TuneLog {
 public:
  /// Reads a file that is there; an empty path: no file. kInvalidArgument when it belongs to another `head`;
  /// kParse "FILE:LINE: …"; kIo.
  [[nodiscard]] static Result<TuneLog> open(const std::string& path, const std::string& head);

  /// Null: not driven yet.
  [[nodiscard]] const Verdict* find(const Settings& values) const;
  /// kIo when the line cannot be written.
  [[nodiscard]] Result<void> add(const Settings& values, const Verdict& verdict);

 private:
  LineFile file_{};
  std::map<Settings, Verdict> verdicts_{};
};

/// Of a task: its settings and the scenario that they mean, keys and objective, the program and its
/// arithmetic. Not the optimiser, which changes no evaluation.
[[nodiscard]] std::string tune_head(const TuneTask& task, const scenario::Scenario& scenario,
                                    const std::vector<std::string>& keys);

}  // namespace chicane::sweep::detail
