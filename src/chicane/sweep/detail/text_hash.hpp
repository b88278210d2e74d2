// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string_view>

#include "chicane/base/fnv.hpp"

namespace chicane::sweep::detail {

/// A text with its length, so that what follows is not taken for a part of it.
inline void add_text(Fnv& hash, std::string_view text) {
  hash.add(static_cast<std::uint64_t>(text.size()));
  for (const char c : text) hash.add(static_cast<std::uint64_t>(static_cast<unsigned char>(c)));
}

}  // namespace chicane::sweep::detail
