// SPDX-License-Identifier: MIT
// Random convex problems, possible, nearly possible and impossible ones: a linear program (GLPK) says which
// they are. Where conditions of first order hold, by the independent check, an answer is the optimum.
//
//   chicane-convex-fuzz [COUNT [FIRST]]     COUNT problems, default 100000; FIRST: seed of the first one
#include <glpk.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <memory>
#include <vector>

#include "chicane/base/random.hpp"
#include "chicane/solver/hard_constraints.hpp"
#include "chicane/solver/ocp_solver.hpp"
#include "chicane/solver/problem.hpp"
#include "problems/optimality.hpp"

namespace chicane::bench {
namespace {

/// The linear program, for GLPK, of a problem with linear dynamics and rows. Columns: states from x_1 on,
/// inputs, and the largest miss of the rows that must hold.
template <class P, int Capacity>
class LinearProgram {
 public:
  using Trajectory = solver::Trajectory<P::kNx, P::kNu, Capacity>;
  using Start = std::array<double, P::kNx>;

  LinearProgram(const P& problem, const Start& start, int horizon)
      : problem_{problem}, start_{start}, horizon_{horizon}, lp_{glp_create_prob()} {
    glp_term_out(GLP_OFF);
    glp_add_cols(lp_.get(), miss());
    for (int j = 1; j <= miss(); ++j) glp_set_col_bnds(lp_.get(), j, GLP_FR, 0.0, 0.0);
    glp_set_col_bnds(lp_.get(), miss(), GLP_LO, 0.0, 0.0);
    const std::array<double, P::kNx> no_state{};
    const std::array<double, P::kNu> no_input{};
    const auto x = variables_at<D>(no_state, 0);
    const auto u = variables_at<D>(no_input, P::kNx);
    for (int k = 0; k < horizon; ++k) {
      for (int m = 0; m < P::kNu; ++m) bound_input(k, m);
      int row = 0;
      for (const D& next : problem_.template dynamics<D>(k, x, u))
        add(next, k, state(k + 1, row++), -1.0, GLP_FX);
      for (const D& h : problem_.template equality<D>(k, x, u)) add_equation(h, k);
      row = 0;
      for (const D& c : problem_.template constraint<D>(k, x, u)) {
        if (is_hard(problem_, row++)) add(c, k, miss(), -1.0, GLP_UP);
      }
    }
    for (const D& h : problem_.template terminal_equality<D>(x)) add_equation(h, horizon);
    for (const D& g : problem_.template terminal_constraint<D>(x)) add(g, horizon, miss(), -1.0, GLP_UP);
  }

  /// The least largest miss; not a number where GLPK finds none.
  [[nodiscard]] double least_miss() {
    glp_set_obj_coef(lp_.get(), miss(), 1.0);
    const double least = solve();
    glp_set_obj_coef(lp_.get(), miss(), 0.0);
    return least;
  }
  /// The most that `row`, a linear function of x_N, can be where nothing is missed.
  [[nodiscard]] double most(const Start& row) {
    glp_set_col_bnds(lp_.get(), miss(), GLP_FX, 0.0, 0.0);
    for (int i = 0; i < P::kNx; ++i)
      glp_set_obj_coef(lp_.get(), state(horizon_, i), -row[static_cast<std::size_t>(i)]);
    return -solve();
  }
  /// The largest miss of the inputs that the last least_miss() found, simulated.
  [[nodiscard]] double miss_of_inputs() const {
    Trajectory t;
    t.horizon = horizon_;
    for (int k = 0; k < horizon_; ++k) {
      for (int m = 0; m < P::kNu; ++m)
        t.u[static_cast<std::size_t>(k)][static_cast<std::size_t>(m)] =
            glp_get_col_prim(lp_.get(), input(k, m));
    }
    solver::roll_out(problem_, start_, t);
    return check_kkt(problem_, t).miss;
  }

 private:
  using D = Dual<P::kNx + P::kNu>;
  struct Delete {
    void operator()(glp_prob* lp) const { glp_delete_prob(lp); }
  };

