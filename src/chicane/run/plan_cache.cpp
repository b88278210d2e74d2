// SPDX-License-Identifier: MIT
// Cache of plans and limits: names by hash, results as bytes, searches that fill the cache, and its files
// with checksums and removal of the oldest.
#include "chicane/run/plan_cache.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <mutex>
#include <utility>
#include <vector>

#include "chicane/base/file.hpp"
#include "chicane/base/random.hpp"
#include "chicane/model/vehicle.hpp"
#include "chicane/protocol/car_messages.hpp"
#include "chicane/protocol/data_folders.hpp"
#include "chicane/sim/double_track.hpp"

namespace chicane::run {
namespace {

std::mutex mutex_of_cache;
std::shared_ptr<const DiskCache> the_cache;
std::atomic<const std::atomic<bool>*> stop_flag{nullptr};

std::shared_ptr<const DiskCache> cache_in_use() {
  const std::lock_guard lock(mutex_of_cache);
  return the_cache;
}

/// Name of a result in the cache: 128 bits as hexadecimal digits, by two hashes with different starts over
/// all inputs of the result. Empty in a build without an id, because another build may compute another
/// result.
class Name {
 public:
  explicit Name(std::string_view kind) {
    second_.add(
        std::uint64_t{0x9e3779b97f4a7c15ULL});  // arbitrary, so that the hashes differ: 2^64 / golden ratio
    add(kind);
    const std::string ids = protocol::build_ids();
    add(std::string_view(ids));
    has_build_ = !ids.empty();
  }
  void add(double value) {
    first_.add(value);
    second_.add(value);
  }
  void add(std::initializer_list<double> values) {
    for (const double value : values) add(value);
  }
  void add(std::string_view text) {
    add(static_cast<double>(text.size()));
    for (const char each : text) add(static_cast<double>(each));
  }
  void add(const OptionValue& value) {
    if (const auto* number = std::get_if<double>(&value)) add(*number);
    if (const auto* truth = std::get_if<bool>(&value)) add(*truth ? 1.0 : 0.0);
    if (const auto* text = std::get_if<std::string>(&value)) add(std::string_view(*text));
  }
  void add(std::span<const Option> options, const void* owner) {
    for (const Option& option : options) add(option.read(owner));
  }
  /// Adds a road: its smoothed line and widths, on which a search depends, follow from these points alone.
  void add(const road::Track& track) {
    constexpr double kSpacing = 1.0;  // [m] of the points of the line that enter the name; chosen
    add(std::string_view(track.name()));
    add(track.centre().is_closed() ? 1.0 : 0.0);
    add({track.length(), track.kerb_width(), track.start_s(), track.start_d(), track.lap_length(),
         static_cast<double>(track.crossings())});
    for (const road::TrackPoint& p : track.raw_points())
      add({p.position.x(), p.position.y(), p.left, p.right});
    const auto count = static_cast<int>(std::ceil(track.length() / kSpacing));
    for (int i = 0; i <= count; ++i) {
      const double s = track.length() * i / count;
      const road::PathPoint at = track.centre().at(s);
      add({at.position.x(), at.position.y(), at.heading, at.curvature, track.left_width(s),
           track.right_width(s)});
    }
  }
  [[nodiscard]] std::string text() const {
    if (!has_build_) return {};
    constexpr std::string_view kDigits = "0123456789abcdef";
    std::string digits;
    for (const std::uint64_t part : {first_.value(), second_.value()})
      for (int shift = 60; shift >= 0; shift -= 4) digits += kDigits[(part >> shift) & 0xfU];
    return digits;
  }

