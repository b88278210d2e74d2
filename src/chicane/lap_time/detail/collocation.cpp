// SPDX-License-Identifier: MIT
// Interior-point search for the fastest lap: barrier steps, line search with a filter, and one cyclic linear
// system for each iteration.
#include "chicane/lap_time/detail/collocation.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "chicane/base/math.hpp"
#include "chicane/lap_time/detail/cyclic_system.hpp"

namespace chicane::lap_time {
namespace {

using std::size_t;

// Chosen, as usual for the method (Wächter, Biegler 2006).
constexpr double kLeastSlack = 1e-2;       // smallest slack at the start
constexpr double kToBoundary = 0.99;       // share of the way to a slack of zero, at least
constexpr double kEquationShift = 1e-9;    // keeps dependent equations solvable
constexpr double kFirstShift = 1e-4;       // first shift of the Hessian, if its curvature is wrong
constexpr double kMostShift = 1e10;        // largest shift: beyond it the search fails
constexpr double kBarrierFall = 0.2;       // next barrier over this one, at most
constexpr double kBarrierError = 10.0;     // error over μ at which a barrier problem counts as solved
constexpr double kMultiplierRange = 1e10;  // largest factor between ν and μ / s
constexpr double kBarrierShare = 1e-2;     // barrier over the tolerance below which the search may end
constexpr int kHalvings = 12;              // trial steps of a line search
constexpr double kKick = 0.1;              // share of the step without descent, to leave a stuck point

}  // namespace

/// Point of the search, or a step: variables scaled to about one, slacks s of the inequalities, and the
/// multipliers ν of the inequalities, λ of the intervals, η of the nodes' equations.
struct Collocation::Iterate {
  std::vector<double> w, slack, nu, lambda, eta;
};

/// One solution of a problem. Names of sizes: n nodes; for each node nz variables, nx states, na equations,
/// ng inequalities, nm functions and nb unknowns of the linear system.
class Collocation::Search {
 public:
  Search(const Collocation& problem, const Options& options)
      : f_{problem.functions_},
        steps_{problem.steps_},
        changes_{problem.changes_},
        options_{options},
        n_{steps_.size()},
        nz_{static_cast<size_t>(f_.variables)},
        nx_{static_cast<size_t>(f_.states)},
        na_{static_cast<size_t>(f_.equations)},
        ng_{static_cast<size_t>(f_.inequalities)},
        nm_{nx_ + na_ + 1 + ng_},
        nb_{nz_ + nx_ + na_},
        system_{static_cast<int>(n_), f_.variables, f_.states, f_.equations},
        out_(n_ * nm_),
        jacobian_(n_ * nm_ * nz_),
        hessian_(n_ * nz_ * (nz_ + 1) / 2),
        gap_(n_ * (nx_ + na_)) {}

  Report run(std::vector<double>& z) {
    begin(z);
    Report report;
    double mu = options_.first_barrier;
    for (; report.iterations <= options_.most_iterations; ++report.iterations) {
      differentiate();
      report.cost = cost() / options_.cost_scale;
      report.barrier = mu;
      measure(0.0);
      report.stationarity = stationarity_;
      report.violation = violation_;
      if (options_.go_on && !options_.go_on(report.iterations, report.cost, violation_)) {
        report.is_stopped = true;
        break;
      }
      if (options_.is_enough) {
        write(z);
        report.is_solved = options_.is_enough(z, violation_);
        if (report.is_solved) break;
      }
      if (error() <= options_.tolerance &&
          mu <= std::max(1.0001 * options_.last_barrier, kBarrierShare * options_.tolerance)) {
        report.is_solved = true;
        break;
      }
      // Lower the barrier as long as its problem is solved, then make a step.
      bool has_fallen = false;
      while (measure(mu), error() <= kBarrierError * mu && mu > options_.last_barrier) {
        mu = std::max(options_.last_barrier, std::min(kBarrierFall * mu, mu * std::sqrt(mu)));
        has_fallen = true;
      }
      if (has_fallen) filter_.clear();
      if (!std::isfinite(error()) || !direction(mu)) break;
      step(mu);
    }
    write(z);
    return report;
  }