  [[nodiscard]] int state(int k, int i) const { return (k - 1) * P::kNx + i + 1; }  // k >= 1
  [[nodiscard]] int input(int k, int m) const { return horizon_ * P::kNx + k * P::kNu + m + 1; }
  [[nodiscard]] int miss() const { return horizon_ * (P::kNx + P::kNu) + 1; }

  void bound_input(int k, int m) {
    const double low = problem_.input_lower(k)[static_cast<std::size_t>(m)],
                 high = problem_.input_upper(k)[static_cast<std::size_t>(m)];
    const bool has_low = std::isfinite(low), has_high = std::isfinite(high);
    const int kind = has_low && has_high ? (low < high ? GLP_DB : GLP_FX)
                                         : (has_low ? GLP_LO : (has_high ? GLP_UP : GLP_FR));
    glp_set_col_bnds(lp_.get(), input(k, m), kind, low, high);
  }
  /// The row of a linear function of stage k, given at zero, and `factor` times another column: zero, or on
  /// one side of it.
  void add(const D& value, int k, int other, double factor, int kind) {
    std::vector<int> columns{0, other};
    std::vector<double> factors{0.0, factor};
    double offset = value.v;
    for (int v = 0; v < (k < horizon_ ? P::kNx + P::kNu : P::kNx); ++v) {
      const double slope = value.d[static_cast<std::size_t>(v)];
      if (v < P::kNx && k == 0) offset += slope * start_[static_cast<std::size_t>(v)];
      if (slope == 0.0 || (v < P::kNx && k == 0)) continue;
      columns.push_back(v < P::kNx ? state(k, v) : input(k, v - P::kNx));
      factors.push_back(slope);
    }
    const int row = glp_add_rows(lp_.get(), 1);
    glp_set_mat_row(lp_.get(), row, static_cast<int>(columns.size()) - 1, columns.data(), factors.data());
    glp_set_row_bnds(lp_.get(), row, kind, -offset, -offset);
  }
  void add_equation(const D& h, int k) {
    add(h, k, miss(), -1.0, GLP_UP);
    add(h, k, miss(), 1.0, GLP_LO);
  }
  double solve() {
    glp_smcp parameters;
    glp_init_smcp(&parameters);
    parameters.msg_lev = GLP_MSG_OFF;
    parameters.tol_bnd = parameters.tol_dj = 1e-10;
    parameters.tm_lim = 10000;
    glp_scale_prob(lp_.get(), GLP_SF_AUTO);
    glp_adv_basis(lp_.get(), 0);
    const bool is_solved = glp_simplex(lp_.get(), &parameters) == 0 && glp_get_status(lp_.get()) == GLP_OPT;
    return is_solved ? glp_get_obj_val(lp_.get()) : std::numeric_limits<double>::quiet_NaN();
  }

  OverArrays<P> problem_;
  Start start_;
  int horizon_;
  std::unique_ptr<glp_prob, Delete> lp_;
};

/// A random problem with linear dynamics and linear rows that must hold, whose cost is a sum of squares, of
/// penalties of a linear row, or nothing. All of its local minima are global.
template <int Nx, int Nu, int Capacity>
struct RandomConvex {
  static constexpr int kNx = Nx, kNu = Nu, kNr = Nx + Nu, kNe = Nx, kNc = 2, kNh = 1, kNeh = 2, kNec = 1;
  template <class T>
  using X = std::array<T, static_cast<std::size_t>(Nx)>;
  template <class T>
  using U = std::array<T, static_cast<std::size_t>(Nu)>;
  using Start = X<double>;
  /// A linear function of state and input.
  struct Row {
    X<double> x{};
    U<double> u{};
    double offset = 0.0;

