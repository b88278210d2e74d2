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

/// What every search of this process for a plan or a limit shares. Set by the program before its first
/// thread; libraries start without a cache. A cached result has the bits of a computed one, so it changes
/// times only.
namespace chicane::run {

/// Null: none.
void use_plan_cache(std::shared_ptr<const DiskCache> cache);
/// `flag` ends each search, the one under way too; it must outlive them all.
void stop_planning_by(const std::atomic<bool>& flag) noexcept;
[[nodiscard]] bool must_stop_planning() noexcept;

/// Name of a plan: a hash of the road, the car, the options and the build of this program. Empty where the
/// program carries no build id.
[[nodiscard]] std::string name_of_plan(const road::Track& track, const model::VehicleParams& car,
                                       const lap_time::RacingPlanOptions& options);
[[nodiscard]] std::string name_of_limit(const road::Track& track, std::string_view plant,
                                        const sim::PlantDeviation& deviation,
                                        const lap_time::PlantLimitOptions& options,
                                        const sim::DoubleTrackParams& params);

/// lap_time::plan_racing_line(), from the cache where it is known.
[[nodiscard]] Result<road::RacingLine> cached_plan(const road::Track& track, const model::VehicleParams& car,
                                                   const lap_time::RacingPlanOptions& options);
/// lap_time::find_plant_limit(), from the cache where it is known. An answer that no budget ended is kept
/// without regard to the budget it had, and answers every question with enough of it.
[[nodiscard]] Result<lap_time::PlantLimit> cached_limit(const road::Track& track, std::string_view plant,
                                                        const sim::PlantDeviation& deviation,
                                                        const lap_time::PlantLimitOptions& options,
                                                        const sim::DoubleTrackParams& params);

/// The limit of a scenario's plant on `track`: cached_limit(). kInvalidArgument for a model car, too.
[[nodiscard]] Result<lap_time::PlantLimit> limit_of(const scenario::Scenario& scenario,
                                                    const road::Track& track,
                                                    const lap_time::PlantLimitOptions& options);
/// The same from the cache alone, without a witness: whole, whatever it took.
[[nodiscard]] std::optional<lap_time::PlantLimit> known_limit(const scenario::Scenario& scenario,
                                                              const road::Track& track);

/// lap_time::can_be_driven(); that a car gets round is kept, too, as it takes longer to find than to start a
/// run.
[[nodiscard]] Result<void> cached_room(const road::Track& track, const model::VehicleParams& car,
                                       double beside, double scale);

/// Results as bytes: numbers as they are in memory.
[[nodiscard]] std::string to_bytes(const road::RacingLine& line);
[[nodiscard]] std::string to_bytes(const lap_time::PlantLimit& limit);
/// None for bytes that are not such a result.
[[nodiscard]] std::optional<road::RacingLine> line_from_bytes(std::string_view bytes);
[[nodiscard]] std::optional<lap_time::PlantLimit> limit_from_bytes(std::string_view bytes);

}  // namespace chicane::run
