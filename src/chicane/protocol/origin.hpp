// SPDX-License-Identifier: MIT
// Origin of a run's car and road, as their files state it: for viewers and recordings.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "chicane/scenario/scenario.hpp"

namespace chicane::protocol {

/// Parameter of a car file that `chicane identify` wrote, in the unit of its key.
struct IdentifiedValue {
  std::string key;  ///< "mass_kg"
  double value = 0.0;
  double low = 0.0;   ///< lower end of the 95 % interval; not-a-number: not excited by the log
  double high = 0.0;  ///< upper end of the interval, or not-a-number

  friend bool operator==(const IdentifiedValue&, const IdentifiedValue&) = default;
};

/// Origin of a car and a road.
struct Origin {
  std::vector<std::string> car_notes;       ///< remarks at the head of the car's file, a line each
  std::vector<IdentifiedValue> identified;  ///< values in the file's order; empty without a log
  std::string road_kind;                    ///< "occupancy map", "table of points"; empty: not known
  std::vector<std::string> road_notes;      ///< remarks at the head of the road's file, and what its
                                            ///< reader assumed
};

/// Origin by the files that `scenario` names. Files that cannot be read leave their part empty: the run
/// reports them.
[[nodiscard]] Origin origin_of(const scenario::Scenario& scenario);

/// Remark with the interval of a parameter of a car file: "[log] 1.02 to 1.18".
[[nodiscard]] std::string band_remark(double low, double high);
/// Remark of a parameter that the log did not excite.
inline constexpr std::string_view kAssumedRemark = "[assumed]";
/// Parameters with one of these remarks, in any text.
[[nodiscard]] std::vector<IdentifiedValue> identified_in(std::string_view car_file);

/// Prefix of a remark at the head of a road's file that is text for people, in which no setting is searched.
inline constexpr std::string_view kNote = "note: ";
/// Comment lines before the first line of data, without licence, settings and names of columns; at most 12.
[[nodiscard]] std::vector<std::string> head_remarks(std::string_view text);

}  // namespace chicane::protocol
