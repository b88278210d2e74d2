// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "chicane/lap_time/limit.hpp"
#include "chicane/lap_time/racing_plan.hpp"
#include "chicane/road/track.hpp"
#include "chicane/scenario/scenario.hpp"

/// Cache and stop flag shared by all searches of this process for a plan or a limit. The program sets both
/// before its first thread; libraries start without a cache. A cached result has the bits of a computed one,
/// so that the cache changes times only.
namespace chicane::run {

/// Cache of expensive results in files of one folder, each under a name made of all its inputs
/// (docs/decisions/0033-plans-are-cached-on-disk.md). A failure of the disk costs time, never a run.
///
/// Several processes and threads may use one folder: a file is written beside its place and renamed, so that
/// it is there whole or not at all. A file whose length or checksum is wrong is ignored, with one line.
class DiskCache {
 public:
  static constexpr std::uint64_t kMostBytes = 64U << 20U;
  static constexpr std::size_t kMostFiles = 1000;

  /// `say`: lines for the user; may be empty. Creates the folder when the first result is kept.
  explicit DiskCache(std::string folder, std::function<void(std::string_view)> say = {},
                     std::uint64_t most_bytes = kMostBytes)
      : folder_{std::move(folder)}, say_{std::move(say)}, most_bytes_{most_bytes} {}

  /// $XDG_CACHE_HOME/chicane, else ~/.cache/chicane; empty where neither is an absolute path.
  [[nodiscard]] static std::string default_folder();

  /// The result of that name (hexadecimal digits); none: not there, or damaged.
  [[nodiscard]] std::optional<std::string> find(std::string_view name) const;
  /// Writes it, then removes the files unused for longest until no more than `most_bytes` and
  /// kMostFiles are left.
  void keep(std::string_view name, std::string_view bytes) const;
  /// One line on a result whose file is whole, but whose content makes no sense.
  void report_damage(std::string_view name) const;

  [[nodiscard]] const std::string& folder() const noexcept { return folder_; }

 private:
  [[nodiscard]] std::string path_of(std::string_view name) const;
  void make_room() const;

  std::string folder_;
  std::function<void(std::string_view)> say_;
  std::uint64_t most_bytes_;
};

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