 private:
  Fnv first_, second_;
  bool has_build_ = false;
};

/// Fields of a point of a line, in their order in the cache.
constexpr std::array kFields{&road::RacingLinePoint::s,
                             &road::RacingLinePoint::time,
                             &road::RacingLinePoint::offset,
                             &road::RacingLinePoint::heading,
                             &road::RacingLinePoint::vx,
                             &road::RacingLinePoint::vy,
                             &road::RacingLinePoint::yaw_rate,
                             &road::RacingLinePoint::steer,
                             &road::RacingLinePoint::steer_command,
                             &road::RacingLinePoint::acceleration,
                             &road::RacingLinePoint::throttle};
static_assert(sizeof(road::RacingLinePoint) == kFields.size() * sizeof(double), "a field is missing here");

constexpr std::size_t kMostPoints = 1'000'000;  // limit of a line's points in the cache; chosen

/// Reads or writes a line, field by field.
void fields(auto& archive, auto& line) requires requires { line.points; }
{
  archive(line.car, line.track, line.length, line.margin, line.is_best_so_far);
  archive.list(line.points, sizeof(road::RacingLinePoint), kMostPoints, [&](auto& point) {
    for (const auto field : kFields) archive(point.*field);
  });
}

/// Reads or writes a limit, field by field.
void fields(auto& archive, auto& limit) requires requires { limit.witness; }
{
  archive(limit.bound.lap);
  for (auto& sector : limit.bound.sectors) archive(sector);
  fields(archive, limit.line);
  archive(limit.nodes, limit.effort.iterations, limit.effort.work, limit.of_optimum.iterations,
          limit.of_optimum.work, limit.stationarity, limit.violation, limit.is_cut_short);
  archive.optional(limit.witness, [&](auto& witness) {
    archive(witness.lap_time, witness.worst, witness.laps, witness.least_edge);
    fields(archive, witness.line);
  });
}

const road::RacingLine& line_of(const road::RacingLine& line) { return line; }
const road::RacingLine& line_of(const lap_time::PlantLimit& limit) { return limit.line; }

/// Result of that name in the cache; none if it is missing or damaged.
template <class T>
std::optional<T> kept(const DiskCache* cache, const std::string& name) {
  if (cache == nullptr || name.empty()) return {};
  const std::optional<std::string> bytes = cache->find(name);
  if (!bytes) return {};
  std::optional<T> known = from_bytes<T>(*bytes);
  if (!known) cache->report_damage(name);
  return known;
}

/// Cached limit whose search was not cut short. Looks under two names, because a limit with a witness answers
/// a request without one, too.
std::optional<lap_time::PlantLimit> whole_limit(const road::Track& track, std::string_view plant,
                                                const sim::PlantDeviation& deviation,
                                                lap_time::PlantLimitOptions options,
                                                const sim::DoubleTrackParams& params) {
  const std::shared_ptr<const DiskCache> cache = cache_in_use();
  if (!cache) return {};
  options.budget = lap_time::PlantLimitOptions{}.budget;
  const bool wants_witness = std::exchange(options.wants_witness, true);
  const auto find = [&] {
    return kept<lap_time::PlantLimit>(cache.get(), name_of_limit(track, plant, deviation, options, params));
  };
  std::optional<lap_time::PlantLimit> known = find();
  if (wants_witness) return known;
  if (known) {
    known->witness.reset();
    known->effort = known->of_optimum;
    return known;
  }
  options.wants_witness = false;
  return find();
}

}  // namespace

void use_plan_cache(std::shared_ptr<const DiskCache> cache) {
  const std::lock_guard lock(mutex_of_cache);
  the_cache = std::move(cache);
}

void stop_planning_by(const std::atomic<bool>& flag) noexcept { stop_flag = &flag; }

bool must_stop_planning() noexcept {
  const std::atomic<bool>* flag = stop_flag.load();
  return flag != nullptr && flag->load();
}

std::string name_of_plan(const road::Track& track, const model::VehicleParams& car,
                         const lap_time::RacingPlanOptions& options) {
  Name name("plan");
  name.add(track);
  name.add(model::vehicle_options(), &car);
  name.add(std::string_view(car.name));
  name.add(car.scale);
  name.add({options.margin, options.grip_share, options.slip_share, options.brake_share, options.speed_limit,
            options.time_step, options.budget, options.slides ? options.delay : 0.0});
  return name.text();
}

std::string name_of_limit(const road::Track& track, std::string_view plant,
                          const sim::PlantDeviation& deviation, const lap_time::PlantLimitOptions& options,
                          const sim::DoubleTrackParams& params) {
  Name name("limit");
  name.add(track);
  name.add(plant);
  name.add(sim::double_track_options(), &params);
  name.add({deviation.friction_scale, deviation.mass_scale, options.time_step,
            options.wants_witness ? 1.0 : 0.0, static_cast<double>(options.laps), options.budget});
  return name.text();
}

Result<road::RacingLine> cached_plan(const road::Track& track, const model::VehicleParams& car,
                                     const lap_time::RacingPlanOptions& options) {
  const std::string name = name_of_plan(track, car, options);
  const std::shared_ptr<const DiskCache> cache = name.empty() ? nullptr : cache_in_use();
  if (std::optional<road::RacingLine> known = kept<road::RacingLine>(cache.get(), name))
    return std::move(*known);
  Result<road::RacingLine> found = lap_time::plan_racing_line(track, car, options);
  if (cache && found) cache->keep(name, to_bytes(*found));
  return found;
}

Result<lap_time::PlantLimit> cached_limit(const road::Track& track, std::string_view plant,
                                          const sim::PlantDeviation& deviation,
                                          const lap_time::PlantLimitOptions& options,
                                          const sim::DoubleTrackParams& params) {
  if (std::optional<lap_time::PlantLimit> known = whole_limit(track, plant, deviation, options, params);
      known && known->effort.work <= options.budget)
    return std::move(*known);
  const std::shared_ptr<const DiskCache> cache = cache_in_use();
  const std::string name = cache ? name_of_limit(track, plant, deviation, options, params) : "";
  if (auto known = kept<lap_time::PlantLimit>(cache.get(), name)) return std::move(*known);
  Result<lap_time::PlantLimit> found = lap_time::find_plant_limit(track, plant, deviation, options, params);
  if (name.empty() || !found) return found;
  lap_time::PlantLimitOptions unlimited = options;
  unlimited.budget = lap_time::PlantLimitOptions{}.budget;
  cache->keep(!found->is_cut_short ? name_of_limit(track, plant, deviation, unlimited, params) : name,
              to_bytes(*found));
  return found;
}

Result<lap_time::PlantLimit> limit_of(const scenario::Scenario& scenario, const road::Track& track,
                                      const lap_time::PlantLimitOptions& options) {
  if (scenario.vehicle.scale != 1.0)
    return fail(ErrorCode::kInvalidArgument,
                fmt::format("limit: got the model car {}, expected one in full size", scenario.car));
  return cached_limit(track, scenario.plant, scenario.plant_options, options, scenario.plant_params);
}

std::optional<lap_time::PlantLimit> known_limit(const scenario::Scenario& scenario,
                                                const road::Track& track) {
  if (scenario.vehicle.scale != 1.0 || !track.centre().is_closed()) return {};
  return whole_limit(track, scenario.plant, scenario.plant_options, {.wants_witness = false},
                     scenario.plant_params);
}

Result<void> cached_room(const road::Track& track, const model::VehicleParams& car, double beside,
                         double scale) {
  constexpr std::string_view kFits = "fits";
  const std::shared_ptr<const DiskCache> cache = cache_in_use();
  if (!cache) return lap_time::can_be_driven(track, car, beside, scale);
  Name name("room");
  name.add(track);
  name.add(model::vehicle_options(), &car);
  name.add(beside);
  name.add(scale);
  const std::string text = name.text();
  if (!text.empty() && cache->find(text) == kFits) return {};
  Result<void> fits = lap_time::can_be_driven(track, car, beside, scale);
  if (fits && !text.empty()) cache->keep(text, kFits);
  return fits;
}

template <class T>
std::string to_bytes(const T& result) {
  protocol::WritingArchive archive;
  fields(archive, result);
  return archive.bytes();
}
template std::string to_bytes(const road::RacingLine&);
template std::string to_bytes(const lap_time::PlantLimit&);

template <class T>
std::optional<T> from_bytes(std::string_view bytes) {
  protocol::ReadingArchive archive(bytes);
  T result;
  fields(archive, result);
  if (!archive.is_at_end() || line_of(result).is_empty()) return {};
  return result;
}
template std::optional<road::RacingLine> from_bytes(std::string_view);
template std::optional<lap_time::PlantLimit> from_bytes(std::string_view);

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kMagic = "chicane cache 1\n";  // first bytes of a file; 1: version of the layout
constexpr std::string_view kExtension = ".cache";
constexpr std::string_view kUnfinished = ".part";  // suffix by base/file.hpp of a file that is being written
constexpr std::size_t kHeader = kMagic.size() + 2 * sizeof(std::uint64_t);  // magic, length, checksum [byte]
constexpr auto kAbandoned = std::chrono::hours(1);  // age from which an unfinished file is removed; chosen

std::uint64_t checksum(std::string_view bytes) {
  Fnv hash;
  for (std::size_t at = 0; at < bytes.size(); at += sizeof(std::uint64_t)) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data() + at, std::min(sizeof word, bytes.size() - at));
    hash.add(word);
  }
  return hash.value();
}

