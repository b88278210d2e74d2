// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/identify/drive_log.hpp"
#include "chicane/model/vehicle.hpp"

namespace chicane::identify {

/// Forward slips at which a controller of the wheels begins to take torque away, and has taken all of it.
/// Infinite without such a controller.
struct SlipLimit {
  double start = 0.1, end = 0.18;
};

/// Effects of the wheels that no controller's model has, and that a log near the limit shows.
struct Wheels {
  double relaxation = 0.3;  ///< distance over which a tyre builds up its lateral force [m]
  double load_lag = 0.06;   ///< time constant of the load transfer [s]
  double rotating = 1.05;   ///< mass with the inertia of rotating parts, over mass
  SlipLimit brakes{};       ///< slip limits of anti-lock
  SlipLimit drive{};        ///< slip limits of traction control
};

// A car's model from logs of driving it (docs/identification.md).

/// One number of the car, in the unit that people see.
struct Estimate {
  std::string key;   ///< key in a car file: "steer_lag_ms"; "wheelbase_m", "steer_offset_deg" and
                     ///< "reference_m" are in none
  std::string unit;  ///< "ms"
  double value = 0.0;
  double low = 0.0, high = 0.0;  ///< 95 % interval
  double assumed = 0.0;          ///< value before the log
  bool is_excited = true;        ///< the log narrows the prior to less than two fifths
};

/// Prediction errors from half a second of samples on.
struct PredictionError {
  double ahead = 0.0;                          ///< [s]
  double position = 0.0;                       ///< root mean square [m]
  double yaw = 0.0;                            ///< [rad]
  double speed = 0.0;                          ///< [m/s]
  double kept_position = 0.0, kept_yaw = 0.0;  ///< errors of a car that keeps speed and yaw rate [m], [rad]
};

/// Measurement at a moment, and the model's prediction.
struct Compared {
  double time = 0.0;  ///< time in the log [s]
  double x = 0.0, y = 0.0, psi = 0.0, speed = 0.0;
  double model_x = 0.0, model_y = 0.0, model_psi = 0.0, model_speed = 0.0;
};

/// Stretch of a log's held-out end: the model gets samples up to `known`, and continues by the commands
/// alone.
struct PredictedStretch {
  double known = 0.0;  ///< [s]
  std::vector<Compared> samples;
};

/// Count of samples by an axle's slip over the slip of its peak force.
struct SlipCover {
  static constexpr double kBin = 0.05;  ///< width of a bin
  std::array<int, 30> front{}, rear{};  ///< count by bin; the last holds all beyond
};

struct Identification {
  model::VehicleParams vehicle;  ///< start's parameters with the estimated ones
  Wheels wheels;                 ///< wheels that no controller's model has
  double delay = 0.0;            ///< time from command to effect [s]
  std::vector<Estimate> estimates;
  std::vector<PredictionError>
      held_out;         ///< errors on the end of each log, not used in the fit; may be empty
  double driven = 0.0;  ///< length of all logs [s]
  /// Slip of each axle's tyres over the slip of peak force: 99th percentile of the samples.
  double use_front = 0.0, use_rear = 0.0;
  /// Standard deviations of the residuals: position [m], yaw [rad], speed [m/s].
  std::array<double, 3> residual{};
  std::vector<std::vector<double>> correlations;  ///< error correlations of two estimates, in their order
  std::vector<PredictedStretch> stretches;        ///< stretches that held_out averages
  std::vector<Compared> fitted;                   ///< samples that were fitted, each window from its start
  SlipCover slip;
  /// Samples for each independent one: 1 if the model explains all but noise. Intervals count it.
  double correlation = 1.0;
  double loss = 0.0;      ///< minimised sum (docs/identification.md, eq. 6)
  bool has_pedal = true;  ///< the log has a pedal; else drive and brakes are taken from `start`
  /// Largest errors of a held-out prediction one second ahead that is taken for one [m], [rad]: six residuals
  /// of the fit, and those of a car that keeps speed and yaw rate; at least 0.1 m and 1 degree.
  [[nodiscard]] std::array<double, 2> worst_prediction() const noexcept;
  /// Whether the held-out prediction is within them. True if nothing was held out.
  [[nodiscard]] bool predicts() const noexcept;
  /// Whether the tyres were used enough for a lap near the limit: kRaceUse of the peak's slip at the axle
  /// that limits the car, kLeastRaceUse at the other one.
  [[nodiscard]] bool knows_tires() const noexcept;
  /// Lower end of the friction's interval; 0 if the tyres are not known.
  [[nodiscard]] double least_friction() const noexcept;
  /// The friction that both axles have used.
  [[nodiscard]] double shown_friction() const noexcept;
};
/// Ratio above which the model lacks something that the log shows: intervals hold for the model, not for the
/// car.
inline constexpr double kWrongModel = 2.0;
inline constexpr double kRaceUse = 0.6, kLeastRaceUse = 0.4;

/// Wheelbase of a car without slip that would turn as the logs do, by their gentler bends [m]: enough to
/// recognise the car. NaN almost without bends.
[[nodiscard]] double turning_wheelbase(const std::vector<DriveLog>& logs);

struct IdentifyOptions {
  double hold_out = 0.3;  ///< share of each log, at its end, kept for the prediction errors, in [0, 0.8]
  bool is_rough = false;  ///< few stretches and steps: enough to compare starting cars by their loss
  Wheels wheels{};        ///< expected wheels of the car `start`
  /// Called with the share done; false ends the search with the best result so far.
  std::function<bool(double)> progress = [](double) { return true; };
};

/// Finds delay, lags, offset, wheelbase, tyres, inertia, drive, brakes and drag of the car that drove `logs`.
/// `start` gives parameters that logs do not determine (mass, track width, tyre shape, limits) and the prior
/// of the rest.
///
/// kInvalidArgument if the logs have less than ten seconds of driving.
[[nodiscard]] Result<Identification> identify(const std::vector<DriveLog>& logs,
                                              const model::VehicleParams& start,
                                              const IdentifyOptions& options = {});

}  // namespace chicane::identify