    template <class T>
    [[nodiscard]] T of_state(const X<T>& at) const {
      T sum = x[0] * at[0] + offset;
      for (std::size_t i = 1; i < x.size(); ++i) sum = sum + x[i] * at[i];
      return sum;
    }
    template <class T>
    [[nodiscard]] T of(const X<T>& at, const U<T>& input) const {
      T sum = of_state(at);
      for (std::size_t m = 0; m < u.size(); ++m) sum = sum + u[m] * input[m];
      return sum;
    }
    static Row make(Random& random, double input_scale) {
      Row row;
      for (double& v : row.x) v = random.uniform() < 0.3 ? 0.0 : random.normal();
      for (double& v : row.u) v = random.uniform() < 0.3 ? 0.0 : input_scale * random.normal();
      row.x[static_cast<std::size_t>(random.uniform(0.0, Nx))] = 1.0;
      return row;
    }
  };

  std::array<Row, Nx> motion;
  std::array<Row, 2> limit, end;  ///< limit[0] is soft unless `all_hard`
  Row equation, end_limit;
  solver::StageData<Capacity> demand;  ///< right side of `equation`
  X<double> goal{}, weight{}, end_weight{};
  U<double> input_weight{}, low{}, high{};
  solver::SoftPenalty penalty;
  bool all_hard = true;

  [[nodiscard]] bool is_hard(int c) const { return all_hard || c > 0; }
  [[nodiscard]] solver::SoftPenalty soft_penalty(int) const { return penalty; }
  [[nodiscard]] U<double> input_lower(int) const { return low; }
  [[nodiscard]] U<double> input_upper(int) const { return high; }
  template <class K, class T>
  X<T> dynamics(K, const X<T>& x, const U<T>& u) const {
    X<T> next;
    for (std::size_t i = 0; i < next.size(); ++i) next[i] = motion[i].of(x, u);
    return next;
  }
  template <class K, class T>
  std::array<T, kNr> residual(K, const X<T>& x, const U<T>& u) const {
    std::array<T, kNr> r;
    for (std::size_t i = 0; i < x.size(); ++i) r[i] = weight[i] * (x[i] - goal[i]);
    for (std::size_t m = 0; m < u.size(); ++m) r[x.size() + m] = input_weight[m] * u[m];
    return r;
  }
  template <class T>
  X<T> terminal_residual(const X<T>& x) const {
    X<T> r;
    for (std::size_t i = 0; i < x.size(); ++i) r[i] = end_weight[i] * (x[i] - goal[i]);
    return r;
  }
  template <class K, class T>
  std::array<T, 2> constraint(K, const X<T>& x, const U<T>& u) const {
    return {limit[0].of(x, u), limit[1].of(x, u)};
  }
  template <class K, class T>
  std::array<T, 1> equality(K k, const X<T>& x, const U<T>& u) const {
    return {equation.of(x, u) - demand.at(k)};
  }
  template <class T>
  std::array<T, 2> terminal_equality(const X<T>& x) const {
    return {end[0].of_state(x), end[1].of_state(x)};
  }
  template <class T>
  std::array<T, 1> terminal_constraint(const X<T>& x) const {
    return {end_limit.of_state(x)};
  }

