// SPDX-License-Identifier: MIT
#include <pybind11/stl.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <memory>
#include <span>
#include <string>
#include <thread>
#include <tuple>
#include <utility>
#include <vector>

#include "chicane/base/instruction_set.hpp"
#include "conversion.hpp"
#include "faces.hpp"
#include "signals.hpp"
#include "traced/banded.hpp"
#include "traced/run_program.hpp"
#include "traced/traced_solver.hpp"

namespace chicane::python {
namespace {

using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Integers = py::array_t<std::int32_t, py::array::c_style | py::array::forcecast>;

bool fits(const TracedProblem& problem, const SizeClass& sizes) {
  const int rows[kFunctions] = {sizes.nx, sizes.nr, sizes.nc, sizes.nh, sizes.ne, sizes.neh, sizes.nec};
  bool fits = problem.nx <= sizes.nx && problem.nu <= sizes.nu;
  for (std::size_t f = 0; f < kFunctions; ++f)
    fits = fits && problem.rows(static_cast<Function>(f)) <= rows[f];
  return fits;
}
/// Derivatives by inputs get the numbers that these have behind the states of the size class.
void number_as_in(const SizeClass& sizes, TracedProblem& problem) {
  const auto shift = [&](std::uint16_t& i) {
    if (i >= problem.nx) i = static_cast<std::uint16_t>(i + sizes.nx - problem.nx);
  };
  for (auto& orders : problem.programs) {
    for (Program& program : orders) {
      for (auto* entries : {&program.slopes, &program.curvatures}) {
        for (solver::SparseEntry& entry : *entries) {
          shift(entry.i);
          shift(entry.j);
        }
      }
    }
  }
}
/// The smallest size class that a problem fits in; -1 when none is large enough.
int size_class(const TracedProblem& problem) {
  const auto* const found = std::find_if(kSizeClasses.begin(), kSizeClasses.end(),
                                         [&](const SizeClass& sizes) { return fits(problem, sizes); });
  return found == kSizeClasses.end() ? -1 : static_cast<int>(found - kSizeClasses.begin());
}

template <class Arch, std::size_t... Class>
std::unique_ptr<TracedSolver> make_one(std::size_t kind, const TracedProblem& problem,
                                       const Workspace& workspace, std::index_sequence<Class...>) {
  using Make = std::unique_ptr<TracedSolver> (*)(const TracedProblem&, const Workspace&);
  static constexpr Make kMakers[]{make_sized_solver<Arch, kSizeClasses[Class]>...};
  return kMakers[kind](problem, workspace);
}
template <class Arch>
std::unique_ptr<TracedSolver> make_solver(int kind, const TracedProblem& problem,
                                          const Workspace& workspace) {
  return make_one<Arch>(static_cast<std::size_t>(kind), problem, workspace,
                        std::make_index_sequence<kSizeClasses.size()>{});
}
/// Solver for the chosen instruction set, or the best one below it that the interpreter was compiled for.
std::unique_ptr<TracedSolver> make_solver(int kind, const TracedProblem& problem,
                                          const Workspace& workspace) {
  [[maybe_unused]] const InstructionSet set = chosen_instruction_set();
#if defined(CHICANE_INTERPRETER_AVX512)
  if (set == InstructionSet::kAvx512) return make_solver<arch::Avx512>(kind, problem, workspace);
#endif
#if defined(CHICANE_INTERPRETER_AVX2)
  if (set == InstructionSet::kAvx2 || set == InstructionSet::kAvx512)
    return make_solver<arch::Avx2>(kind, problem, workspace);
#endif
#if defined(CHICANE_INTERPRETER_NEON)
  if (set == InstructionSet::kNeon) return make_solver<arch::Neon>(kind, problem, workspace);
#endif
  return make_solver<arch::CHICANE_INTERPRETER_SIMPLEST>(kind, problem, workspace);
}

Node node_of(int op, const std::int32_t* operands, double value, std::size_t before) {
  if (op < 0 || op > static_cast<int>(Op::kSelect)) throw py::value_error("tape: got an unknown operation");
  Node node{.op = static_cast<Op>(op), .of = {operands[0], operands[1], operands[2]}, .value = value};
  for (int m = 0; m < kOpOperands[static_cast<std::size_t>(op)]; ++m) {
    if (node.of[static_cast<std::size_t>(m)] < 0 ||
        static_cast<std::size_t>(node.of[static_cast<std::size_t>(m)]) >= before)
      throw py::value_error("tape: got an operand that does not come before its use");
  }
  return node;
}

/// How a problem is solved: what TracedCall has, as arrays that live as long as it is used.
struct Setting {
  std::vector<double> lower, upper;
  std::vector<solver::SoftPenalty> penalties;
  std::unique_ptr<bool[]> is_hard;
  solver::SolverOptions options;
  double budget_s = 0.0;
};

/// Parameters by stage with whole cache lines for each: (np, stride).
struct StageParameters {
  std::vector<double> memory;
  double* data = nullptr;
  std::size_t stride = 0;

