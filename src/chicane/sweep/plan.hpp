// SPDX-License-Identifier: MIT
// Plan of a sweep: settings that all runs share, and axes, of which each run has one combination of values. A
// plan and the number of a run determine the settings of that run.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace chicane::sweep {

/// Settings as pairs of key and text, in the order in which they apply: keys of protocol/schema.hpp, as
/// `--set` takes them, and the additional keys of trial.hpp.
using Settings = std::vector<std::pair<std::string, std::string>>;

/// Named cases of a plan: the settings of a case by the key of its axis and by its name.
using Cases = std::map<std::string, std::map<std::string, Settings>>;

/// Values of one key along an axis: a list, a range, or named cases.
struct Dimension {
  std::string key{};
  std::vector<std::string> list{};  ///< values, or names of cases; empty: the values are a range
  std::vector<Settings> cases{};    ///< settings of each listed case; empty: `list` has values of `key`
  double from = 0.0, to = 0.0;      ///< range, both ends included
  /// Divides the range by even factors instead of even differences; from, to > 0.
  bool is_logarithmic = false;
  bool is_integer = false;  ///< rounds values of the range to integers

  /// Value at a share of the range or list, in [0, 1].
  [[nodiscard]] std::string at(double share) const;
};

/// Axis of a plan: keys that change together from run to run.
struct Axis {
  /// Values of a place: the same place of each list (kTogether), or the coordinates of a point of a sample.
  enum class Kind { kTogether, kSobol, kLatinHypercube };
  Kind kind = Kind::kTogether;
  std::uint64_t size = 0;               ///< number of places; kTogether: also the length of each list
  std::uint64_t seed = 0;               ///< seed of a sample
  std::vector<Dimension> dimensions{};  ///< one for each key

  /// Value of dimension `d` in place `i`, counted from 0.
  [[nodiscard]] std::string value(std::size_t d, std::uint64_t i) const;
};

/// Axis of one key with the values of `list`.
[[nodiscard]] Axis list_axis(std::string_view key, std::vector<std::string> list);

/// Search of each run for the largest clean value of a key. A run is clean if all laps are driven and no tyre
/// leaves the road. The tried values fall from `to` by `factor` until one is clean. Bisection by the
/// geometric mean then narrows the interval up to the value above, until both ends differ by less than
/// `within`. Values below the result are not tried.
struct Search {
  std::string key{};            ///< key whose value is searched
  double from = 0.0, to = 0.0;  ///< smallest and largest tried value; 0 < from <= to
  double factor = 1.25;         ///< ratio of two values of the ladder; > 1
  double within = 0.03;         ///< relative accuracy of the result; > 0
  /// Values tried first: falling from `to` by `factor`, with `from` as the last one.
  [[nodiscard]] std::vector<double> ladder() const;
};

/// Copy of `settings` in which the names of cases are replaced by the settings of the cases.
[[nodiscard]] Settings expanded(const Settings& settings, const Cases& cases);

/// Plan of many runs, numbered from 0.
struct Plan {
  static constexpr std::uint64_t kMostRuns = 1'000'000'000;  ///< limit of size(): months of driving; chosen

  std::string name{};
  Settings fixed{};                 ///< settings of all runs
  std::vector<Axis> axes{};         ///< axes; consecutive runs differ in the last one
  std::optional<Search> search{};   ///< none: each run is driven once
  std::vector<std::string> keep{};  ///< columns of the results (trial.hpp); empty: all

  std::vector<Settings> marks{};  ///< points that the maps mark, as values of axes; no effect on runs

  /// Number of runs; 1 without axes.
  [[nodiscard]] std::uint64_t size() const;
  /// Settings in which run `index` differs from the others: a pure function of the plan and `index`.
  [[nodiscard]] Settings at(std::uint64_t index) const;
  /// All settings of run `index`: `fixed`, then at(index) with its cases expanded. Later settings win.
  [[nodiscard]] Settings settings_of(std::uint64_t index) const;
  /// Settings of the cases that at() names.
  [[nodiscard]] Cases cases() const;
  /// Keys of at(), in the same order.
  [[nodiscard]] std::vector<std::string> keys() const;
  /// Hash of all that determines the runs of the plan: equal numbers mean equal plans, whatever file they are
  /// read from.
  [[nodiscard]] std::uint64_t hash() const;
  /// Digest of the contents of all presets, cars, scenarios and tracks that the plan names, the defaults
  /// included: with equal digests a run depends on the plan and its number alone. A missing file counts by
  /// its error message.
  [[nodiscard]] std::string digest_of_files() const;
};

// Points that fill a box evenly. Each is a pure function of its arguments, with the same bits on every
// machine, so that any run of a sweep can be computed without the others. Numbers are in [0, 1).

inline constexpr int kSobolDimensions = 21;  ///< limit of dimensions: rows of the table in plan.cpp, and one

/// Coordinate `dimension` of point `index` of Sobol's sequence (direction numbers of Joe and Kuo, 2008),
/// shifted by XOR with bits that `seed` chooses; 0: not shifted. A block of 2^k points that begins at a
/// multiple of 2^k has one coordinate in each of the 2^k equal parts of [0, 1). Pre: dimension in [0,
/// kSobolDimensions).
[[nodiscard]] double sobol(std::uint32_t index, int dimension, std::uint64_t seed) noexcept;

/// Coordinate `dimension` of point `index` of a Latin hypercube of `count` points: each of the `count` equal
/// parts of [0, 1) has one. Pre: index < count.
[[nodiscard]] double latin_hypercube(std::uint32_t index, std::uint32_t count, int dimension,
                                     std::uint64_t seed) noexcept;

}  // namespace chicane::sweep