  /// Rows that a random motion from `start` fulfils, with some room or none; with noise in a third of all.
  static RandomConvex make(Random& random, Start& start, int horizon) {
    RandomConvex p;
    const auto chance = [&](double share) { return random.uniform() < share; };
    const auto decade = [&](double least, double most) {
      return std::pow(10.0, random.uniform(least, most));
    };
    const double speed = decade(-1.5, 0.0), scale = chance(0.3) ? decade(-2.0, 2.0) : 1.0;
    for (double& x : start) x = random.normal();
    for (std::size_t i = 0; i < Nx; ++i) {
      for (double& v : p.motion[i].x) v = 0.5 * speed * random.normal();
      p.motion[i].x[i] += chance(0.8) ? 1.0 : 0.5;
      for (double& v : p.motion[i].u) v = chance(0.3) ? 0.0 : speed * scale * random.normal();
      p.motion[i].offset = chance(0.5) ? 0.0 : 0.1 * random.normal();
    }
    const bool has_squares = chance(0.8);
    for (double& v : p.goal) v = random.normal();
    for (double& v : p.weight) v = has_squares && chance(0.7) ? decade(-2.0, 1.0) : 0.0;
    for (double& v : p.end_weight) v = has_squares && chance(0.5) ? decade(-1.0, 1.0) : 0.0;
    for (double& v : p.input_weight) v = has_squares && chance(0.8) ? scale * decade(-2.0, 0.0) : 0.0;
    for (std::size_t m = 0; m < Nu; ++m) {
      const double middle = random.normal() / scale, width = chance(0.05) ? 0.0 : decade(-1.0, 1.0) / scale;
      p.low[m] = chance(0.1) ? -std::numeric_limits<double>::infinity() : middle - width;
      p.high[m] = chance(0.1) ? std::numeric_limits<double>::infinity() : middle + width;
    }
    p.penalty = {.linear = decade(-1.0, 2.0), .quadratic = chance(0.3) ? 0.0 : decade(-1.0, 2.0)};
    p.all_hard = chance(0.5);
    const double of_inputs = scale * (chance(0.5) ? 0.0 : 1.0);
    for (Row& row : p.limit) {
      row = Row::make(random, of_inputs);
      row.offset = -1e3;  // far away
    }
    const bool has_equation = chance(0.3), has_end_limit = chance(0.5);
    if (has_equation) {
      p.equation = Row::make(random, scale);
      p.equation.u[0] = scale;
    }
    for (Row& row : p.end) row = chance(0.5) ? Row::make(random, 0.0) : Row{};
    if (has_end_limit) p.end_limit = Row::make(random, 0.0);
    p.fit(random, start, horizon, chance(0.35) ? decade(-4.0, 0.3) : 0.0);
    return p;
  }