  StageParameters(int np, int stages) : stride{(static_cast<std::size_t>(stages) + 15) / 8 * 8} {
    memory.assign(static_cast<std::size_t>(np) * stride + 8, 0.0);
    const auto address = reinterpret_cast<std::uintptr_t>(memory.data());
    data = memory.data() + (64 - address % 64) % 64 / sizeof(double);
  }
  /// Takes over an array of shape (stages, np).
  void fill(const double* from, int np, int stages) {
    for (int k = 0; k < stages; ++k) {
      for (int n = 0; n < np; ++n)
        data[static_cast<std::size_t>(n) * stride + static_cast<std::size_t>(k)] = *from++;
    }
  }
};

py::array_t<double> shaped(const std::vector<double>& values, py::ssize_t rows, py::ssize_t columns) {
  py::array_t<double> array({rows, columns});
  std::copy(values.begin(), values.end(), array.mutable_data());
  return array;
}

class Interpreter {
 public:
  Interpreter(int nx, int nu, int np, int horizon, const Integers& ops, const Integers& operands,
              const Array& values, const std::vector<std::vector<std::int32_t>>& outputs, bool is_to_solve)
      : horizon_{horizon} {
    std::vector<Node> nodes;
    for (py::ssize_t n = 0; n < ops.size(); ++n)
      nodes.push_back(node_of(ops.data()[n], operands.data() + 3 * n, values.data()[n], nodes.size()));
    std::array<std::vector<std::int32_t>, kFunctions> rows;
    for (std::size_t f = 0; f < kFunctions; ++f) rows[f] = outputs.at(f);
    unlocked([&] { problem_ = make_traced_problem(nx, nu, np, nodes, rows); });
    kind_ = size_class(problem_);
    if (is_to_solve && (kind_ < 0 || horizon < 1 || horizon > kMostStages))
      throw py::value_error(too_large());
    if (is_to_solve) number_as_in(kSizeClasses[static_cast<std::size_t>(kind_)], problem_);
  }

  void set(const Array& lower, const Array& upper, const Array& penalties, const std::vector<bool>& is_hard,
           const py::dict& options) {
    setting_.lower.assign(lower.data(), lower.data() + lower.size());
    setting_.upper.assign(upper.data(), upper.data() + upper.size());
    setting_.penalties.clear();
    for (py::ssize_t c = 0; c < penalties.size() / 3; ++c)
      setting_.penalties.push_back(
          {penalties.data()[3 * c], penalties.data()[3 * c + 1], penalties.data()[3 * c + 2]});
    setting_.is_hard = std::make_unique<bool[]>(is_hard.size() + 1);
    std::copy(is_hard.begin(), is_hard.end(), setting_.is_hard.get());
    setting_.options.tolerance = options["tolerance"].cast<double>();
    setting_.options.max_iterations = options["max_iterations"].cast<int>();
    setting_.options.second_order = options["second_order"].cast<bool>();
    setting_.options.start_from_states = options["start_from_states"].cast<bool>();
    setting_.budget_s = options["budget_s"].cast<double>();
  }

