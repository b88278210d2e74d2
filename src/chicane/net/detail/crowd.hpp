// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

namespace chicane::net {

/// Gives memory back to the system after a crowd has gone; the allocator would keep what it freed.
class Crowd {
 public:
  /// So many connections are open now.
  void note(std::size_t open);

 private:
  std::size_t most_ = 0;  ///< since memory was given back
};

}  // namespace chicane::net
