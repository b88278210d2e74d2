// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>

#include "chicane/lap_time/limit.hpp"
#include "chicane/lap_time/racing_plan.hpp"
#include "chicane/road/track.hpp"
#include "chicane/run/disk_cache.hpp"
#include "chicane/scenario/scenario.hpp"

/// Cache and stop flag shared by all searches of this process for a plan or a limit. The program sets both
/// before its first thread; libraries start without a cache. A cached result has the bits of a computed one,
/// so that the cache changes times only.
namespace chicane::run {

/// Sets the cache of all later searches; null: none.
void use_plan_cache(std::shared_ptr<const DiskCache> cache);
/// Sets the flag that ends each search, one under way included. `flag` must outlive all searches.
void stop_planning_by(const std::atomic<bool>& flag) noexcept;
[[nodiscard]] bool must_stop_planning() noexcept;

/// Name of a plan: a hash of the road, the car, the options and the build of this program. Empty if the
/// program carries no build id.
[[nodiscard]] std::string name_of_plan(const road::Track& track, const model::VehicleParams& car,
                                       const lap_time::RacingPlanOptions& options);
[[nodiscard]] std::string name_of_limit(const road::Track& track, std::string_view plant,
                                        const sim::PlantDeviation& deviation,
                                        const lap_time::PlantLimitOptions& options,
                                        const sim::DoubleTrackParams& params);

/// lap_time::plan_racing_line(), answered from the cache if the plan is in it.
[[nodiscard]] Result<road::RacingLine> cached_plan(const road::Track& track, const model::VehicleParams& car,
                                                   const lap_time::RacingPlanOptions& options);
/// lap_time::find_plant_limit(), answered from the cache if the limit is in it. A limit that no budget cut
/// short is kept under a name without budget, and answers each search with a sufficient one.
[[nodiscard]] Result<lap_time::PlantLimit> cached_limit(const road::Track& track, std::string_view plant,
                                                        const sim::PlantDeviation& deviation,
                                                        const lap_time::PlantLimitOptions& options,
                                                        const sim::DoubleTrackParams& params);

/// Limit of a scenario's plant on `track`, by cached_limit(). kInvalidArgument also for a model car.
[[nodiscard]] Result<lap_time::PlantLimit> limit_of(const scenario::Scenario& scenario,
                                                    const road::Track& track,
                                                    const lap_time::PlantLimitOptions& options);
/// Limit from the cache alone, without a witness and whatever budget it took; none if it is not cached.
[[nodiscard]] std::optional<lap_time::PlantLimit> known_limit(const scenario::Scenario& scenario,
                                                              const road::Track& track);

/// lap_time::can_be_driven(). A success is cached: the check takes longer than the start of a run.
[[nodiscard]] Result<void> cached_room(const road::Track& track, const model::VehicleParams& car,
                                       double beside, double scale);

/// Bytes of a result: numbers in the machine's own representation.
[[nodiscard]] std::string to_bytes(const road::RacingLine& line);
[[nodiscard]] std::string to_bytes(const lap_time::PlantLimit& limit);
/// Result from its bytes; none if they are no such result.
[[nodiscard]] std::optional<road::RacingLine> line_from_bytes(std::string_view bytes);
[[nodiscard]] std::optional<lap_time::PlantLimit> limit_from_bytes(std::string_view bytes);

}  // namespace chicane::run
