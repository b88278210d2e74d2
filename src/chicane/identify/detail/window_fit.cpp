// SPDX-License-Identifier: MIT
// Least-squares fit of all windows of the logs at once: the start of each window is eliminated from the
// common numbers. Deviations by correlation and jackknife (docs/identification.md).
#include "chicane/identify/detail/window_fit.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <span>

#include "chicane/base/median.hpp"

namespace chicane::identify {
namespace {

constexpr int kStartSize = 6;           // numbers of a Start
constexpr double kHuber = 2.5;          // deviations from which on a residual counts linearly; chosen
constexpr double kSideslipSpeed = 1.0;  // [m/s] prior deviation of v_y at a start; chosen
constexpr int kFirstSteps = 5;          // steps that fit a start alone; chosen
constexpr Start kStartStep{1e-4, 1e-4, 1e-5, 1e-4, 1e-4, 1e-5};  // differences of derivatives, units of Start

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Residuals of a window that begins at `start`, over their deviations: five of each sample, then the prior
/// of v_y.
void residuals(const Car& car, const DriveLog& log, const Actuators& actuators, const Window& window,
               const Start& start, const Noise& noise, VectorXd& r) {
  std::vector<Expected> expected;
  drive(car, log, actuators, window.first, window.last, start, expected);
  const auto count = static_cast<Eigen::Index>(window.last - window.first);
  r.resize(5 * count + 1);
  for (Eigen::Index n = 0; n < count; ++n) {
    const Sample& seen = log.samples[window.first + static_cast<std::size_t>(n)];
    const Expected& e = expected[static_cast<std::size_t>(n)];
    r[5 * n] = (e[0] - seen.x) / noise[0];
    r[5 * n + 1] = (e[1] - seen.y) / noise[1];
    r[5 * n + 2] = (e[2] - seen.psi) / noise[2];
    r[5 * n + 3] = (e[3] - seen.speed) / noise[3];
    r[5 * n + 4] = std::isfinite(seen.yaw_rate) ? (e[4] - seen.yaw_rate) / noise[4] : 0.0;
  }
  r[5 * count] = start[4] / kSideslipSpeed;
}

/// Huber's loss of residuals.
double loss(const VectorXd& r) {
  double sum = 0.0;
  for (const double each : r) {
    const double size = std::fabs(each);
    sum += size <= kHuber ? 0.5 * size * size : kHuber * (size - 0.5 * kHuber);
  }
  return sum;
}

/// Roots of the weights with which least squares have the slope of Huber's loss.
VectorXd roots_of_weights(const VectorXd& r) {
  return r.unaryExpr(
      [](double each) { return std::fabs(each) <= kHuber ? 1.0 : std::sqrt(kHuber / std::fabs(each)); });
}

/// Linearised window with its start eliminated (eq. 9): residuals rest + by_theta Δθ that no start can
/// explain, and the start that follows from θ, start_matrix Δstart = −(start_rest + start_theta Δθ).
struct Eliminated {
  MatrixXd by_theta;
  VectorXd rest;
  MatrixXd start_matrix;  ///< upper triangular
  MatrixXd start_theta;
  VectorXd start_rest;
};

/// Eliminates the start from residuals `r` with the given derivatives, by QR.
Eliminated eliminate(const MatrixXd& by_start, const MatrixXd& by_theta, const VectorXd& r) {
  const Eigen::HouseholderQR<MatrixXd> qr(by_start);
  MatrixXd all(r.size(), by_theta.cols() + 1);
  all << by_theta, r;
  all.applyOnTheLeft(qr.householderQ().adjoint());
  const Eigen::Index below = r.size() - kStartSize;
  Eliminated e;
  e.by_theta = all.bottomLeftCorner(below, by_theta.cols());
  e.rest = all.bottomRightCorner(below, 1);
  e.start_matrix = qr.matrixQR().topRows(kStartSize).triangularView<Eigen::Upper>();
  e.start_matrix.diagonal().array() += (e.start_matrix.diagonal().array() == 0.0).cast<double>() * 1e-12;
  e.start_theta = all.topLeftCorner(kStartSize, by_theta.cols());
  e.start_rest = all.topRightCorner(kStartSize, 1);
  return e;
}

/// Start, moved by a step.
Start moved(Start start, const VectorXd& by) {
  for (int i = 0; i < kStartSize; ++i) start[static_cast<std::size_t>(i)] += by[i];
  return start;
}

/// Derivatives of the residuals `r` of a window by its start, by one-sided differences.
MatrixXd derivatives_by_start(const Car& car, const DriveLog& log, const Actuators& actuators,
                              const Window& window, const Noise& noise, const VectorXd& r) {
  MatrixXd j(r.size(), kStartSize);
  VectorXd other;
  for (std::size_t i = 0; i < kStartSize; ++i) {
    Start start = window.start;
    start[i] += kStartStep[i];
    residuals(car, log, actuators, window, start, noise, other);
    j.col(static_cast<Eigen::Index>(i)) = (other - r) / kStartStep[i];
  }
  return j;
}

/// Loss of a window that begins at `start`; infinite if the prediction is not finite.
double loss_from(const DriveLog& log, const Window& window, const Car& car, const Actuators& actuators,
                 const Noise& noise, const Start& start) {
  VectorXd r;
  residuals(car, log, actuators, window, start, noise, r);
  const double sum = loss(r);
  return std::isfinite(sum) ? sum : std::numeric_limits<double>::infinity();
}

/// Moves the start of a window by the share of `step` with the least loss, and returns that loss.
double move_start(const DriveLog& log, Window& window, const Car& car, const Actuators& actuators,
                  const Noise& noise, const VectorXd& step) {
  double best = std::numeric_limits<double>::infinity();
  const Start from = window.start;
  for (const double share : {1.0, 0.5, 0.2, 0.05, 0.0}) {
    const Start tried = moved(from, share * step);
    const double now = loss_from(log, window, car, actuators, noise, tried);
    if (now < best) {
      best = now;
      window.start = tried;
    }
    if (share == 1.0 && best < std::numeric_limits<double>::infinity() &&
        best < loss_from(log, window, car, actuators, noise, from))
      break;
  }
  return best;
}

/// Improves the start of a window alone by `steps` of Gauss and Newton, and returns the loss.
double improve_start(const DriveLog& log, Window& window, const Car& car, const Actuators& actuators,
                     const Noise& noise, int steps) {
  VectorXd r;
  double now = std::numeric_limits<double>::infinity();
  for (int i = 0; i < steps; ++i) {
    residuals(car, log, actuators, window, window.start, noise, r);
    const VectorXd root = roots_of_weights(r);
    const MatrixXd j = root.asDiagonal() * derivatives_by_start(car, log, actuators, window, noise, r);
    now =
        move_start(log, window, car, actuators, noise, -j.colPivHouseholderQr().solve(root.cwiseProduct(r)));
  }
  return now;
}

/// Numbers as a vector of Eigen, and back.
Eigen::Map<const VectorXd> mapped(const std::vector<double>& values) {
  return {values.data(), static_cast<Eigen::Index>(values.size())};
}
std::vector<double> listed(const VectorXd& values) { return {values.begin(), values.end()}; }

/// Prior with vectors of Eigen.
struct Expectation {
  explicit Expectation(const Prior& prior)
      : mean{mapped(prior.mean)}, deviation{mapped(prior.deviation)}, of{prior.car} {}
  [[nodiscard]] Car car(const VectorXd& theta) const { return of(listed(theta)); }
  VectorXd mean, deviation;
  const std::function<Car(const std::vector<double>&)>& of;
};

/// Loss of the numbers by the prior.
double loss_of_prior(const Expectation& prior, const VectorXd& theta) {
  return 0.5 * (theta - prior.mean).cwiseQuotient(prior.deviation).squaredNorm();
}

/// Prior and all windows, linearised at one theta.
struct Linearised {
  MatrixXd information;                ///< Gauss–Newton matrix of theta: prior and all windows
  VectorXd slope;                      ///< gradient of the loss by theta
  std::vector<MatrixXd> informations;  ///< part of each window in `information`
  std::vector<VectorXd> slopes;        ///< part of each window in `slope`
  std::vector<Eliminated> windows;     ///< for the starts; without by_theta
};

/// Linearises at `theta`, by one-sided differences.
Linearised linearise(const std::vector<DriveLog>& logs, const std::vector<Window>& windows,
                     const Expectation& prior, const VectorXd& theta, const Noise& noise) {
  const Eigen::Index p = theta.size();
  const VectorXd weight = prior.deviation.cwiseAbs2().cwiseInverse();
  Linearised now{weight.asDiagonal(), weight.cwiseProduct(theta - prior.mean), {}, {}, {}};
  struct Side {  // car at a point of the differences, and its actuators under each log
    Car car;
    std::vector<Actuators> actuators;
  };
  const auto side = [&](Eigen::Index i, double step) {
    VectorXd other = theta;
    if (i >= 0) other[i] += step;
    const Car car = prior.car(other);
    return Side{car, actuators_of(logs, car)};
  };
  std::vector<Side> sides;  // one-sided points for each number
  const VectorXd steps = 1e-4 * prior.deviation;
  const Side here = side(-1, 0.0);
  for (Eigen::Index i = 0; i < p; ++i) sides.push_back(side(i, steps[i]));
  VectorXd r, beside;
  for (const Window& window : windows) {
    const DriveLog& log = logs[window.log];
    const auto at = [&](const Side& s, VectorXd& to) {
      residuals(s.car, log, s.actuators[window.log], window, window.start, noise, to);
    };
    at(here, r);
    MatrixXd by_theta(r.size(), p);
    for (Eigen::Index i = 0; i < p; ++i) {
      at(sides[static_cast<std::size_t>(i)], beside);
      by_theta.col(i) = (beside - r) / steps[i];
    }
    const VectorXd root = roots_of_weights(r);
    const MatrixXd by_start =
        root.asDiagonal() * derivatives_by_start(here.car, log, here.actuators[window.log], window, noise, r);
    Eliminated e = eliminate(by_start, root.asDiagonal() * by_theta, root.cwiseProduct(r));
    now.informations.emplace_back(e.by_theta.transpose() * e.by_theta);
    now.slopes.emplace_back(e.by_theta.transpose() * e.rest);
    now.information += now.informations.back();
    now.slope += now.slopes.back();
    e.by_theta.resize(0, 0);
    now.windows.push_back(std::move(e));
  }
  return now;
}

/// Covariance of the numbers by the jackknife, which leaves out one window at a time (eq. 11).
MatrixXd jackknife(const Linearised& at) {
  const Eigen::Index p = at.slope.size();
  std::vector<VectorXd> moved;
  VectorXd mean = VectorXd::Zero(p);
  for (std::size_t w = 0; w < at.slopes.size(); ++w) {
    moved.emplace_back((at.information - at.informations[w]).ldlt().solve(at.slopes[w]));
    mean += moved.back();
  }
  const double windows = static_cast<double>(moved.size());
  mean /= windows;
  MatrixXd covariance = MatrixXd::Zero(p, p);
  for (const VectorXd& each : moved) covariance += (each - mean) * (each - mean).transpose();
  // Student's quantile, approximated, in place of 2: few windows estimate their own variance badly.
  const double quantile = 1.96 + 2.37 / std::max(1.0, windows - 1.0);
  return 0.25 * quantile * quantile * (windows - 1.0) / windows * covariance;
}

/// Number of samples for each independent one, by the autocorrelation of the residuals: 1 + 2 Σ (1 − l/(L +
/// 1)) ρ_l up to a second apart (eq. 10), at least 1; the largest over position, yaw and speed.
class Correlation {
 public:
  /// Adds the residuals of a window.
  void add(const DriveLog& log, const Window& window, const VectorXd& r) {
    const auto count = static_cast<Eigen::Index>(window.last - window.first);
    const double span = log.samples[window.last - 1].time - log.samples[window.first].time;
    const auto most =
        std::min(kMost, static_cast<Eigen::Index>(static_cast<double>(count) / std::max(span, 0.1)));
    reach_ = std::max(reach_, most);
    for (Eigen::Index kind = 0; kind < kKinds; ++kind) {
      const auto at = [&](Eigen::Index n) { return std::clamp(r[5 * n + kind], -kHuber, kHuber); };
      for (Eigen::Index lag = 0; lag <= most; ++lag)
        for (Eigen::Index n = 0; n + lag < count; ++n) sums_(lag, kind) += at(n) * at(n + lag);
    }
  }
  [[nodiscard]] double factor() const {
    double largest = 1.0;
    for (Eigen::Index kind = 0; kind < kKinds; ++kind) {
      if (!(sums_(0, kind) > 0.0)) continue;
      double factor = 1.0;
      for (Eigen::Index lag = 1; lag <= reach_; ++lag)
        factor += 2.0 * (1.0 - static_cast<double>(lag) / static_cast<double>(reach_ + 1)) *
                  sums_(lag, kind) / sums_(0, kind);
      largest = std::max(largest, factor);
    }
    return largest;
  }