 private:
  /// Copies the variables to z, unscaled.
  void write(std::vector<double>& z) const {
    for (size_t i = 0; i < z.size(); ++i) z[i] = now_.w[i] * f_.scale[i % nz_];
  }
  /// Starts at the variables z, with slacks and multipliers near the first barrier's.
  void begin(const std::vector<double>& z) {
    now_.w.resize(z.size());
    for (size_t i = 0; i < z.size(); ++i) now_.w[i] = z[i] / f_.scale[i % nz_];
    evaluate(now_.w, out_);
    now_.slack.resize(n_ * ng_);
    now_.nu.resize(n_ * ng_);
    for (size_t k = 0; k < n_; ++k) {
      for (size_t j = 0; j < ng_; ++j) {
        now_.slack[k * ng_ + j] = std::max(inequality(out_, k, j), kLeastSlack);
        now_.nu[k * ng_ + j] = options_.first_barrier / now_.slack[k * ng_ + j];
      }
    }
    now_.lambda.assign(n_ * nx_, 0.0);
    now_.eta.assign(n_ * na_, 0.0);
  }

  [[nodiscard]] size_t after(size_t k) const { return k + 1 < n_ ? k + 1 : 0; }
  [[nodiscard]] size_t before(size_t k) const { return k > 0 ? k - 1 : n_ - 1; }
  [[nodiscard]] double inequality(const std::vector<double>& out, size_t k, size_t j) const {
    return out[k * nm_ + nx_ + na_ + 1 + j];
  }
  /// Weight of node k's cost: half of the intervals before and after it.
  [[nodiscard]] double share(size_t k) const {
    return 0.5 * (steps_[k] + steps_[before(k)]) * options_.cost_scale;
  }

  /// Sets z_ to the variables of node k, unscaled.
  void unscale(const std::vector<double>& w, size_t k) {
    z_.resize(nz_);
    for (size_t i = 0; i < nz_; ++i) z_[i] = w[k * nz_ + i] * f_.scale[i];
  }
  /// Values of all functions at w, with scaled rates.
  void evaluate(const std::vector<double>& w, std::vector<double>& out) {
    for (size_t k = 0; k < n_; ++k) {
      unscale(w, k);
      f_.values(static_cast<int>(k), z_.data(), out.data() + k * nm_);
      for (size_t i = 0; i < nx_; ++i) out[k * nm_ + i] /= f_.scale[i];
    }
  }

  /// Values, Jacobians and Hessians of the Lagrangian at the present point. λ_k belongs to the interval that
  /// ends at node k.
  void differentiate() {
    std::vector<double> weights(nm_);
    for (size_t k = 0; k < n_; ++k) {
      const size_t next = after(k);
      for (size_t i = 0; i < nx_; ++i)
        weights[i] =
            -0.5 * (steps_[before(k)] * now_.lambda[k * nx_ + i] + steps_[k] * now_.lambda[next * nx_ + i]) /
            f_.scale[i];
      for (size_t i = 0; i < na_; ++i) weights[nx_ + i] = now_.eta[k * na_ + i];
      weights[nx_ + na_] = share(k);
      for (size_t j = 0; j < ng_; ++j) weights[nx_ + na_ + 1 + j] = -now_.nu[k * ng_ + j];
      unscale(now_.w, k);
      double* jacobian = jacobian_.data() + k * nm_ * nz_;
      double* hessian = hessian_.data() + k * nz_ * (nz_ + 1) / 2;
      f_.derivatives(static_cast<int>(k), z_.data(), weights.data(), out_.data() + k * nm_, jacobian,
                     hessian);
      for (size_t m = 0; m < nm_; ++m)
        for (size_t i = 0; i < nz_; ++i) jacobian[m * nz_ + i] *= f_.scale[i] / (m < nx_ ? f_.scale[m] : 1.0);
      for (size_t i = 0, at = 0; i < nz_; ++i)
        for (size_t j = 0; j <= i; ++j, ++at) hessian[at] *= f_.scale[i] * f_.scale[j];
      for (size_t i = 0; i < nx_; ++i) out_[k * nm_ + i] /= f_.scale[i];
    }
    gaps(now_.w, out_, gap_);
  }

  /// Defects of the intervals (at the node where they end) and the nodes' own equations.
  void gaps(const std::vector<double>& w, const std::vector<double>& out, std::vector<double>& gap) const {
    for (size_t k = 0; k < n_; ++k) {
      const size_t last = before(k);
      for (size_t i = 0; i < nx_; ++i)
        gap[k * (nx_ + na_) + i] = w[k * nz_ + i] - w[last * nz_ + i] -
                                   0.5 * steps_[last] * (out[last * nm_ + i] + out[k * nm_ + i]) -
                                   changes_[last * nx_ + i] / f_.scale[i];
      for (size_t i = 0; i < na_; ++i) gap[k * (nx_ + na_) + nx_ + i] = out[k * nm_ + nx_ + i];
    }
  }

