// SPDX-License-Identifier: MIT
// Identification: the model of a car from logs of driving it, with intervals and prediction errors
// (docs/identification.md).
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/identify/drive_log.hpp"
#include "chicane/model/vehicle.hpp"

namespace chicane::identify {

/// Forward slips at which anti-lock or traction control begins to reduce the torque, and has reduced it to 0.
/// Infinite without such a control.
struct SlipLimit {
  double start = 0.1, end = 0.18;
};

/// Effects of the wheels that a log near the limit shows, and that the models of the controllers lack. The
/// defaults are those of ordinary road cars; chosen.
struct Wheels {
  double relaxation = 0.3;  ///< distance over which a tyre builds up its lateral force [m]
  double load_lag = 0.06;   ///< time constant of the load transfer [s]
  double rotating = 1.05;   ///< mass with the inertia of rotating parts, over mass
  SlipLimit brakes{};       ///< slip limits of anti-lock
  SlipLimit drive{};        ///< slip limits of traction control
};

/// Estimate of one number of the car, in the unit of its key.
struct Estimate {
  /// Key in a car file: "steer_lag_ms"; "wheelbase_m", "steer_offset_deg" and "reference_m" are in no car
  /// file.
  std::string key;
  std::string unit;  ///< "ms"
  double value = 0.0;
  double low = 0.0, high = 0.0;  ///< 95 % interval
  double assumed = 0.0;          ///< value before the log
  bool is_excited = true;        ///< the log reduces the deviation to less than 0.4 of the prior's
};

/// Errors of predictions that start from half a second of samples, root mean square.
struct PredictionError {
  double ahead = 0.0;                          ///< time ahead of the last known sample [s]
  double position = 0.0;                       ///< [m]
  double yaw = 0.0;                            ///< [rad]
  double speed = 0.0;                          ///< [m/s]
  double kept_position = 0.0, kept_yaw = 0.0;  ///< errors of a car that keeps speed and yaw rate [m], [rad]
};

/// Measured and predicted motion at a moment, in W [m], [rad], [m/s].
struct Compared {
  double time = 0.0;  ///< time in the log [s]
  double x = 0.0, y = 0.0, psi = 0.0, speed = 0.0;
  double model_x = 0.0, model_y = 0.0, model_psi = 0.0, model_speed = 0.0;
};

/// Stretch of the held-out end of a log: the model has samples up to `known`, and the commands alone after
/// that.
struct PredictedStretch {
  double known = 0.0;  ///< time in the log [s]
  std::vector<Compared> samples;
};

/// Histogram of the samples by the slip of an axle over the slip of its peak force.
struct SlipCover {
  static constexpr double kBin = 0.05;  ///< width of a bin; chosen
  std::array<int, 30> front{}, rear{};  ///< count by bin; the last holds all beyond
};

/// Result of identify().
struct Identification {
  model::VehicleParams vehicle;  ///< parameters of `start`, with the estimates
  Wheels wheels;                 ///< estimated effects of the wheels
  double delay = 0.0;            ///< time from command to effect [s]
  std::vector<Estimate> estimates;
  /// Errors on the end of each log, which is not used in the fit; may be empty.
  std::vector<PredictionError> held_out;
  double driven = 0.0;  ///< length of all logs [s]
  /// Slip of the tyres of each axle over the slip of peak force: 99th percentile of the samples.
  double use_front = 0.0, use_rear = 0.0;
  /// Standard deviations of the residuals: position [m], yaw [rad], speed [m/s].
  std::array<double, 3> residual{};
  std::vector<std::vector<double>> correlations;  ///< correlations of the errors of two estimates
  std::vector<PredictedStretch> stretches;        ///< stretches that held_out averages
  std::vector<Compared> fitted;                   ///< fitted samples
  SlipCover slip;
  /// Number of samples for each independent one: 1 if the model explains all but white noise. Intervals are
  /// wider by its root.
  double correlation = 1.0;
  double loss = 0.0;      ///< minimised sum (docs/identification.md, eq. 6)
  bool has_pedal = true;  ///< the logs have a pedal; else drive and brakes are those of `start`
  /// Largest errors of a valid held-out prediction one second ahead [m], [rad]: six residuals of the fit, or
  /// less if a car that keeps speed and yaw rate has less; at least 0.1 m and 1 degree. Chosen. Pre: held_out
  /// is not empty.
  [[nodiscard]] std::array<double, 2> worst_prediction() const noexcept;
  /// Whether the held-out prediction is within worst_prediction(). True if nothing was held out.
  [[nodiscard]] bool predicts() const noexcept;
  /// Whether the tyres were used enough for a lap near the limit: one axle up to kRaceUse, the other one up
  /// to kLeastRaceUse of the slip of peak force.
  [[nodiscard]] bool knows_tires() const noexcept;
  /// Lower end of the friction's interval; 0 if the tyres are not known.
  [[nodiscard]] double least_friction() const noexcept;
  /// Friction that both axles have used.
  [[nodiscard]] double shown_friction() const noexcept;
};
/// Identification::correlation above which the model lacks an effect that the log shows; chosen. The
/// intervals then hold for the model, not for the car.
inline constexpr double kWrongModel = 2.0;
/// Uses of the tyres that a lap near the limit needs (Identification::knows_tires()); chosen.
inline constexpr double kRaceUse = 0.6, kLeastRaceUse = 0.4;

/// Wheelbase of a car without slip that turns as the car of the logs in gentle bends [m]: accurate enough to
/// recognise the car. NaN for logs with few bends.
[[nodiscard]] double turning_wheelbase(const std::vector<DriveLog>& logs);

/// Options of identify().
struct IdentifyOptions {
  double hold_out = 0.3;  ///< share of each log, at its end, kept for the prediction errors, in [0, 0.8]
  bool is_rough = false;  ///< uses few stretches and steps: enough to compare cars by their loss
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
