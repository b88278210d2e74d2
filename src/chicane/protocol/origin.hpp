// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "chicane/scenario/scenario.hpp"

/// Origin of a run's car and road, as their files state it: for viewers and recordings.
namespace chicane::protocol {

/// A parameter of a car file that `chicane identify` wrote, in the unit of its key.
struct IdentifiedValue {
  std::string key;  ///< "mass_kg"
  double value = 0.0;
  double low = 0.0;   ///< lower end of the 95 % interval; not-a-number: not excited by the log
  double high = 0.0;  ///< upper end; not-a-number: the value was assumed

  friend bool operator==(const IdentifiedValue&, const IdentifiedValue&) = default;
};

struct Origin {
  std::vector<std::string> car_notes;       ///< remarks at the head of the car's file, a line each
  std::vector<IdentifiedValue> identified;  ///< values in the file's order; empty without a log
  std::string road_kind;                    ///< "occupancy map", "table of points"; empty: not known
  std::vector<std::string> road_notes;      ///< remarks at the head of the road's file, and what its
                                            ///< reader assumed
};

/// Origin by the files that `scenario` names. Unreadable files stay empty: the run itself reports them.
[[nodiscard]] Origin origin_of(const scenario::Scenario& scenario);

/// The remark behind a parameter of a car file: "[log] 1.02 to 1.18".
[[nodiscard]] std::string band_remark(double low, double high);
inline constexpr std::string_view kAssumedRemark = "[assumed]";
/// Parameters with such remarks, in any text.
[[nodiscard]] std::vector<IdentifiedValue> identified_in(std::string_view car_file);

/// Marks a remark at the head of a road's file as text, so that no setting is read from it.
inline constexpr std::string_view kNote = "note: ";
/// Comment lines before the first line of data, without licence, settings and names of columns; at most 12.
[[nodiscard]] std::vector<std::string> head_remarks(std::string_view text);

}  // namespace chicane::protocol