  /// Solves once; `iterations`: length of the log, 0 for none.
  py::dict solve(const Array& x0, const Array& parameters, const Array& x, const Array& u, bool goes_on,
                 std::size_t iterations) {
    if (main_ == nullptr) main_ = std::make_unique<Worker>(*this);
    TracedAnswer& answer = main_->answer;
    std::copy(x.data(), x.data() + x.size(), answer.x.begin());
    std::copy(u.data(), u.data() + u.size(), answer.u.begin());
    double seconds = 0.0;
    std::vector<solver::Iteration> memory(iterations);
    solver::IterationLog log(memory);
    unlocked([&] {
      seconds = main_->solve(*this, x0.data(), parameters.data(), goes_on, iterations > 0 ? &log : nullptr);
    });
    py::dict result = report_of(answer.report, seconds);
    const auto nx = static_cast<py::ssize_t>(problem_.nx);
    const auto nu = static_cast<py::ssize_t>(problem_.nu);
    add_trajectory(result);
    if (iterations > 0) result["log"] = table_of(log);
    result["dynamics"] = shaped(answer.adjoint, horizon_, nx);
    result["bounds"] = shaped(answer.bound, horizon_, nu);
    result["constraints"] = shaped(answer.constraint, horizon_, problem_.rows(Function::kConstraint));
    result["equalities"] = shaped(answer.equality, horizon_, problem_.rows(Function::kEquality));
    result["terminal_equality"] = py::array_t<double>(
        static_cast<py::ssize_t>(answer.terminal_equality.size()), answer.terminal_equality.data());
    result["terminal_constraint"] = py::array_t<double>(
        static_cast<py::ssize_t>(answer.terminal_constraint.size()), answer.terminal_constraint.data());
    return result;
  }

  bool prepare() {
    if (main_ == nullptr) return false;
    bool is_ready = false;
    unlocked([&] { is_ready = main_->solver->prepare(); });
    return is_ready;
  }
  py::dict feedback(const Array& x0) {
    if (main_ == nullptr || x0.size() != problem_.nx) throw py::value_error("feedback: got no preparation");
    const auto begin = std::chrono::steady_clock::now();
    const bool is_solved = main_->solver->feedback(x0.data(), main_->answer);
    py::dict result;
    result["time"] = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    result["is_solved"] = is_solved;
    add_trajectory(result);
    return result;
  }

  /// Each row of x0 from the guess u, with parameters (problems, stages, np) or (1, stages, np).
  py::dict solve_many(const Array& x0, const Array& parameters, const Array& guess, int threads) {
    const py::ssize_t count = x0.shape(0);
    const bool has_own = parameters.shape(0) > 1;
    const auto block = static_cast<std::size_t>(horizon_ + 1) * static_cast<std::size_t>(problem_.np);
    const auto nx = static_cast<std::size_t>(problem_.nx);
    const auto nu = static_cast<std::size_t>(problem_.nu);
    py::array_t<double> x({count, py::ssize_t{horizon_ + 1}, static_cast<py::ssize_t>(nx)});
    py::array_t<double> u({count, py::ssize_t{horizon_}, static_cast<py::ssize_t>(nu)});
    py::array_t<double> cost(count), violation(count), seconds(count);
    py::array_t<int> status(count), iterations(count);
    std::atomic<bool> stop{false};
    std::atomic<py::ssize_t> next{0};
    const double* const from = x0.data();
    const double* const data = parameters.data();
    const double* const start = guess.data();
    double *const to_x = x.mutable_data(), *const to_u = u.mutable_data(),
                  *const to_cost = cost.mutable_data(), *const to_violation = violation.mutable_data(),
                  *const to_seconds = seconds.mutable_data();
    int *const to_status = status.mutable_data(), *const to_iterations = iterations.mutable_data();
    const auto work = [&] {
      Worker worker(*this);
      for (py::ssize_t n = next++; n < count && !stop; n = next++) {
        const auto at = static_cast<std::size_t>(n);
        std::fill(worker.answer.x.begin(), worker.answer.x.end(), 0.0);
        std::copy_n(start, worker.answer.u.size(), worker.answer.u.begin());
        to_seconds[n] = worker.solve(*this, from + at * nx, data + (has_own ? at * block : 0), false);
        std::copy(worker.answer.x.begin(), worker.answer.x.end(), to_x + at * worker.answer.x.size());
        std::copy(worker.answer.u.begin(), worker.answer.u.end(), to_u + at * worker.answer.u.size());
        to_cost[n] = worker.answer.report.cost;
        to_violation[n] = std::max(worker.answer.report.violation, worker.answer.report.miss);
        to_status[n] = static_cast<int>(worker.answer.report.status);
        to_iterations[n] = worker.answer.report.iterations;
      }
    };
    run_with_signals(stop, [&] {
      std::vector<std::jthread> others;
      for (int n = 1; n < threads; ++n) others.emplace_back(work);
      work();
    });
    py::dict result;
    result["x"] = x;
    result["u"] = u;
    result["cost"] = cost;
    result["violation"] = violation;
    result["status"] = status;
    result["iterations"] = iterations;
    result["time"] = seconds;
    return result;
  }

