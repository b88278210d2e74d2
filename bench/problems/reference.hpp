// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "problems/cpu_time.hpp"
#include "problems/described_problem.hpp"
#include "problems/families.hpp"
#include "problems/structured_solver.hpp"

namespace chicane::bench {

/// The structured form of an instance, which starts at without_cte(instance.start).
inline StructuredDescribedProblem structured(const Instance<DescribedProblem, kLongestHorizon>& instance) {
  return StructuredDescribedProblem{instance.problem, instance.start[4]};
}
inline StructuredCorridorProblem structured(const Instance<CorridorProblem, kLongestHorizon>& instance) {
  return {instance.problem, instance.start[4], instance.guess.horizon};
}

/// Another solver, for comparison: it gets the same problem and the same start.
template <class Problem>
class Reference {
 public:
  using Instance = bench::Instance<Problem, kLongestHorizon>;
  using Trajectory = DescribedTrajectory<kLongestHorizon>;

  virtual ~Reference() = default;
  /// For tables, and as a key in JSON: "ipopt", "ipopt_hot", "fatrop".
  [[nodiscard]] virtual std::string_view name() const = 0;
  /// Starts from its own multipliers of the cycle before; makes sense for warm families only.
  [[nodiscard]] virtual bool is_hot() const { return false; }
  /// `before`: the cycle before, null where there is none. `answer` gets the inputs, when solved.
  [[nodiscard]] virtual Outcome solve(const Instance& now, const Instance* before, Trajectory& answer) = 0;
};

/// All that a program has to compare with.
struct References {
  std::vector<std::unique_ptr<Reference<DescribedProblem>>> described;
  std::vector<std::unique_ptr<Reference<CorridorProblem>>> corridor;
  std::string versions;  ///< "Ipopt 3.11.9, fatrop 1.1.7"; empty without any

  template <class Problem>
  [[nodiscard]] auto& of() {
    if constexpr (Problem::kNc > 0) {
      return corridor;
    } else {
      return described;
    }
  }
};

/// Ipopt with exact derivatives, from a plain start and ("ipopt_hot") from its own multipliers of the cycle
/// before, shifted. In programs that are built with it.
void add_ipopt(References& references);
/// fatrop and HPIPM on the structured forms, whose states are one fewer. In programs that are built with
/// them.
void add_peers(References& references);

}  // namespace chicane::bench