void append(std::string& to, std::uint64_t value) {
  const auto bytes = std::bit_cast<std::array<char, sizeof value>>(value);
  to.append(bytes.data(), bytes.size());
}

std::uint64_t number_at(std::string_view bytes, std::size_t at) {
  std::uint64_t value = 0;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

/// Whether length and checksum in a file's header fit its content.
bool is_whole(std::string_view file) {
  return file.size() >= kHeader && file.starts_with(kMagic) &&
         number_at(file, kMagic.size()) == file.size() - kHeader &&
         number_at(file, kMagic.size() + sizeof(std::uint64_t)) == checksum(file.substr(kHeader));
}

}  // namespace

std::string DiskCache::default_folder() {
  // An empty or relative path counts as unset, by the XDG base directory specification.
  if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache != nullptr && *cache == '/')
    return std::string(cache) + "/chicane";
  if (const char* home = std::getenv("HOME"); home != nullptr && *home == '/')
    return std::string(home) + "/.cache/chicane";
  return {};
}

std::string DiskCache::path_of(std::string_view name) const {
  return folder_ + "/" + std::string(name) + std::string(kExtension);
}

std::optional<std::string> DiskCache::find(std::string_view name) const {
  const std::string path = path_of(name);
  std::ifstream stream(path, std::ios::binary);
  if (!stream) return {};
  std::string file{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (!is_whole(file)) {
    report_damage(name);
    return {};
  }
  ::utimensat(AT_FDCWD, path.c_str(), nullptr, 0);  // marks the file as used now
  file.erase(0, kHeader);
  return file;
}

void DiskCache::report_damage(std::string_view name) const {
  if (say_) say_("cache: " + path_of(name) + " is damaged and ignored");
}

void DiskCache::keep(std::string_view name, std::string_view bytes) const {
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error) return;
  std::string file(kMagic);
  append(file, bytes.size());
  append(file, checksum(bytes));
  file += bytes;
  if (write_file(path_of(name), file, 0600)) make_room();
}

void DiskCache::make_room() const {
  struct File {
    fs::path path;
    fs::file_time_type used;
    std::uint64_t size;
  };
  std::vector<File> files;
  std::uint64_t all = 0;
  std::error_code error;
  // Other processes may remove files meanwhile: skip missing ones.
  for (fs::directory_iterator at(folder_, error), end; !error && at != end; at.increment(error)) {
    std::error_code gone;
    const fs::path& path = at->path();
    const fs::file_time_type used = fs::last_write_time(path, gone);
    const std::uint64_t size = gone ? 0 : fs::file_size(path, gone);
    if (gone) continue;
    if (path.extension() == kUnfinished && fs::file_time_type::clock::now() - used > kAbandoned)
      fs::remove(path, gone);
    if (path.extension() != kExtension) continue;
    files.push_back({path, used, size});
    all += size;
  }
  std::sort(files.begin(), files.end(), [](const File& a, const File& b) { return a.used < b.used; });
  std::size_t left = files.size();
  for (const File& file : files) {
    if (all <= most_bytes_ && left <= kMostFiles) return;
    std::error_code gone;
    fs::remove(file.path, gone);
    all -= file.size;
    --left;
  }
}

}  // namespace chicane::run