  /// Values (n, rows), Jacobians (n, rows, variables) and Σ weights · second derivatives (n, variables,
  /// variables) of a function at points (n, nx + nu), with parameters (n, np); the first is of stage `first`.
  py::tuple evaluate(int function, const Array& points, const Array& parameters, const Array& weights,
                     int first) const {
    if (function < 0 || function >= static_cast<int>(kFunctions))
      throw py::value_error("evaluate: got an unknown function");
    using V = Pack<arch::Native, 2>;
    const Program& program = problem_.program(static_cast<Function>(function), 2);
    const Workspace workspace(problem_);
    auto* const s = reinterpret_cast<V*>(workspace.slots(static_cast<Function>(function), 2).narrow);
    const py::ssize_t count = points.shape(0);
    const py::ssize_t variables = problem_.nx + problem_.nu;
    const auto rows = static_cast<py::ssize_t>(program.rows.size());
    py::array_t<double> values({count, rows});
    py::array_t<double> slopes({count, rows, variables});
    py::array_t<double> curvatures({count, variables, variables});
    std::fill_n(slopes.mutable_data(), slopes.size(), 0.0);
    std::fill_n(curvatures.mutable_data(), curvatures.size(), 0.0);
    for (py::ssize_t k = 0; k < count; ++k) {
      for (const Load& load : program.variables) s[load.slot] = V(points.at(k, load.from));
      for (const Load& load : program.parameters) s[load.slot] = V(parameters.at(k, load.from));
      for (const std::uint32_t slot : program.stages) s[slot] = V(static_cast<double>(first + k));
      run_code(program.code.data(), program.code.size(), s);
      for (py::ssize_t n = 0; n < rows; ++n) {
        const ProgramRow& row = program.rows[static_cast<std::size_t>(n)];
        values.mutable_at(k, n) = s[row.value][0];
        for (std::uint32_t e = row.slopes; e < row.slopes + row.slope_count; ++e)
          slopes.mutable_at(k, n, program.slopes[e].i) = s[program.slopes[e].slot][0];
        for (std::uint32_t e = row.curvatures; e < row.curvatures + row.curvature_count; ++e) {
          const solver::SparseEntry& entry = program.curvatures[e];
          const double share = weights.at(k, n) * s[entry.slot][0];
          curvatures.mutable_at(k, entry.i, entry.j) += share;
          if (entry.i != entry.j) curvatures.mutable_at(k, entry.j, entry.i) += share;
        }
      }
    }
    return py::make_tuple(values, slopes, curvatures);
  }

  /// Operations of the program of each function, with derivatives up to the second.
  [[nodiscard]] std::vector<std::size_t> operations() const {
    std::vector<std::size_t> counts;
    for (const auto& orders : problem_.programs) counts.push_back(orders[2].code.size());
    return counts;
  }

