// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string_view>

#include "families/family_row.hpp"

namespace chicane::bench {

/// A family and how it is measured.
struct Family {
  std::string_view name;
  FamilyRow (*measure)(const FamilyRequest&, NaiveStart, References&);
  LoopRow (*drive)(const FamilyRequest&);  ///< null: no problem that goes on
  bool has_impossible = false;             ///< FamilyRequest::is_impossible
};
[[nodiscard]] std::span<const Family> all_families();

}  // namespace chicane::bench
