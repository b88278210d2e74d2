// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "chicane/base/owned.hpp"
#include "chicane/base/vec2.hpp"
#include "chicane/controller/controller.hpp"
#include "chicane/model/prediction.hpp"
#include "chicane/model/vehicle.hpp"
#include "chicane/road/known_road.hpp"
#include "chicane/road/reference_line.hpp"
#include "chicane/safety/guard_report.hpp"
#include "chicane/safety/stop_plan.hpp"
#include "chicane/safety/stop_planner.hpp"
#include "chicane/safety/stop_search.hpp"

namespace chicane::safety {

/// What a backup was verified for, weakest first.
enum class Fit : std::uint8_t {
  kNone,  ///< no backup keeps the margin
  kSeen,  ///< one does while the car is measured (closed loop)
  kOpen,  ///< one does also when the receiver plays it without measurements (open loop)
};

/// The predictive safety filter (docs/safety.md, section 2): a command may be sent if, after it, a backup
/// trajectory to standstill on the known road exists that was verified by simulation; the last verified one
/// is stored and driven when it may not.
///
/// A backup is the controller's published plan for 0 to 3 s, then the stop law. Deterministic; no allocation
/// after construction; one thread; one simulation to standstill for each kind of
/// backup at most. Near a planned lap a call tries two kinds, and the next one others.
class PredictiveFilter {
 public:
  /// Fixed for a run.
  struct Terms {
    double margin = 0.2;      ///< of the tyres from the edge in a backup [m]
    double least_edge = 0.0;  ///< the same of a slow car that is nearer to the edge already [m]
    double open_time = 30.0;  ///< length of a silence for which backups are verified open loop [s]; 0: none
  };

  PredictiveFilter(const model::VehicleParams& vehicle, const Terms& terms)
      : planner_{vehicle},
        search_{vehicle},
        model_{vehicle},
        terms_{terms},
        backup_{std::make_unique<StopCourse>()},
        tried_{std::make_unique<StopCourse>()},
        intended_{std::make_unique<StopCourse>()} {}

  void set_vehicle(const model::VehicleParams& vehicle) noexcept {
    planner_.set_vehicle(vehicle);
    search_.set_vehicle(vehicle);
    model_.set_vehicle(vehicle);
  }
  /// The stored backup's places in the world, along the line that they are expressed by; and back, along
  /// another line of the same road. The backup is forgotten where it is nowhere near that one.
  void leave_line(const road::ReferenceLine& line) noexcept;
  void join_line(const road::ReferenceLine& line) noexcept;
  /// Forgets the stored backup: another road or another run begins.
  void forget() noexcept {
    backup_->stop.size = 0;
    next_kind_ = 0;
    search_.forget();
  }

  /// A command that shall act from `start` on, held until the next one.
  struct Request {
    const road::KnownRoad& road;
    const StopStart& start;
    model::Command command;
    const controller::Plan* intended;  ///< published by the controller for this command; null: none
    double interval = 0.0;             ///< between two commands [s]; <= 0: not known
    bool is_led = false;               ///< the guard's own, at walking pace
  };
  /// Verifies a backup from where `request` leads and stores it. Writes stop_edge and stop_distance. The
  /// stored backup stays when none is verified; it counts as verified where the command leads into its tube.
  [[nodiscard]] Fit verify(const Request& request, GuardReport& report) noexcept;

  /// The command of the backup at `start`, after it was verified from there or brought up to date. `is_open`:
  /// the car is not measured, `start` comes from the model. False: no backup is stored and none was found.
  [[nodiscard]] bool drive(const road::KnownRoad& road, const StopStart& start, bool is_open,
                           GuardReport& report) noexcept;

  /// The backup in store, from the moment at which the next command would act. Size 0: none.
  [[nodiscard]] const StopPlan& stop() const noexcept { return is_current_ ? backup_->stop : kNoStop; }
  /// A control cycle begins: the backup in store is one of the cycle before until it is verified or shifted.
  void begin_cycle() noexcept { is_current_ = false; }
  [[nodiscard]] const StopPlanner& planner() const noexcept { return planner_; }

 private:
  /// What a backup has to keep.
  struct Goal {
    double edge_before = 0.0;   ///< least distance to the edge until it begins [m]
    double margin = 0.0;        ///< [m]
    double open_time = 0.0;     ///< [s]
    bool drives_on = false;     ///< the car can turn back along the road at its end
    bool may_brake_now = true;  ///< the tyres leave room for the stop law's model
    bool is_planned = true;     ///< by a controller that publishes its plan, which stays away from the limit
  };
  /// One simulated candidate.
  struct Candidate {
    StopCheck check;
    Fit fit = Fit::kNone;
    double worth = 0.0;  ///< to choose between candidates that do not fit [m]
  };
  [[nodiscard]] Candidate judge(const road::KnownRoad& road, const StopStart& from, const StopCheck& check,
                                const Goal& goal) const noexcept;
  void store(const Candidate& candidate, GuardReport& report) noexcept;
  [[nodiscard]] Fit stop_by(int kind, const road::KnownRoad& road, const StopStart& from, const Goal& goal,
                            Fit best, GuardReport& report) noexcept;
  [[nodiscard]] static bool may_be(int kind, const Goal& goal) noexcept;
  [[nodiscard]] Fit stop_in_turn(int count, const road::KnownRoad& road, const StopStart& from,
                                 const Goal& goal, GuardReport& report) noexcept;
  [[nodiscard]] Fit best_stop(const road::KnownRoad& road, const StopStart& from, const Goal& goal,
                              GuardReport& report) noexcept;
  [[nodiscard]] Fit stop_searched(const road::KnownRoad& road, const StopStart& from, const Goal& goal,
                                  GuardReport& report) noexcept;
  void read_plan(const Request& request, double longest) noexcept;
  [[nodiscard]] bool intends(const Request& request) noexcept;
  [[nodiscard]] bool is_in_tube(const road::KnownRoad& road, const StopStart& at) const noexcept;
  [[nodiscard]] bool drives_planned_lap(const road::KnownRoad& road, const StopStart& at,
                                        double wide) const noexcept;
  [[nodiscard]] bool returns_to_lap(const road::KnownRoad& road, const StopStart& at) const noexcept;
  [[nodiscard]] Fit go_on_along_lap(const road::KnownRoad& road, const StopStart& at) noexcept;
  [[nodiscard]] Fit go_back_to_lap(const road::KnownRoad& road, const StopStart& at) noexcept;
  [[nodiscard]] bool shift_to(double time) noexcept;
  void shift_to_place(const road::KnownRoad& road, const StopStart& at) noexcept;

  StopPlanner planner_;
  StopSearch search_;  ///< where the law does not find a stop
  model::PredictionModel model_;
  Terms terms_;
  Owned<StopCourse> backup_;    ///< in store
  Owned<StopCourse> tried_;     ///< the candidate being simulated, then the spare
  Owned<StopCourse> intended_;  ///< the controller's plan along the line
  struct Pose {
    Vec2 position;
    double heading = 0.0;  ///< [rad]
  };
  std::array<Pose, StopPlan::kCapacity> poses_{};  ///< of the backup's places, between two lines
  Fit backup_fit_ = Fit::kNone;
  int next_kind_ = 0;        ///< of backup that is tried first: the one that held last, stop_by()
  bool is_current_ = false;  ///< the backup was stored or shifted in this cycle
  static const StopPlan kNoStop;
};

}  // namespace chicane::safety
