// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "problems/corridor_problem.hpp"
#include "problems/described_problem.hpp"
#include "problems/families.hpp"
#include "problems/structured_solver.hpp"

namespace chicane::bench {

/// What another solver did with one instance.
struct Outcome {
  bool is_solved = false;
  int iterations = 0;
  double time = 0.0;               ///< CPU time from the call to the answer [s]
  double time_in_functions = 0.0;  ///< values and derivatives of the problem in it [s]; 0 = not measured
};

/// Another solver, for comparison: it gets the same problem and the same start.
template <class Problem>
class Reference {
 public:
  using Instance = bench::Instance<Problem, kLongestHorizon>;
  using Trajectory = DescribedTrajectory<kLongestHorizon>;

  virtual ~Reference() = default;
  /// For tables, and as a key in JSON: "ipopt", "ipopt_hot", "cppad".
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
  std::string versions;  ///< "Ipopt 3.11.9, CppAD 20140000"; empty without any

  template <class Problem>
  [[nodiscard]] auto& of() {
    if constexpr (Problem::kNc > 0) {
      return corridor;
    } else {
      return described;
    }
  }
};

}  // namespace chicane::bench
