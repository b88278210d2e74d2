// SPDX-License-Identifier: MIT
// Cache on disk for results that take seconds: planned laps, physical limits, and checks of a road's room.
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

/// Cache and stop flag of all searches of this process for a plan or a limit. The program sets both before
/// its first thread; without a call there is no cache. A cached result has the bits of a computed one.
namespace chicane::run {

/// Cache of results in files of one folder, each under a name made of all its inputs
/// (docs/decisions/0033-plans-are-cached-on-disk.md). A failure of the disk costs time, never a run.
///
/// Several processes and threads may use one folder: a file is written under another name and renamed when it
/// is whole. A file of wrong length or checksum is ignored, and reported in one line.
class DiskCache {
 public:
  // Chosen: a plan has some 100 kB.
  static constexpr std::uint64_t kMostBytes = 64U << 20U;  ///< limit of the folder [byte]
  static constexpr std::size_t kMostFiles = 1000;          ///< limit of its files

  /// `say` gets lines for the user; may be empty. Creates the folder when the first result is kept.
  explicit DiskCache(std::string folder, std::function<void(std::string_view)> say = {},
                     std::uint64_t most_bytes = kMostBytes)
      : folder_{std::move(folder)}, say_{std::move(say)}, most_bytes_{most_bytes} {}

  /// $XDG_CACHE_HOME/chicane, else ~/.cache/chicane; empty where neither is an absolute path.
  [[nodiscard]] static std::string default_folder();

  /// Result of the name `name` (hexadecimal digits); none if it is missing or damaged.
  [[nodiscard]] std::optional<std::string> find(std::string_view name) const;
  /// Writes a result, then removes the files unused for longest, down to `most_bytes` and kMostFiles.
  void keep(std::string_view name, std::string_view bytes) const;
  /// Reports a result whose file is whole, but whose content cannot be read.
  void report_damage(std::string_view name) const;

  [[nodiscard]] const std::string& folder() const noexcept { return folder_; }

 private:
  [[nodiscard]] std::string path_of(std::string_view name) const;
  /// Removes the files unused for longest, and unfinished ones of killed processes.
  void make_room() const;

  std::string folder_;
  std::function<void(std::string_view)> say_;
  std::uint64_t most_bytes_;
};

/// Sets the cache of all later searches; null: none.
void use_plan_cache(std::shared_ptr<const DiskCache> cache);
/// Sets the flag that ends all searches, running ones included. `flag` must outlive all searches.
void stop_planning_by(const std::atomic<bool>& flag) noexcept;
/// Whether that flag is set.
[[nodiscard]] bool must_stop_planning() noexcept;

/// Name of a plan: a hash of the road, the car, the options and the build of this program. Empty in a program
/// without a build id.
[[nodiscard]] std::string name_of_plan(const road::Track& track, const model::VehicleParams& car,
                                       const lap_time::RacingPlanOptions& options);
/// Name of a limit, by the same rule.
[[nodiscard]] std::string name_of_limit(const road::Track& track, std::string_view plant,
                                        const sim::PlantDeviation& deviation,
                                        const lap_time::PlantLimitOptions& options,
                                        const sim::DoubleTrackParams& params);

/// Plan by lap_time::plan_racing_line(), from the cache if it is there.
[[nodiscard]] Result<road::RacingLine> cached_plan(const road::Track& track, const model::VehicleParams& car,
                                                   const lap_time::RacingPlanOptions& options);
/// Limit by lap_time::find_plant_limit(), from the cache if it is there. A limit that no budget cut short is
/// cached under a name without budget, and found by each search whose budget is sufficient.
[[nodiscard]] Result<lap_time::PlantLimit> cached_limit(const road::Track& track, std::string_view plant,
                                                        const sim::PlantDeviation& deviation,
                                                        const lap_time::PlantLimitOptions& options,
                                                        const sim::DoubleTrackParams& params);

/// Limit of a scenario's plant on `track`, by cached_limit(). kInvalidArgument for a model car, too.
[[nodiscard]] Result<lap_time::PlantLimit> limit_of(const scenario::Scenario& scenario,
                                                    const road::Track& track,
                                                    const lap_time::PlantLimitOptions& options);
/// Limit from the cache alone, without a witness, whatever its search cost; none if it is not cached.
[[nodiscard]] std::optional<lap_time::PlantLimit> known_limit(const scenario::Scenario& scenario,
                                                              const road::Track& track);

/// Check by lap_time::can_be_driven(). Successes are cached: the check takes longer than the start of a run.
[[nodiscard]] Result<void> cached_room(const road::Track& track, const model::VehicleParams& car,
                                       double beside, double scale);

/// Bytes of a road::RacingLine or lap_time::PlantLimit: numbers in the machine's own representation.
template <class T>
[[nodiscard]] std::string to_bytes(const T& result);
/// Result from its bytes; none if they are no such result.
template <class T>
[[nodiscard]] std::optional<T> from_bytes(std::string_view bytes);

}  // namespace chicane::run
