// SPDX-License-Identifier: MIT
// Cache of plans and limits: their names by hash, their bytes, and the searches that fill it.
#include "chicane/run/plan_cache.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <mutex>
#include <utility>

#include <fmt/format.h>

#include "chicane/base/random.hpp"
#include "chicane/model/vehicle.hpp"
#include "chicane/protocol/data_folders.hpp"
#include "chicane/sim/double_track.hpp"

namespace chicane::run {
namespace {

static_assert(std::endian::native == std::endian::little, "the cache's files would need another name");

std::mutex mutex_of_cache;
std::shared_ptr<const DiskCache> the_cache;
std::atomic<const std::atomic<bool>*> stop_flag{nullptr};

std::shared_ptr<const DiskCache> cache_in_use() {
  const std::lock_guard lock(mutex_of_cache);
  return the_cache;
}

/// Two hashes of 64 bits with different beginnings.
class Name {
 public:
  explicit Name(std::string_view kind) {
    second_.add(std::uint64_t{0x9e3779b97f4a7c15ULL});
    add(kind);
    const std::string ids = protocol::build_ids();
    add(std::string_view(ids));
    has_build_ = !ids.empty();
  }
  void add(double value) {
    first_.add(value);
    second_.add(value);
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
    constexpr double kSpacing = 1.0;  // [m]
    add(std::string_view(track.name()));
    add(track.centre().is_closed() ? 1.0 : 0.0);
    for (const double value : {track.length(), track.kerb_width(), track.start_s(), track.start_d(),
                               track.lap_length(), static_cast<double>(track.crossings())})
      add(value);
    for (const road::TrackPoint& p : track.raw_points()) {
      for (const double value : {p.position.x(), p.position.y(), p.left, p.right}) add(value);
    }
    const auto count = static_cast<int>(std::ceil(track.length() / kSpacing));
    for (int i = 0; i <= count; ++i) {
      const double s = track.length() * i / count;
      const road::PathPoint at = track.centre().at(s);
      for (const double value : {at.position.x(), at.position.y(), at.heading, at.curvature,
                                 track.left_width(s), track.right_width(s)})
        add(value);
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

class Writer {
 public:
  void put(double value) {
    const auto bytes = std::bit_cast<std::array<char, sizeof value>>(value);
    bytes_.append(bytes.data(), bytes.size());
  }
  void put(std::string_view text) {
    put(static_cast<double>(text.size()));
    bytes_ += text;
  }
  [[nodiscard]] std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

class Reader {
 public:
  explicit Reader(std::string_view bytes) : rest_{bytes} {}
  void get(double& value) {
    if (rest_.size() < sizeof value) return give_up();
    std::memcpy(&value, rest_.data(), sizeof value);
    rest_.remove_prefix(sizeof value);
  }
  void get(std::string& text) {
    const std::size_t size = count(1);
    text = rest_.substr(0, size);
    rest_.remove_prefix(size);
  }
  void get(int& value) {
    double number = 0.0;
    get(number);
    if (!(std::fabs(number) < 1e9)) return give_up();
    value = static_cast<int>(number);
  }
  void get(bool& value) {
    double number = 0.0;
    get(number);
    value = number != 0.0;
  }
  /// Reads a count of things with at least `size` bytes each; 0 if so many cannot follow.
  [[nodiscard]] std::size_t count(std::size_t size) {
    double number = 0.0;
    get(number);
    if (number >= 0.0 && number * static_cast<double>(size) <= static_cast<double>(rest_.size()))
      return static_cast<std::size_t>(number);
    give_up();
    return 0;
  }
  [[nodiscard]] bool is_at_end() const { return is_good_ && rest_.empty(); }

 private:
  void give_up() {
    is_good_ = false;
    rest_ = {};
  }
  std::string_view rest_;
  bool is_good_ = true;
};

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

void put(Writer& to, const road::RacingLine& line) {
  to.put(std::string_view(line.car));
  to.put(std::string_view(line.track));
  to.put(line.length);
  to.put(line.margin);
  to.put(line.is_best_so_far ? 1.0 : 0.0);
  to.put(static_cast<double>(line.points.size()));
  for (const road::RacingLinePoint& point : line.points)
    for (const auto field : kFields) to.put(point.*field);
}

void get(Reader& from, road::RacingLine& line) {
  from.get(line.car);
  from.get(line.track);
  from.get(line.length);
  from.get(line.margin);
  from.get(line.is_best_so_far);
  line.points.resize(from.count(sizeof(road::RacingLinePoint)));
  for (road::RacingLinePoint& point : line.points)
    for (const auto field : kFields) from.get(point.*field);
}

/// The result of that name in the cache, if it is there and whole.
template <class T, class Read>
std::optional<T> kept(const DiskCache* cache, const std::string& name, const Read& read) {
  if (cache == nullptr || name.empty()) return {};
  const std::optional<std::string> bytes = cache->find(name);
  if (!bytes) return {};
  std::optional<T> known = read(*bytes);
  if (!known) cache->report_damage(name);
  return known;
}

/// A limit that no budget ended, in the cache under one of two names: one with a witness answers for one
/// without, too.
std::optional<lap_time::PlantLimit> whole_limit(const road::Track& track, std::string_view plant,
                                                const sim::PlantDeviation& deviation,
                                                lap_time::PlantLimitOptions options,
                                                const sim::DoubleTrackParams& params) {
  const std::shared_ptr<const DiskCache> cache = cache_in_use();
  if (!cache) return {};
  options.budget = lap_time::PlantLimitOptions{}.budget;
  const bool wants_witness = std::exchange(options.wants_witness, true);
  const auto find = [&] {
    return kept<lap_time::PlantLimit>(cache.get(), name_of_limit(track, plant, deviation, options, params),
                                      limit_from_bytes);
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
  for (const double value :
       {options.margin, options.grip_share, options.slip_share, options.brake_share, options.speed_limit,
        options.time_step, options.budget, options.slides ? options.delay : 0.0})
    name.add(value);
  return name.text();
}

std::string name_of_limit(const road::Track& track, std::string_view plant,
                          const sim::PlantDeviation& deviation, const lap_time::PlantLimitOptions& options,
                          const sim::DoubleTrackParams& params) {
  Name name("limit");
  name.add(track);
  name.add(plant);
  name.add(sim::double_track_options(), &params);
  for (const double value :
       {deviation.friction_scale, deviation.mass_scale, options.time_step, options.wants_witness ? 1.0 : 0.0,
        static_cast<double>(options.laps), options.budget})
    name.add(value);
  return name.text();
}

Result<road::RacingLine> cached_plan(const road::Track& track, const model::VehicleParams& car,
                                     const lap_time::RacingPlanOptions& options) {
  const std::string name = name_of_plan(track, car, options);
  const std::shared_ptr<const DiskCache> cache = name.empty() ? nullptr : cache_in_use();
  if (std::optional<road::RacingLine> known = kept<road::RacingLine>(cache.get(), name, line_from_bytes))
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
  if (auto known = kept<lap_time::PlantLimit>(cache.get(), name, limit_from_bytes)) return std::move(*known);
  Result<lap_time::PlantLimit> found = lap_time::find_plant_limit(track, plant, deviation, options, params);
  if (name.empty() || !found) return found;
  lap_time::PlantLimitOptions unlimited = options;
  unlimited.budget = lap_time::PlantLimitOptions{}.budget;
  cache->keep(found->is_whole() ? name_of_limit(track, plant, deviation, unlimited, params) : name,
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

std::string to_bytes(const road::RacingLine& line) {
  Writer writer;
  put(writer, line);
  return writer.take();
}

std::optional<road::RacingLine> line_from_bytes(std::string_view bytes) {
  Reader reader(bytes);
  road::RacingLine line;
  get(reader, line);
  if (!reader.is_at_end() || line.is_empty()) return {};
  return line;
}

std::string to_bytes(const lap_time::PlantLimit& limit) {
  Writer writer;
  writer.put(limit.bound.lap);
  for (const double sector : limit.bound.sectors) writer.put(sector);
  put(writer, limit.line);
  for (const double value :
       {static_cast<double>(limit.nodes), static_cast<double>(limit.effort.iterations), limit.effort.work,
        static_cast<double>(limit.of_optimum.iterations), limit.of_optimum.work, limit.stationarity,
        limit.violation, limit.is_cut_short ? 1.0 : 0.0, limit.witness ? 1.0 : 0.0})
    writer.put(value);
  if (limit.witness) {
    writer.put(limit.witness->lap_time);
    writer.put(limit.witness->worst);
    writer.put(static_cast<double>(limit.witness->laps));
    writer.put(limit.witness->least_edge);
    put(writer, limit.witness->line);
  }
  return writer.take();
}

std::optional<lap_time::PlantLimit> limit_from_bytes(std::string_view bytes) {
  Reader reader(bytes);
  lap_time::PlantLimit limit;
  reader.get(limit.bound.lap);
  for (double& sector : limit.bound.sectors) reader.get(sector);
  get(reader, limit.line);
  reader.get(limit.nodes);
  reader.get(limit.effort.iterations);
  reader.get(limit.effort.work);
  reader.get(limit.of_optimum.iterations);
  reader.get(limit.of_optimum.work);
  reader.get(limit.stationarity);
  reader.get(limit.violation);
  reader.get(limit.is_cut_short);
  bool has_witness = false;
  reader.get(has_witness);
  if (has_witness) {
    limit.witness.emplace();
    reader.get(limit.witness->lap_time);
    reader.get(limit.witness->worst);
    reader.get(limit.witness->laps);
    reader.get(limit.witness->least_edge);
    get(reader, limit.witness->line);
  }
  if (!reader.is_at_end() || limit.line.is_empty()) return {};
  return limit;
}

}  // namespace chicane::run