  /// Sum of the nodes' costs.
  [[nodiscard]] double cost(const std::vector<double>& out) const {
    double sum = 0.0;
    for (size_t k = 0; k < n_; ++k) sum += share(k) * out[k * nm_ + nx_ + na_];
    return sum;
  }
  [[nodiscard]] double cost() const { return cost(out_); }

  /// Row of the Jacobian of node k for its function m.
  [[nodiscard]] const double* slope(size_t k, size_t m) const { return &jacobian_[(k * nm_ + m) * nz_]; }
  /// Derivative of the i-th defect of the interval that ends at node k by the j-th variable of the node.
  [[nodiscard]] double end_slope(size_t k, size_t i, size_t j) const {
    return (i == j ? 1.0 : 0.0) - 0.5 * steps_[before(k)] * slope(k, i)[j];
  }
  /// Derivative of the i-th defect of the interval that begins at node k by the j-th variable of the node.
  [[nodiscard]] double begin_slope(size_t k, size_t i, size_t j) const {
    return (i == j ? -1.0 : 0.0) - 0.5 * steps_[k] * slope(k, i)[j];
  }

  /// Residuals of the optimality conditions of the problem with barrier μ.
  void measure(double mu) {
    double most_slope = 0.0;
    double multipliers = 0.0;
    double of_inequalities = 0.0;
    violation_ = complementarity_ = 0.0;
    for (size_t k = 0; k < n_; ++k) {
      for (size_t j = 0; j < nz_; ++j) {
        double sum = share(k) * slope(k, nx_ + na_)[j];
        for (size_t i = 0; i < nx_; ++i)
          sum += end_slope(k, i, j) * now_.lambda[k * nx_ + i] +
                 begin_slope(k, i, j) * now_.lambda[after(k) * nx_ + i];
        for (size_t i = 0; i < na_; ++i) sum += slope(k, nx_ + i)[j] * now_.eta[k * na_ + i];
        for (size_t i = 0; i < ng_; ++i) sum -= slope(k, nx_ + na_ + 1 + i)[j] * now_.nu[k * ng_ + i];
        most_slope = std::max(most_slope, std::fabs(sum));
      }
      for (size_t j = 0; j < ng_; ++j) {
        const double s = now_.slack[k * ng_ + j];
        violation_ = std::max(violation_, std::fabs(inequality(out_, k, j) - s));
        complementarity_ = std::max(complementarity_, std::fabs(s * now_.nu[k * ng_ + j] - mu));
        of_inequalities += now_.nu[k * ng_ + j];
      }
    }
    for (const double g : gap_) violation_ = std::max(violation_, std::fabs(g));
    for (const double l : now_.lambda) multipliers += std::fabs(l);
    for (const double l : now_.eta) multipliers += std::fabs(l);
    const double inequalities = static_cast<double>(n_ * ng_);
    const double all = inequalities + static_cast<double>(n_ * (nx_ + na_));
    constexpr double kLarge = 100.0;  // mean multiplier above which errors are scaled
    stationarity_ = most_slope / (std::max(kLarge, (multipliers + of_inequalities) / all) / kLarge);
    complementarity_ /= std::max(kLarge, of_inequalities / inequalities) / kLarge;
  }
  [[nodiscard]] double error() const { return std::max({stationarity_, violation_, complementarity_}); }