 private:
  void fit(Random& random, Start x, int horizon, double noise) {
    const auto room = [&] {
      return random.uniform() < 0.4 ? 0.0 : std::pow(10.0, random.uniform(-4.0, 0.0));
    };
    std::array<double, 2> highest{-1e30, -1e30};
    const bool is_limited = random.uniform() < 0.8;
    for (int k = 0; k < horizon; ++k) {
      U<double> u;
      for (std::size_t m = 0; m < u.size(); ++m)
        u[m] = std::fmin(std::fmax(random.normal() / (1.0 + std::fabs(low[m])), low[m]), high[m]);
      demand[static_cast<std::size_t>(k)] = equation.of(x, u);
      for (std::size_t c = 0; c < 2; ++c) highest[c] = std::max(highest[c], limit[c].of(x, u));
      x = dynamics(k, x, u);
    }
    const bool is_noisy = noise > 0.0;
    for (std::size_t c = 0; is_limited && c < 2; ++c)
      limit[c].offset -= highest[c] + (is_noisy ? noise * random.normal() : room());
    for (Row& row : end) row.offset = noise * random.normal() - row.of_state(x);
    end_limit.offset = (is_noisy ? noise * random.normal() : -room()) - end_limit.of_state(x);
    if (equation.u[0] == 0.0) return;
    for (int k = 0; is_noisy && k < horizon; ++k)
      demand[static_cast<std::size_t>(k)] += noise * random.normal();
  }
};

/// How many of each; `open`: their least miss lies between GLPK's precision and the tolerance.
struct Tally {
  long possible = 0, solved = 0, impossible = 0, reported = 0, open = 0, unknown = 0, untrue = 0,
       iterations = 0;
};

template <int Nx, int Nu>
void try_one(long seed, Tally& tally) {
  constexpr int kCapacity = 20;
  constexpr double kPrecision = 1e-9;  // feasibility tolerance of GLPK
  using P = RandomConvex<Nx, Nu, kCapacity>;
  using Ocp = solver::OcpSolver<P, kCapacity>;
  using Lp = LinearProgram<P, kCapacity>;
  Random random{static_cast<std::uint64_t>(seed) * 2654435761U + 11U};
  const auto chance = [&](double share) { return random.uniform() < share; };
  const int horizon = 2 + static_cast<int>(random.uniform(0.0, kCapacity - 1.0));
  typename P::Start start;
  P problem = P::make(random, start, horizon);
  if (chance(0.4)) {  // an end a little within or beyond what can be reached
    const double gap = (chance(0.5) ? 1.0 : -1.0) * std::pow(10.0, random.uniform(-5.0, 0.0));
    auto& row = problem.end[0];
    row = {};
    const auto goal = P::Row::make(random, 0.0);
    const double most = Lp(problem, start, horizon).most(goal.x);
    if (std::fabs(most) < 1e6) {
      row = goal;
      row.offset = -most - gap;
    }
  }
  Lp lp(problem, start, horizon);
  const double least = lp.least_miss(), simulated = lp.miss_of_inputs();
  constexpr std::array kTolerances{1e-6, 1e-6, 1e-4, 1e-8};
  const double tolerance = kTolerances[static_cast<std::size_t>(random.uniform(0.0, 4.0))];
  const auto ocp =
      std::make_unique<Ocp>(solver::SolverOptions{.tolerance = tolerance, .start_from_states = chance(0.5)});
  typename Lp::Trajectory t;
  t.horizon = horizon;
  for (auto& u : t.u) u.fill(chance(0.3) ? random.normal() : 0.0);
  for (auto& x : t.x) x = start;
  const solver::HardReport report = ocp->solve(problem, start, t);
  const bool is_reported = report.status == solver::SolveStatus::kInfeasible,
             is_usable = usable(report.status);
  tally.iterations += report.iterations;
  const char* wrong = nullptr;
  // GLPK rounds, too: an answer that holds shows that the problem is possible, inputs of GLPK that miss when
  // they are simulated do not.
  const KktResidual kkt = check_kkt(problem, t, *ocp);
  const bool holds = std::max(kkt.miss, kkt.defect) <= 1.5 * tolerance && kkt.outside <= 0.0;
  const bool is_optimal =
      kkt.stationarity <= 1.5 * tolerance + kkt.rounding && kkt.subgradient <= 2.0 * std::sqrt(tolerance);
  if (report.status == solver::SolveStatus::kOptimal && !is_optimal) wrong = "optimal, but not the least";
  if (is_usable && !holds) wrong = "usable, but misses";
  if (!(least < 1e30) || (holds && least > tolerance) || (least <= kPrecision && simulated > tolerance)) {
    ++tally.unknown;
  } else if (least > 1.01 * tolerance + kPrecision) {
    ++tally.impossible;
    tally.reported += is_reported ? 1 : 0;
    if (!is_usable && !is_reported) wrong = "(impossible, not reported)";
  } else if (least > kPrecision) {
    ++tally.open;
  } else {
    ++tally.possible;
    tally.solved += is_usable ? 1 : 0;
    if (is_reported) wrong = "infeasible, but possible";
    if (!is_usable && !is_reported) wrong = "(possible, not solved)";
  }
  if (wrong == nullptr) return;
  tally.untrue += wrong[0] == '(' ? 0 : 1;
  std::printf(
      "%d states, seed %ld: %s: %s, %d iterations, tolerance %.0e, least miss %.3g, miss %.3g, cost %.6g\n",
      Nx, seed, wrong, solver::to_string(report.status).data(), report.iterations, tolerance, least,
      report.miss, report.cost);
}

}  // namespace
}  // namespace chicane::bench

int main(int argc, char** argv) {
  using namespace chicane::bench;
  const long count = argc > 1 ? std::atol(argv[1]) : 100000, first = argc > 2 ? std::atol(argv[2]) : 0;
  Tally tally;
  for (long seed = first; seed < first + count; ++seed) {
    seed % 2 == 0 ? try_one<2, 1>(seed, tally) : try_one<4, 2>(seed, tally);
  }
  std::printf(
      "of %ld possible %ld solved; of %ld impossible %ld reported; %ld between, %ld unknown; %ld untrue; "
      "%.0f "
      "iterations\n",
      tally.possible, tally.solved, tally.impossible, tally.reported, tally.open, tally.unknown, tally.untrue,
      static_cast<double>(tally.iterations) / static_cast<double>(count));
  return tally.untrue == 0 ? 0 : 1;
}
