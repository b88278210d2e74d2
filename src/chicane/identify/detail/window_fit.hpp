// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "chicane/identify/detail/car_motion.hpp"

namespace chicane::identify {

/// A stretch of a log that is predicted from its start, which is fitted with it.
struct Window {
  std::size_t log = 0;
  std::size_t first = 0, last = 0;  ///< samples first … last - 1
  Start start{};
};

/// Standard deviations of the measurements: x and y [m], psi [rad], speed [m/s], r [rad/s].
using Noise = std::array<double, 5>;

/// Prior of the estimated numbers: mean and standard deviation of each before a log is read. No bounds.
struct Prior {
  std::vector<double> mean, deviation;
  std::function<Car(const std::vector<double>&)> car;  ///< car with these numbers
};

/// Result of fit_windows().
struct WindowFit {
  std::vector<double> theta;  ///< the estimated numbers
  /// Standard deviations of theta: the larger one of two estimates, by size and correlation of the residuals,
  /// and by the windows' disagreement. No larger than the prior's.
  std::vector<double> deviation;
  double correlation = 1.0;                       ///< samples for each independent one
  std::vector<std::vector<double>> correlations;  ///< correlations between entries of theta
  Noise residual{};                               ///< standard deviations of the residuals, by their median
  double loss = 0.0;                              ///< weighted squares of samples and prior
  int iterations = 0;
};

/// Actuators of the car under the commands of each log.
[[nodiscard]] std::vector<Actuators> actuators_of(const std::vector<DriveLog>& logs, const Car& car);

/// Multiple shooting (docs/identification.md, eq. 6–12): the numbers and the starts of all windows
/// that explain the samples best, by Levenberg and Marquardt with the starts eliminated window by window.
/// Huber's loss. Windows keep their fitted starts. Ends where a step is below `accuracy` of the prior's
/// deviations.
[[nodiscard]] WindowFit fit_windows(const std::vector<DriveLog>& logs, std::vector<Window>& windows,
                                    const Prior& prior, const std::vector<double>& theta, const Noise& noise,
                                    double accuracy, const std::function<bool()>& go_on);

/// Fits the start of one window to its samples before `fitted`, with a given car.
void fit_start(const std::vector<DriveLog>& logs, Window& window, std::size_t fitted, const Car& car,
               const Actuators& actuators, const Noise& noise);

}  // namespace chicane::identify
