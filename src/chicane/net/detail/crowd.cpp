// SPDX-License-Identifier: MIT
#include "chicane/net/detail/crowd.hpp"

#include <algorithm>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace chicane::net {

void Crowd::note(std::size_t open) {
  constexpr std::size_t kFew = 16;  // not worth the milliseconds
  most_ = std::max(most_, open);
  if (most_ < kFew || open > most_ / 2) return;
  most_ = open;
#ifdef __GLIBC__
  ::malloc_trim(0);
#endif
}

}  // namespace chicane::net
