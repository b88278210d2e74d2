// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <memory>

#include "chicane/base/owned.hpp"
#include "chicane/model/prediction.hpp"
#include "chicane/model/vehicle.hpp"
#include "chicane/road/known_road.hpp"
#include "chicane/safety/guard_options.hpp"
#include "chicane/safety/stop_planner.hpp"
#include "chicane/safety/stop_player.hpp"

namespace chicane::safety {

/// Conditions that a verified stop withstands, weakest first.
enum class Fit : std::uint8_t {
  kNone,  ///< nothing: no stop keeps the margin
  kSeen,  ///< a stop in closed loop, while the car is measured
  kOpen,  ///< also the same stop played by a receiver without measurements
};

/// The predictive safety filter (docs/safety.md, section 2). A command may be sent if a stop exists after it:
/// a policy with its own feedback that brings the car to standstill on the known road, in the model and in
/// two cars that differ from it. One function, verify(), judges every policy; who proposes it does not
/// count. The last verified policy is stored, and driven when a command is refused.
///
/// Deterministic; no allocation after construction; one thread.
class PredictiveFilter {
 public:
  /// [s] by which the next command may come late, before a stop begins. Measured (docs/guard.md, "Late
  /// commands"): the original answers after 160 ms at most, 100 are configured.
  static constexpr double kLateness = 0.06;
  static constexpr double kLongestHold = 0.75;  ///< [s] a command is held, at most; chosen, docs/guard.md
  /// Time for which a command acts until a late next one [s], after `interval` and the `longest` of late.
  [[nodiscard]] static double late_hold(double interval, double longest) noexcept;
  /// Braking of the first law: gentle, and stable without feedback. Chosen.
  static constexpr Braking kGentle{0.8, 1.6, 0.7};
  /// Fixed for a run.
  struct Terms {
    double margin = 0.2;      ///< of the tyres from the edge in a stop [m]
    double least_edge = 0.0;  ///< the same of a slow car that is nearer to the edge already [m]
    double open_time = 30.0;  ///< length of a silence for which stops are verified open loop [s]; 0: none
  };

  PredictiveFilter(const model::VehicleParams& vehicle, const Terms& terms)
      : planner_{vehicle},
        model_{vehicle},
        terms_{terms},
        stop_{std::make_unique<StopPlan>()},
        tried_{std::make_unique<StopPlan>()} {}

  void set_vehicle(const model::VehicleParams& vehicle) noexcept {
    planner_.set_vehicle(vehicle);
    model_.set_vehicle(vehicle);
  }
  /// Forgets the stored policy and what residuals have shown: another road or another run begins.
  void forget() noexcept;
  /// How far a measurement was from its prediction one cycle before, at `time` [s]: eq. 5c.
  void note_residual(const Doubt& residual, double time) noexcept;

  /// A command that shall act from `start` on, held until the next one.
  struct Request {
    const road::KnownRoad& road;
    const StopStart& start;
    model::Command command;
    double interval = 0.0;    ///< between two commands [s]; <= 0: not known
    bool is_led = false;      ///< the guard's own command, at walking pace
    double longest = 0.0;     ///< interval lately [s]
    model::Command acting{};  ///< command that acts before `command` does
  };
  /// Whether the command may be sent: a verified stop exists where it leads, and is stored, or the car stays
  /// near its planned lap, where no law may hold (docs/guard.md, "The condition for sending"). The stored
  /// stop stays when none exists. Writes stop_edge and stop_distance.
  [[nodiscard]] Fit verify(const Request& request, GuardReport& report) noexcept;

  /// Stores the way to standstill from `start` on: the stored policy, or a verified one where the stored one
  /// holds no more. `is_open`: the car is not measured, `start` comes from the model. `is_measured`: nothing
  /// is in doubt but the controller's command; then the car may stay on a planned lap for a while, where a
  /// verified stop follows, and what the policy loses of its edge is added to the margin (eq. 5d). Where no
  /// policy holds, the one that comes least far off the road is stored. False: there is none at all.
  [[nodiscard]] bool drive(const road::KnownRoad& road, const StopStart& start, bool is_open,
                           bool is_measured, GuardReport& report) noexcept;

  /// The stored way to standstill, from the moment at which the next command acts. Size 0: none.
  [[nodiscard]] const StopPlan& stop() const noexcept { return is_current_ ? *stop_ : kNoStop; }
  /// A control cycle begins, `interval` [s] after the one before, `longest` lately: the stored stop is of the
  /// cycle before until verify() or drive() renew it.
  void begin_cycle(double interval, double longest) noexcept;
  /// stop() is not what is sent.
  void withdraw_stop() noexcept { is_current_ = false; }
  [[nodiscard]] const StopPlanner& planner() const noexcept { return planner_; }

 private:
  /// Limits that a verified stop has to keep.
  struct Goal {
    double margin = 0.0;      ///< of the car as modelled [m]
    double open_time = 0.0;   ///< [s]
    bool turns_back = false;  ///< at its end the car can turn back along the road
    bool is_driven = false;   ///< simulated to its end and without doubt: the car is on it already
  };
  struct Candidate {
    StopCheck check{};
    Fit fit = Fit::kNone;
    double worth = -std::numeric_limits<double>::infinity();  ///< orders candidates of one fit [m]
  };
  [[nodiscard]] Candidate judge(const road::KnownRoad& road, const StopStart& from, const Policy& policy,
                                const Goal& goal) noexcept;
  [[nodiscard]] bool consider(const road::KnownRoad& road, const StopStart& from, const Policy& policy,
                              const Goal& goal, Candidate& best, GuardReport& report) noexcept;
  [[nodiscard]] bool holds_as_usual(const Request& request, double longest, GuardReport& report) noexcept;
  [[nodiscard]] Fit verify_held(const Request& request, double held, GuardReport& report) noexcept;
  [[nodiscard]] double margin_for(const Request& request, const StopStart& next,
                                  double edge_now) const noexcept;
  [[nodiscard]] double slip(const StopStart& at) const noexcept;
  [[nodiscard]] bool shift_to(double time) noexcept;

  StopPlanner planner_;
  model::PredictionModel model_;
  Terms terms_;
  Owned<StopPlan> stop_;   ///< the stored policy's course from now on
  Owned<StopPlan> tried_;  ///< the candidate that was simulated last
  Policy stored_;
  bool has_stored_ = false;
  Doubt residual_;                                                ///< root mean squares
  double residual_at_ = 0.0;                                      ///< [s]
  double refused_at_ = -std::numeric_limits<double>::infinity();  ///< the last drive() [s]
  double driven_at_ = -std::numeric_limits<double>::infinity();   ///< a stop, last, with nothing in doubt [s]
  double promised_ = 0.0;                                         ///< edge of the policy that is driven [m]
  double lost_ = 0.0;                                             ///< edge that driven policies have lost [m]
  double interval_ = 0.0;                                         ///< before this cycle [s]
  double usual_ = 0.0;                                            ///< shorter of the last two intervals [s]
  double hold_ = Policy{}.hold;                                   ///< Policy::hold [s]
  int law_ = 0;                                                   ///< law verified last, tried first
  bool is_current_ = false;                                       ///< stop_ is of this cycle
  static const StopPlan kNoStop;
};

}  // namespace chicane::safety