  /// Fills matrix and right-hand side of the Newton step, with slacks and ν eliminated and `shift` added to
  /// the diagonal of the Hessian.
  void fill(double mu, double shift) {
    right_.assign(n_ * nb_, 0.0);
    for (size_t k = 0; k < n_; ++k) {
      double* d = system_.diagonal(static_cast<int>(k));
      double* r = right_.data() + k * nb_;
      std::fill_n(d, nb_ * nb_, 0.0);
      const double* hessian = hessian_.data() + k * nz_ * (nz_ + 1) / 2;
      for (size_t i = 0, at = 0; i < nz_; ++i)
        for (size_t j = 0; j <= i; ++j, ++at) d[i * nb_ + j] = hessian[at] + (i == j ? shift : 0.0);
      for (size_t j = 0; j < nz_; ++j) r[j] = -share(k) * slope(k, nx_ + na_)[j];
      for (size_t c = 0; c < ng_; ++c) {
        const double s = now_.slack[k * ng_ + c];
        const double weight = now_.nu[k * ng_ + c] / s;
        const double push = mu / s - weight * (inequality(out_, k, c) - s);
        const double* g = slope(k, nx_ + na_ + 1 + c);
        for (size_t i = 0; i < nz_; ++i) {
          if (g[i] == 0.0) continue;
          r[i] += g[i] * push;
          for (size_t j = 0; j <= i; ++j) d[i * nb_ + j] += weight * g[i] * g[j];
        }
      }
      for (size_t i = 0; i < nx_; ++i)
        for (size_t j = 0; j < nz_; ++j) d[(nz_ + i) * nb_ + j] = end_slope(k, i, j);
      for (size_t i = 0; i < na_; ++i)
        for (size_t j = 0; j < nz_; ++j) d[(nz_ + nx_ + i) * nb_ + j] = slope(k, nx_ + i)[j];
      for (size_t i = 0; i < nx_ + na_; ++i) {
        d[(nz_ + i) * nb_ + nz_ + i] = -kEquationShift;
        r[nz_ + i] = -gap_[k * (nx_ + na_) + i];
      }
      for (size_t i = 0; i < nb_; ++i)
        for (size_t j = 0; j < i; ++j) d[j * nb_ + i] = d[i * nb_ + j];
      double* b = system_.coupling(static_cast<int>(k));
      for (size_t i = 0; i < nx_; ++i)
        for (size_t j = 0; j < nz_; ++j) b[i * nz_ + j] = begin_slope(k, i, j);
    }
  }

  /// Finds the Newton step of the barrier problem, with the Hessian shifted until its curvature is right.
  /// False if no shift suffices.
  bool direction(double mu) {
    double shift = 0.0;
    for (fill(mu, shift); !system_.factor(); fill(mu, shift)) {
      shift = shift > 0.0 ? 8.0 * shift : std::max(kFirstShift, last_shift_ / 3.0);
      if (shift > kMostShift) return false;
    }
    if (shift > 0.0) last_shift_ = shift;
    system_.solve(right_);
    move_ = now_;
    for (size_t k = 0; k < n_; ++k) {
      const double* r = right_.data() + k * nb_;
      for (size_t j = 0; j < nz_; ++j) move_.w[k * nz_ + j] = r[j];
      for (size_t i = 0; i < nx_; ++i) move_.lambda[k * nx_ + i] = r[nz_ + i] - now_.lambda[k * nx_ + i];
      for (size_t i = 0; i < na_; ++i) move_.eta[k * na_ + i] = r[nz_ + nx_ + i] - now_.eta[k * na_ + i];
      for (size_t c = 0; c < ng_; ++c) {
        const size_t at = k * ng_ + c;
        const double* g = slope(k, nx_ + na_ + 1 + c);
        double ds = inequality(out_, k, c) - now_.slack[at];
        for (size_t j = 0; j < nz_; ++j) ds += g[j] * r[j];
        move_.slack[at] = ds;
        move_.nu[at] = mu / now_.slack[at] - now_.nu[at] - now_.nu[at] / now_.slack[at] * ds;
      }
    }
    return true;
  }

  /// Cost with barrier terms, and sum of violations: the two measures of the filter.
  struct Point {
    double cost = 0.0, violation = 0.0;
  };
  /// The measures of a point whose functions have the values `out`.
  [[nodiscard]] Point merit(const std::vector<double>& w, const std::vector<double>& slack, double mu,
                            const std::vector<double>& out) const {
    std::vector<double> gap(gap_.size());
    gaps(w, out, gap);
    Point p{cost(out), 0.0};
    for (const double g : gap) p.violation += std::fabs(g);
    for (size_t k = 0; k < n_; ++k) {
      for (size_t j = 0; j < ng_; ++j) {
        p.cost -= mu * chicane::log(slack[k * ng_ + j]);
        p.violation += std::fabs(inequality(out, k, j) - slack[k * ng_ + j]);
      }
    }
    return p;
  }

  /// Slope of Point::cost along the step.
  [[nodiscard]] double cost_slope(double mu) const {
    double sum = 0.0;
    for (size_t k = 0; k < n_; ++k)
      for (size_t j = 0; j < nz_; ++j) sum += share(k) * slope(k, nx_ + na_)[j] * move_.w[k * nz_ + j];
    for (size_t i = 0; i < now_.slack.size(); ++i) sum -= mu * move_.slack[i] / now_.slack[i];
    return sum;
  }