  /// Limit of samples in a second.
 private:
  static constexpr Eigen::Index kMost = 100;
  static constexpr Eigen::Index kKinds = 4;            ///< kinds of residuals: yaw rate follows from yaw
  MatrixXd sums_ = MatrixXd::Zero(kMost + 1, kKinds);  ///< products of residuals by lag and kind
  Eigen::Index reach_ = 0;                             ///< L: samples in a second
};

/// Adds the standard deviations of the residuals by kind, and their correlation.
void add_residuals(const std::vector<DriveLog>& logs, const std::vector<Window>& windows, const Car& car,
                   const Noise& noise, WindowFit& fit) {
  // Standard deviation over median size, of normally distributed residuals.
  constexpr double kPerMedian = 1.4826;
  const std::vector<Actuators> actuators = actuators_of(logs, car);
  std::array<std::vector<double>, 5> sizes;
  VectorXd r;
  Correlation correlated;
  for (const Window& window : windows) {
    residuals(car, logs[window.log], actuators[window.log], window, window.start, noise, r);
    correlated.add(logs[window.log], window, r);
    for (Eigen::Index i = 0; i + 1 < r.size(); ++i)
      sizes[static_cast<std::size_t>(i % 5)].push_back(std::fabs(r[i]) *
                                                       noise[static_cast<std::size_t>(i % 5)]);
  }
  for (std::size_t kind = 0; kind < 5; ++kind) {
    if (sizes[kind].empty()) continue;
    fit.residual[kind] = kPerMedian * median(std::span(sizes[kind]));
  }
  fit.correlation = correlated.factor();
}

/// Adds correlations and standard deviations of the numbers. Correlated samples count as fewer independent
/// ones; the prior keeps its certainty.
void add_deviations(const Linearised& at, const Expectation& prior, WindowFit& fit) {
  const Eigen::Index p = at.slope.size();
  const MatrixXd inverse = at.information.ldlt().solve(MatrixXd::Identity(p, p));
  const VectorXd root = inverse.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const MatrixXd correlation = root.asDiagonal() * inverse * root.asDiagonal();
  for (const auto& row : correlation.rowwise()) fit.correlations.emplace_back(row.begin(), row.end());
  const VectorXd weight = prior.deviation.cwiseAbs2().cwiseInverse();
  const MatrixXd prior_alone = inverse * weight.asDiagonal() * inverse;
  const VectorXd plain = fit.correlation * (inverse - prior_alone).diagonal() + prior_alone.diagonal();
  const VectorXd left_out = (jackknife(at) + prior_alone).diagonal();
  fit.deviation =
      listed(plain.cwiseMax(left_out).cwiseMin(prior.deviation.cwiseAbs2()).cwiseMax(0.0).cwiseSqrt());
}

}  // namespace

std::vector<Actuators> actuators_of(const std::vector<DriveLog>& logs, const Car& car) {
  std::vector<Actuators> all;
  all.reserve(logs.size());
  for (const DriveLog& log : logs) all.emplace_back(log, car);
  return all;
}

WindowFit fit_windows(const std::vector<DriveLog>& logs, std::vector<Window>& windows,
                      const Prior& of_numbers, const std::vector<double>& from, const Noise& noise,
                      double accuracy, const std::function<bool()>& go_on) {
  constexpr int kMostIterations = 40;                         // limit of trial steps; chosen
  constexpr double kFirstDamping = 1e-3, kMostDamping = 1e8;  // Levenberg and Marquardt's λ; chosen
  const Expectation prior(of_numbers);
  VectorXd theta = mapped(from);
  WindowFit fit;
  double lambda = kFirstDamping;
  double now = loss_of_prior(prior, theta);
  {
    const Car car = prior.car(theta);
    const std::vector<Actuators> actuators = actuators_of(logs, car);
    for (Window& window : windows)
      now += improve_start(logs[window.log], window, car, actuators[window.log], noise, kFirstSteps);
  }
  Linearised at = linearise(logs, windows, prior, theta, noise);
  for (; fit.iterations < kMostIterations && go_on(); ++fit.iterations) {
    MatrixXd damped = at.information;
    damped.diagonal() *= 1.0 + lambda;
    const VectorXd step = -damped.ldlt().solve(at.slope);
    std::vector<Window> tried = windows;
    const Car car = prior.car(theta + step);
    const std::vector<Actuators> actuators = actuators_of(logs, car);
    double then = loss_of_prior(prior, theta + step);
    for (std::size_t w = 0; w < windows.size() && then < now; ++w) {
      const Eliminated& e = at.windows[w];
      Window& window = tried[w];
      move_start(logs[window.log], window, car, actuators[window.log], noise,
                 -e.start_matrix.triangularView<Eigen::Upper>().solve(e.start_rest + e.start_theta * step));
      // The eliminated start is linear in theta: one step corrects it.
      then += improve_start(logs[window.log], window, car, actuators[window.log], noise, 1);
    }
    if (!(then < now)) {
      lambda *= 10.0;
      if (lambda > kMostDamping) break;
      continue;
    }
    const bool is_done = step.cwiseQuotient(prior.deviation).cwiseAbs().maxCoeff() < accuracy &&
                         now - then < 1e-2 * accuracy * (1.0 + now);
    theta += step;
    windows = std::move(tried);
    now = then;
    lambda = std::max(0.1 * lambda, 1e-9);
    at = linearise(logs, windows, prior, theta, noise);
    if (is_done) break;
  }
  fit.theta = listed(theta);
  fit.loss = now;
  add_residuals(logs, windows, prior.car(theta), noise, fit);
  add_deviations(at, prior, fit);
  return fit;
}

void fit_start(const std::vector<DriveLog>& logs, Window& window, std::size_t fitted, const Car& car,
               const Actuators& actuators, const Noise& noise) {
  Window seen = window;
  seen.last = fitted;
  improve_start(logs[window.log], seen, car, actuators, noise, kFirstSteps);
  window.start = seen.start;
}

}  // namespace chicane::identify