 private:
  /// Solver, memory and answer of one thread.
  struct Worker {
    explicit Worker(const Interpreter& of)
        : workspace{of.problem_},
          parameters{of.problem_.np, of.horizon_ + 1},
          solver{make_solver(of.kind_, of.problem_, workspace)} {
      const auto horizon = static_cast<std::size_t>(of.horizon_);
      const auto rows = [&](Function f) { return static_cast<std::size_t>(of.problem_.rows(f)); };
      answer.x.resize((horizon + 1) * static_cast<std::size_t>(of.problem_.nx));
      answer.u.resize(horizon * static_cast<std::size_t>(of.problem_.nu));
      answer.adjoint.resize(horizon * static_cast<std::size_t>(of.problem_.nx));
      answer.bound.resize(horizon * static_cast<std::size_t>(of.problem_.nu));
      answer.constraint.resize(horizon * rows(Function::kConstraint));
      answer.equality.resize(horizon * rows(Function::kEquality));
      answer.terminal_equality.resize(rows(Function::kTerminalEquality));
      answer.terminal_constraint.resize(rows(Function::kTerminalConstraint));
    }
    double solve(const Interpreter& of, const double* x0, const double* from, bool goes_on,
                 solver::IterationLog* log = nullptr) {
      const Setting& setting = of.setting_;
      parameters.fill(from, of.problem_.np, of.horizon_ + 1);
      const auto begin = std::chrono::steady_clock::now();
      const Deadline deadline = setting.budget_s > 0.0
                                    ? Deadline::after(std::chrono::duration_cast<std::chrono::nanoseconds>(
                                          std::chrono::duration<double>(setting.budget_s)))
                                    : Deadline::never();
      const TracedCall call{.horizon = of.horizon_,
                            .x0 = x0,
                            .data = parameters.data,
                            .data_stride = parameters.stride,
                            .lower = setting.lower.data(),
                            .upper = setting.upper.data(),
                            .penalties = setting.penalties.data(),
                            .is_hard = setting.is_hard.get(),
                            .options = setting.options,
                            .goes_on = goes_on,
                            .deadline = deadline,
                            .log = log};
      solver->solve(call, answer);
      return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    }
    Workspace workspace;
    StageParameters parameters;
    std::unique_ptr<TracedSolver> solver;
    TracedAnswer answer;
  };