  /// Moves along the Newton step as far as slacks and filter permit.
  void step(double mu) {
    const double keep = std::max(kToBoundary, 1.0 - mu);
    double primal = 1.0;
    double dual = 1.0;
    for (size_t i = 0; i < now_.slack.size(); ++i) {
      if (move_.slack[i] < 0.0) primal = std::min(primal, -keep * now_.slack[i] / move_.slack[i]);
      if (move_.nu[i] < 0.0) dual = std::min(dual, -keep * now_.nu[i] / move_.nu[i]);
    }
    const Point here = merit(now_.w, now_.slack, mu, out_);
    const double descent = cost_slope(mu);
    std::vector<double> w(now_.w.size());
    std::vector<double> slack(now_.slack.size());
    std::vector<double> out(out_.size());
    double length = primal;
    for (int i = 0; i < kHalvings; ++i, length *= 0.5) {
      for (size_t j = 0; j < w.size(); ++j) w[j] = now_.w[j] + length * move_.w[j];
      for (size_t j = 0; j < slack.size(); ++j) slack[j] = now_.slack[j] + length * move_.slack[j];
      evaluate(w, out);
      const Point there = merit(w, slack, mu, out);
      if (accepts(here, there, length * descent)) return move(length, dual, mu);
    }
    // The filter accepts no point along this step: clear it, and leave the point by a short step.
    filter_.clear();
    move(kKick * primal, dual, mu);
  }

  /// Whether the filter accepts a step between two points; `descent`: predicted change of the cost.
  [[nodiscard]] bool accepts(const Point& here, const Point& there, double descent) {
    constexpr double kShare = 1e-5;   // margin of the filter, over the violation
    constexpr double kArmijo = 1e-4;  // least share of the predicted descent
    if (!std::isfinite(there.cost + there.violation)) return false;
    for (const Point& p : filter_)
      if (there.violation >= (1.0 - kShare) * p.violation && there.cost >= p.cost - kShare * p.violation)
        return false;
    const double rounding = 1e-11 * std::fabs(here.cost);
    const bool is_descent = descent < 0.0 && here.violation <= 1e-3 && descent * descent > here.violation;
    if (is_descent) return there.cost <= here.cost + kArmijo * descent + rounding;
    const bool is_better = there.violation <= (1.0 - kShare) * here.violation ||
                           there.cost <= here.cost - kShare * here.violation + rounding;
    if (is_better) filter_.push_back(here);
    return is_better;
  }

  /// Moves by shares of the step: primal for variables, slacks, λ and η, dual for ν.
  void move(double primal, double dual, double mu) {
    for (size_t i = 0; i < now_.w.size(); ++i) now_.w[i] += primal * move_.w[i];
    for (size_t i = 0; i < now_.lambda.size(); ++i) now_.lambda[i] += primal * move_.lambda[i];
    for (size_t i = 0; i < now_.eta.size(); ++i) now_.eta[i] += primal * move_.eta[i];
    for (size_t i = 0; i < now_.slack.size(); ++i) {
      now_.slack[i] += primal * move_.slack[i];
      const double centre = mu / now_.slack[i];
      now_.nu[i] =
          std::clamp(now_.nu[i] + dual * move_.nu[i], centre / kMultiplierRange, centre * kMultiplierRange);
    }
  }

  const NodeFunctions& f_;
  const std::vector<double>& steps_;
  const std::vector<double>& changes_;
  const Options& options_;
  size_t n_, nz_, nx_, na_, ng_, nm_, nb_;
  CyclicSystem system_;
  std::vector<double> out_, jacobian_, hessian_;  ///< functions of all nodes, and their derivatives
  std::vector<double> gap_;                       ///< gaps()
  std::vector<double> right_, z_;                 ///< right-hand side, variables of a node
  Iterate now_, move_;                            ///< present point, and the Newton step from it
  std::vector<Point> filter_;                     ///< points that later ones must improve on
  double stationarity_ = 0.0, violation_ = 0.0, complementarity_ = 0.0;  ///< residuals of measure()
  double last_shift_ = 0.0;  ///< last shift of the Hessian that was needed
};

Collocation::Collocation(const NodeFunctions& functions, std::vector<double> steps,
                         std::vector<double> changes)
    : functions_{functions}, steps_{std::move(steps)}, changes_{std::move(changes)} {}

Collocation::Report Collocation::solve(std::vector<double>& z, const Options& options) {
  return Search(*this, options).run(z);
}

}  // namespace chicane::lap_time
