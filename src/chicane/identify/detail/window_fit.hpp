// SPDX-License-Identifier: MIT
// Fit of the numbers of a car to windows of logs: nonlinear least squares with Huber's loss and a prior
// (docs/identification.md, eq. 6 to 12).
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "chicane/identify/detail/car_motion.hpp"

namespace chicane::identify {

/// Stretch of a log that is predicted from its start; the start is fitted, too.
struct Window {
  std::size_t log = 0;              ///< index of the log
  std::size_t first = 0, last = 0;  ///< samples first … last - 1
  Start start{};                    ///< state at sample `first`
};

/// Standard deviations of the measurements: x and y [m], psi [rad], speed [m/s], r [rad/s].
using Noise = std::array<double, 5>;

/// Prior of the estimated numbers, normally distributed: known before any log. No bounds.
struct Prior {
  std::vector<double> mean, deviation;
  std::function<Car(const std::vector<double>&)> car;  ///< car with given numbers
};

/// Result of fit_windows().
struct WindowFit {
  std::vector<double> theta;  ///< estimated numbers
  /// Standard deviations of theta: the larger of two estimates, by size and correlation of the residuals, and
  /// by the differences between windows. At most the prior's.
  std::vector<double> deviation;
  double correlation = 1.0;                       ///< number of samples for each independent one
  std::vector<std::vector<double>> correlations;  ///< correlations between entries of theta
  Noise residual{};    ///< standard deviations of the residuals, from their medians
  double loss = 0.0;   ///< minimised loss of samples and prior
  int iterations = 0;  ///< number of trial steps
};

/// Actuators of the car under the commands of each log.
[[nodiscard]] std::vector<Actuators> actuators_of(const std::vector<DriveLog>& logs, const Car& car);

/// Fits the numbers, and the starts of all windows, by multiple shooting (docs/identification.md, eq. 6–12):
/// steps of Levenberg and Marquardt with the starts eliminated window by window. Windows keep their fitted
/// starts. `theta`: first guess; `noise`: weights of the samples. Ends when a step is below `accuracy` in
/// deviations of the prior, or `go_on` is false.
[[nodiscard]] WindowFit fit_windows(const std::vector<DriveLog>& logs, std::vector<Window>& windows,
                                    const Prior& prior, const std::vector<double>& theta, const Noise& noise,
                                    double accuracy, const std::function<bool()>& go_on);

/// Fits the start of one window to its samples before `fitted`, for a given car.
void fit_start(const std::vector<DriveLog>& logs, Window& window, std::size_t fitted, const Car& car,
               const Actuators& actuators, const Noise& noise);

}  // namespace chicane::identify