  void add_trajectory(py::dict& result) const {
    result["x"] = shaped(main_->answer.x, horizon_ + 1, problem_.nx);
    result["u"] = shaped(main_->answer.u, horizon_, problem_.nu);
  }
  /// A column for each number of an iteration.
  static py::dict table_of(const solver::IterationLog& log) {
    const auto iterations = log.iterations();
    py::dict table;
    const auto add = [&](const char* name, const auto& number) {
      py::array_t<decltype(number(iterations[0]))> column(static_cast<py::ssize_t>(iterations.size()));
      std::transform(iterations.begin(), iterations.end(), column.mutable_data(), number);
      table[name] = column;
    };
    using solver::Iteration;
    add("round", [](const Iteration& iteration) { return iteration.round; });
    add("kind", [](const Iteration& iteration) { return static_cast<int>(iteration.kind); });
    add("cost", [](const Iteration& iteration) { return iteration.cost; });
    add("stationarity", [](const Iteration& iteration) { return iteration.stationarity; });
    add("defect", [](const Iteration& iteration) { return iteration.defect; });
    add("complementarity", [](const Iteration& iteration) { return iteration.complementarity; });
    add("step", [](const Iteration& iteration) { return iteration.step; });
    add("barrier", [](const Iteration& iteration) { return iteration.barrier; });
    return table;
  }
  static py::dict report_of(const solver::HardReport& report, double seconds) {
    py::dict result;
    result["status"] = static_cast<int>(report.status);
    result["iterations"] = report.iterations;
    result["rounds"] = report.rounds;
    result["cost"] = report.cost;
    result["stationarity"] = report.stationarity;
    result["defect"] = report.defect;
    result["complementarity"] = report.complementarity;
    result["gap"] = report.gap;
    result["violation"] = report.violation;
    result["worst_stage"] = report.worst_stage;
    result["worst_constraint"] = report.worst_constraint;
    result["miss"] = report.miss;
    result["miss_kind"] = static_cast<int>(report.kind);
    result["miss_stage"] = report.miss_stage;
    result["miss_row"] = report.miss_row;
    result["time"] = seconds;
    return result;
  }
  [[nodiscard]] std::string too_large() const {
    const auto& most = kSizeClasses.back();
    const auto rows = [&](Function f) { return problem_.rows(f); };
    const std::tuple<const char*, int, int> sizes[] = {
        {"nx", problem_.nx, most.nx},
        {"nu", problem_.nu, most.nu},
        {"horizon", horizon_, kMostStages},
        {"residuals", rows(Function::kResidual), most.nr},
        {"constraints", rows(Function::kConstraint), most.nc},
        {"equalities", rows(Function::kEquality), most.nh},
        {"residuals at the end", rows(Function::kTerminalResidual), most.ne},
        {"equalities at the end", rows(Function::kTerminalEquality), most.neh},
        {"constraints at the end", rows(Function::kTerminalConstraint), most.nec}};
    std::string text = "Problem:";
    for (const auto& [name, got, limit] : sizes) {
      if (got > limit)
        text += std::string(" ") + name + ": got " + std::to_string(got) + ", expected at most " +
                std::to_string(limit) + ";";
    }
    text.pop_back();
    return text;
  }

  TracedProblem problem_;
  int horizon_;
  int kind_ = 0;
  Setting setting_;
  std::unique_ptr<Worker> main_;
};

}  // namespace

namespace {

/// X of A X = B, A by entries. numpy's LinAlgError where A is singular.
py::array_t<double> solve_band(const Integers& rows, const Integers& columns, const Array& values,
                               const Array& right) {
  std::vector<BandEntry> entries;
  for (py::ssize_t e = 0; e < values.size(); ++e)
    entries.push_back({rows.at(e), columns.at(e), values.at(e)});
  py::array_t<double> solved({right.shape(0), right.shape(1)});
  std::copy_n(right.data(), right.size(), solved.mutable_data());
  const auto n = static_cast<std::size_t>(right.shape(0));
  const std::span<double> numbers{solved.mutable_data(), static_cast<std::size_t>(solved.size())};
  if (!unlocked([&] { return solve_banded(n, entries, numbers); })) {
    PyErr_SetString(py::module_::import("numpy.linalg").attr("LinAlgError").ptr(), "singular matrix");
    throw py::error_already_set();
  }
  return solved;
}

}  // namespace

void add_problem(py::module_& module) {
  module.def("solve_banded", solve_band, py::arg("rows"), py::arg("columns"), py::arg("values"),
             py::arg("right"));
  py::list names;
  for (const std::string_view name : kOpNames) names.append(to_text(name));
  module.attr("TAPE_OPERATIONS") = names;
  py::dict statuses;
  for (const auto& word : solver::kSolveStatusWords)
    statuses[py::int_(static_cast<int>(word.value))] =
        py::make_tuple(to_text(word.name), to_text(word.sentence));
  module.attr("SOLVE_STATUSES") = statuses;
  py::class_<Interpreter>(module, "Interpreter")
      .def(py::init<int, int, int, int, const Integers&, const Integers&, const Array&,
                    const std::vector<std::vector<std::int32_t>>&, bool>())
      .def("set", &Interpreter::set)
      .def("solve", &Interpreter::solve)
      .def("prepare", &Interpreter::prepare)
      .def("feedback", &Interpreter::feedback)
      .def("solve_many", &Interpreter::solve_many)
      .def("evaluate", &Interpreter::evaluate)
      .def("operations", &Interpreter::operations);
}

}  // namespace chicane::python
