// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// Plan of a sweep: settings that all runs share, and axes, of which each run has one combination.

namespace chicane::sweep {

/// Key and text of settings, as `--set` takes them: keys of the schema, and those of trial.hpp.
using Settings = std::vector<std::pair<std::string, std::string>>;

/// Settings behind the names along an axis, by the axis's key and by name.
using Cases = std::map<std::string, std::map<std::string, Settings>>;

/// The values of one key along an axis: a list, a range, or cases.
struct Dimension {
  std::string key{};
  std::vector<std::string> list{};  ///< values; if there are any, there is no range
  std::vector<Settings> cases{};    ///< settings behind the listed names; empty: names are values of `key`
  double from = 0.0, to = 0.0;      ///< a range, both ends included
  bool is_logarithmic = false;      ///< even factors instead of even distances; from, to > 0
  bool is_integer = false;          ///< rounded to integers

  /// The value at a share of the range or list, [0, 1].
  [[nodiscard]] std::string at(double share) const;
};

/// Keys that change together.
struct Axis {
  enum class Kind { kTogether, kSobol, kLatinHypercube };
  Kind kind = Kind::kTogether;
  std::uint64_t size = 0;  ///< runs along it; kTogether: also the length of each list
  std::uint64_t seed = 0;  ///< seed of a sample
  std::vector<Dimension> dimensions{};

  /// The value of dimension `d` in place `i`.
  [[nodiscard]] std::string value(std::size_t d, std::uint64_t i) const;
};

/// An axis with a value of one key in each place.
[[nodiscard]] Axis list_axis(std::string_view key, std::vector<std::string> list);

/// Search of each run for the largest value of a key with which it is clean: all laps driven, no tyre off the
/// road. Goes down from `to` by `factor` until a value is clean, then bisects between that and the one
/// before, in equal proportions, until they are `within` of each other. Values below the result are not
/// tried.
struct Search {
  std::string key{};
  double from = 0.0, to = 0.0;  ///< 0 < from <= to
  double factor = 1.25;         ///< > 1
  double within = 0.03;         ///< relative, > 0
  /// The values tried first, falling, `from` the last one.
  [[nodiscard]] std::vector<double> ladder() const;
};

/// Replaces the names of cases in `settings` by their settings.
[[nodiscard]] Settings expanded(const Settings& settings, const Cases& cases);

struct Plan {
  static constexpr std::uint64_t kMostRuns = 1'000'000'000;

  std::string name{};
  Settings fixed{};
  std::vector<Axis> axes{};         ///< the last one turns fastest
  std::optional<Search> search{};   ///< none: each run is driven once
  std::vector<std::string> keep{};  ///< columns of the results (trial.hpp); empty: all

  std::vector<Settings> marks{};  ///< places that maps mark, by values of axes; of no effect on runs

  /// Number of runs; 1 without axes.
  [[nodiscard]] std::uint64_t size() const;
  /// Settings in which run `index` differs from the others. Pure: depends on nothing else.
  [[nodiscard]] Settings at(std::uint64_t index) const;
  /// Everything about it: what all runs share, and at(index) with its cases expanded. The later ones win.
  [[nodiscard]] Settings settings_of(std::uint64_t index) const;
  /// Settings behind the names in at().
  [[nodiscard]] Cases cases() const;
  /// The keys of at().
  [[nodiscard]] std::vector<std::string> keys() const;
  /// Hash of everything that a run depends on: equal numbers mean equal plans, wherever and however written.
  [[nodiscard]] std::uint64_t hash() const;
  /// Digest of the presets, cars, scenarios and tracks that runs are driven with, the defaults included:
  /// equal texts mean that a run depends on the plan and its number alone. Missing files count by their
  /// error.
  [[nodiscard]] std::string digest_of_files() const;
};

// Points that fill a box evenly. Each is a pure function of its arguments, with the same bits on every
// machine, so that any run of a sweep can be computed without the others. Numbers are in [0, 1).

inline constexpr int kSobolDimensions = 21;

/// Coordinate `dimension` of point `index` of Sobol's sequence (direction numbers of Joe and Kuo, 2008),
/// moved by a digital shift that `seed` chooses; seed 0 moves nothing. Each 2^k points that begin at a
/// multiple of 2^k have one coordinate in each 2^k-th of the interval. Pre: dimension in [0,
/// kSobolDimensions).
[[nodiscard]] double sobol(std::uint32_t index, int dimension, std::uint64_t seed) noexcept;

/// Coordinate `dimension` of point `index` of a Latin hypercube of `count` points: each count-th of the
/// interval has one. Pre: index < count.
[[nodiscard]] double latin_hypercube(std::uint32_t index, std::uint32_t count, int dimension,
                                     std::uint64_t seed) noexcept;

}  // namespace chicane::sweep
