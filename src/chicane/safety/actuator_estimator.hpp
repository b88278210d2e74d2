// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <limits>

#include "chicane/controller/controller.hpp"
#include "chicane/model/state.hpp"
#include "chicane/model/vehicle.hpp"
#include "chicane/safety/actuator_watch.hpp"
#include "chicane/tracking/state_estimator.hpp"

namespace chicane::safety {

/// How late and by how much the wheels answer, beyond the configuration, by which answer predicts the next
/// measurement better (docs/identification.md, eq. 13 to 15). It is the method of
/// tracking::GripEstimator for four unknowns at once: one state estimator counts with the estimate, four have
/// one unknown changed each, and least squares over the last kMemory of driving finds the unknowns with their
/// deviations. The grip is among them, so that tyres that give less do not pass for another steering.
///
/// answer(), which is driven with, follows the estimate in steps: the offset where it is certain enough,
/// delay and gain where all three are, each if it differs by more than a step and three deviations of both.
/// One thread; allocates nothing.
class ActuatorEstimator {
 public:
  // Origins (chosen: by trial, see Guard):
  // - Derived: kMostDelay (three usual deviations). Chosen: kMemory (docs/identification.md),
  //   kEnough.
  static constexpr double kMemory = 10.0;    ///< time constant of forgetting [s]
  static constexpr double kEnough = 5.0;     ///< remembered driving until delay and gain are driven with [s]
  static constexpr double kMostDelay = 0.3;  ///< [s]

  explicit ActuatorEstimator(const model::VehicleParams& vehicle) noexcept;
  /// Nothing is known.
  void reset() noexcept;
  /// Sets another car; what was learned about the answer stays.
  void set_vehicle(const model::VehicleParams& vehicle) noexcept;

  /// A measurement that is not in doubt; `commanded`: the commands sent to the actuators, with the times
  /// at which they act by answer().
  void see(const model::Measurement& now, const tracking::CommandHistory& commanded) noexcept;
  /// Between two cycles: answer() follows the estimate where it differs by enough. True: it changed.
  [[nodiscard]] bool take_up() noexcept;

  /// What is driven with.
  [[nodiscard]] const ActuatorAnswer& answer() const noexcept { return answer_; }
  /// The estimate with its deviations.
  [[nodiscard]] controller::LearnedCar learned() const noexcept;

 private:
  enum Unknown : std::size_t { kDelay, kGain, kOffset, kGrip, kUnknowns };
  using Values = std::array<double, kUnknowns>;
  using Matrix = std::array<Values, kUnknowns>;

  /// Normal equations of one measured quantity, integrals over time.
  struct Sums {
    Matrix hh{};
    Values hn{};
    double nn = 0.0;
    double left = 0.0;     ///< mean square of what the estimate does not explain
    double product = 0.0;  ///< mean product of two such in a row
    double last = 0.0;     ///< the last one

    void add(const Values& h, double n, double unexplained, double kept, double elapsed,
             double share) noexcept;
    /// The unknowns are counted from another place from now on.
    void shift(const Values& by, double kept) noexcept;
    /// Weight of a second: over the variance, and over how many in a row tell the same.
    [[nodiscard]] double weight() const noexcept;
  };
  struct Solution {
    Values value{};  ///< beyond here_
    Values deviation{};
  };

  [[nodiscard]] tracking::CommandHistory effect(const tracking::CommandHistory& commanded,
                                                const Values& values) const noexcept;
  void configure_estimators() noexcept;
  void move_on() noexcept;
  [[nodiscard]] bool is_certain(Unknown i) const noexcept;
  [[nodiscard]] Solution solve() const noexcept;

  model::VehicleParams vehicle_;  ///< as configured, without a name
  ActuatorAnswer answer_;
  Values here_{0.0, 1.0, 0.0, 1.0};                                 ///< that the estimators count with
  std::array<tracking::StateEstimator, kUnknowns + 1> estimators_;  ///< each but the last has one changed
  Sums aside_, heading_;
  Solution solution_;
  Values taken_up_{};      ///< deviations of what is driven with when it was taken up; 0: as configured
  double time_ = 0.0;      ///< of driving, as far as it is remembered [s]
  double interval_ = 0.0;  ///< between measurements, mean [s]
  double counted_ = 0.0;   ///< since here_ changed [s]
  double slid_at_ = -std::numeric_limits<double>::infinity();  ///< tyres were used too far [s]
};

}  // namespace chicane::safety
