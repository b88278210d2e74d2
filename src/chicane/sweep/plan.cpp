// SPDX-License-Identifier: MIT
// Plans of sweeps: axes and their values, the settings of each run, and the hashes that identify a plan and
// its files.
#include "chicane/sweep/plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <set>

#include "chicane/base/compiler.hpp"
#include "chicane/base/math.hpp"
#include "chicane/base/random.hpp"
#include "chicane/base/text.hpp"
#include "chicane/protocol/library.hpp"
#include "chicane/protocol/yaml_codec.hpp"
#include "chicane/sweep/plan_codec.hpp"

namespace chicane::sweep {
namespace {

/// Row of the table new-joe-kuo-6.21201 of Joe and Kuo: degree and coefficients of a primitive polynomial,
/// and the first direction numbers.
struct Direction {
  unsigned degree;
  unsigned coefficients;
  std::array<unsigned, 7> first;
};
constexpr std::array<Direction, kSobolDimensions - 1> kDirections{{
    {1, 0, {1}},
    {2, 1, {1, 3}},
    {3, 1, {1, 3, 1}},
    {3, 2, {1, 1, 1}},
    {4, 1, {1, 1, 3, 3}},
    {4, 4, {1, 3, 5, 13}},
    {5, 2, {1, 1, 5, 5, 17}},
    {5, 4, {1, 1, 5, 5, 5}},
    {5, 7, {1, 1, 7, 11, 19}},
    {5, 11, {1, 1, 5, 1, 1}},
    {5, 13, {1, 1, 1, 3, 11}},
    {5, 14, {1, 3, 5, 5, 31}},
    {6, 1, {1, 3, 3, 9, 7, 49}},
    {6, 13, {1, 1, 1, 15, 21, 21}},
    {6, 16, {1, 3, 1, 13, 27, 49}},
    {6, 19, {1, 1, 1, 15, 7, 5}},
    {6, 22, {1, 3, 1, 15, 13, 25}},
    {6, 25, {1, 1, 5, 5, 19, 61}},
    {7, 1, {1, 3, 7, 11, 23, 15, 103}},
    {7, 4, {1, 3, 7, 13, 13, 15, 69}},
}};
constexpr unsigned kBits = 32;  // bits of a Sobol number

/// Direction numbers of one dimension: the XOR of those at the set bits of an index is the coordinate.
using SobolNumbers = std::array<std::uint32_t, kBits>;

/// Direction numbers by the recurrence of Joe and Kuo; dimension 0 is the sequence of van der Corput.
constexpr SobolNumbers directions_of(int dimension) {
  SobolNumbers v{};
  if (dimension == 0) {
    for (unsigned i = 0; i < kBits; ++i) v[i] = 1U << (kBits - 1 - i);
    return v;
  }
  const Direction& d = kDirections[static_cast<std::size_t>(dimension - 1)];
  for (unsigned i = 0; i < kBits; ++i) {
    if (i < d.degree) {
      v[i] = d.first[i] << (kBits - 1 - i);
      continue;
    }
    v[i] = v[i - d.degree] ^ (v[i - d.degree] >> d.degree);
    for (unsigned k = 1; k < d.degree; ++k) v[i] ^= ((d.coefficients >> (d.degree - 1 - k)) & 1U) * v[i - k];
  }
  return v;
}

constexpr auto kSobolNumbers = [] {
  std::array<SobolNumbers, kSobolDimensions> columns{};
  for (int d = 0; d < kSobolDimensions; ++d) columns[static_cast<std::size_t>(d)] = directions_of(d);
  return columns;
}();

/// Pseudo-random number from three arguments: a pure function. The odd factors come from SplitMix64 and
/// xxHash64.
std::uint64_t mixed(std::uint64_t seed, std::uint64_t a, std::uint64_t b) noexcept {
  Random random(seed * 0x9e3779b97f4a7c15ULL ^ (a * 0xc2b2ae3d27d4eb4fULL) ^ (b * 0x165667b19e3779f9ULL));
  static_cast<void>(random.bits());
  return random.bits();
}

/// Place of `index` in a pseudo-random permutation of [0, count) that `key` chooses: a Feistel network over
/// the next power of four, applied again until the number is below `count`.
std::uint32_t permuted(std::uint32_t index, std::uint32_t count, std::uint64_t key) noexcept {
  constexpr std::uint64_t kRounds = 6;  // chosen: four make a pseudo-random permutation, two to spare
  const unsigned half = (static_cast<unsigned>(std::bit_width(count - 1)) + 1) / 2;
  const std::uint64_t mask = (std::uint64_t{1} << half) - 1;
  std::uint64_t at = index;
  do {
    std::uint64_t left = at >> half;
    std::uint64_t right = at & mask;
    for (std::uint64_t round = 0; round < kRounds; ++round) {
      const std::uint64_t next = left ^ (mixed(key, right, round) & mask);
      left = right;
      right = next;
    }
    at = left << half | right;
  } while (at >= count);
  return static_cast<std::uint32_t>(at);
}

}  // namespace

double sobol(std::uint32_t index, int dimension, std::uint64_t seed) noexcept {
  CHICANE_ASSERT(dimension >= 0 && dimension < kSobolDimensions);
  const SobolNumbers& v = kSobolNumbers[static_cast<std::size_t>(dimension)];
  const std::uint32_t gray = index ^ (index >> 1U);
  std::uint32_t x = 0;
  for (unsigned i = 0; i < kBits; ++i)
    if ((gray >> i & 1U) != 0) x ^= v[i];
  if (seed != 0) x ^= static_cast<std::uint32_t>(mixed(seed, static_cast<std::uint64_t>(dimension), 0));
  return static_cast<double>(x) * 0x1.0p-32;
}

double latin_hypercube(std::uint32_t index, std::uint32_t count, int dimension, std::uint64_t seed) noexcept {
  CHICANE_ASSERT(index < count);
  const auto d = static_cast<std::uint64_t>(dimension);
  const std::uint32_t cell = count == 1 ? 0 : permuted(index, count, mixed(seed, d, 1));
  Random inside(mixed(seed, d, 2) ^ index);
  return (static_cast<double>(cell) + inside.uniform()) / static_cast<double>(count);
}

namespace {

constexpr int kDigits = 12;  // significant digits of a computed value: 0.3, not 0.30000000000000004

using detail::add_text;

/// Adds keys and texts of settings to a hash.
void add_settings(Fnv& hash, const Settings& settings) {
  for (const auto& [key, text] : settings) {
    add_text(hash, key);
    add_text(hash, text);
  }
}

/// Kind and name of each file that runs read, each once: ("car", "udacity").
using FileNames = std::set<std::pair<std::string, std::string>>;

/// Adds the files that settings name.
void add_files(const Settings& settings, FileNames& files) {
  for (const auto& [key, text] : settings)
    if (key == "preset" || key == "car" || key == "scenario" || key == "track") files.emplace(key, text);
}

/// Files that the runs of a plan name, without those that these files name themselves.
FileNames files_in(const Plan& plan) {
  FileNames files{{"scenario", ""}};  // no file: the defaults
  add_files(plan.fixed, files);
  for (const Axis& axis : plan.axes) {
    for (const Dimension& dimension : axis.dimensions) {
      if (dimension.cases.empty())
        for (const std::string& text : dimension.list) add_files({{dimension.key, text}}, files);
      for (const Settings& settings : dimension.cases) add_files(settings, files);
    }
  }
  return files;
}

/// Content of a track's file, or the error message if it cannot be read.
std::string track_bytes(const std::string& track) {
  const Result<std::string> file = protocol::locate(protocol::Shelf::kTrack, track);
  const Result<std::string> bytes = file ? protocol::read_file(*file) : fail(file.error());
  return bytes ? *bytes : bytes.error().message;
}

}  // namespace

Axis list_axis(std::string_view key, std::vector<std::string> list) {
  Axis axis;
  axis.size = list.size();
  axis.dimensions.push_back({.key = std::string(key), .list = std::move(list)});
  return axis;
}

std::vector<double> Search::ladder() const {
  std::vector<double> values{to};
  while (values.back() / factor > from) values.push_back(values.back() / factor);
  if (values.back() > from) values.push_back(from);
  return values;
}

Settings expanded(const Settings& settings, const Cases& cases) {
  Settings all;
  for (const auto& [key, text] : settings) {
    const auto by_name = cases.find(key);
    if (by_name == cases.end()) {
      all.emplace_back(key, text);
    } else if (const auto named = by_name->second.find(text); named != by_name->second.end()) {
      all.insert(all.end(), named->second.begin(), named->second.end());
    }
  }
  return all;
}

std::string Dimension::at(double share) const {
  if (!list.empty()) {
    const auto place = static_cast<std::size_t>(share * static_cast<double>(list.size()));
    return list[std::min(place, list.size() - 1)];
  }
  const double value =
      is_logarithmic ? from * exp(share * (log(to) - log(from))) : from + share * (to - from);
  const double inside = std::clamp(value, std::min(from, to), std::max(from, to));
  return number_text(is_integer ? std::round(inside) : inside, kDigits);
}

std::string Axis::value(std::size_t d, std::uint64_t i) const {
  const Dimension& dimension = dimensions[d];
  const auto index = static_cast<std::uint32_t>(i);
  const auto which = static_cast<int>(d);
  switch (kind) {
    case Kind::kSobol:
      return dimension.at(sobol(index, which, seed));
    case Kind::kLatinHypercube:
      return dimension.at(latin_hypercube(index, static_cast<std::uint32_t>(size), which, seed));
    case Kind::kTogether:
      break;
  }
  if (!dimension.list.empty()) return dimension.list[i];
  return dimension.at(size < 2 ? 0.0 : static_cast<double>(i) / static_cast<double>(size - 1));
}

std::uint64_t Plan::size() const {
  std::uint64_t size = 1;
  for (const Axis& axis : axes) size *= axis.size;
  return size;
}

Settings Plan::at(std::uint64_t index) const {
  std::vector<std::uint64_t> places(axes.size());
  for (std::size_t a = axes.size(); a-- > 0; index /= axes[a].size) places[a] = index % axes[a].size;
  Settings settings;
  for (std::size_t a = 0; a < axes.size(); ++a) {
    for (std::size_t d = 0; d < axes[a].dimensions.size(); ++d)
      settings.emplace_back(axes[a].dimensions[d].key, axes[a].value(d, places[a]));
  }
  return settings;
}

Settings Plan::settings_of(std::uint64_t index) const {
  Settings settings = fixed;
  for (auto& setting : expanded(at(index), cases())) settings.push_back(std::move(setting));
  return settings;
}

Cases Plan::cases() const {
  Cases cases;
  for (const Axis& axis : axes)
    for (const Dimension& dimension : axis.dimensions)
      for (std::size_t i = 0; i < dimension.cases.size(); ++i)
        cases[dimension.key][dimension.list[i]] = dimension.cases[i];
  return cases;
}

std::vector<std::string> Plan::keys() const {
  std::vector<std::string> keys;
  for (const Axis& axis : axes)
    for (const Dimension& dimension : axis.dimensions) keys.push_back(dimension.key);
  return keys;
}

std::uint64_t Plan::hash() const {
  Fnv hash;
  add_settings(hash, fixed);
  for (const Axis& axis : axes) {
    hash.add(static_cast<std::uint64_t>(axis.kind));
    hash.add(axis.size);
    hash.add(axis.seed);
    for (const Dimension& dimension : axis.dimensions) {
      add_text(hash, dimension.key);
      for (const std::string& text : dimension.list) add_text(hash, text);
      for (const Settings& settings : dimension.cases) {
        hash.add(static_cast<std::uint64_t>(settings.size()));
        add_settings(hash, settings);
      }
      hash.add(dimension.from);
      hash.add(dimension.to);
      hash.add(
          static_cast<std::uint64_t>((dimension.is_logarithmic ? 1 : 0) + (dimension.is_integer ? 2 : 0)));
    }
  }
  if (search) {
    add_text(hash, search->key);
    for (const double value : {search->from, search->to, search->factor, search->within}) hash.add(value);
  }
  for (const std::string& column : keep) add_text(hash, column);
  return hash.value();
}

std::string Plan::digest_of_files() const {
  FileNames files = files_in(*this);
  Fnv hash;
  for (const auto& [key, text] : FileNames(files)) {  // a copy: tracks are added meanwhile
    if (key == "track") continue;
    protocol::Request request;
    if (key == "scenario") {
      request.scenario_file = text;
    } else {
      request.settings.emplace_back(key, text);
    }
    const Result<scenario::Scenario> scenario = protocol::compose(request);
    if (scenario) files.emplace("track", scenario->track);
    add_text(hash, scenario ? protocol::write_document(*scenario, "", true) : scenario.error().message);
  }
  for (const auto& [key, text] : files)
    if (key == "track") add_text(hash, track_bytes(text));
  return fmt::format("{:016x}", hash.value());
}

}  // namespace chicane::sweep
