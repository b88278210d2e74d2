// SPDX-License-Identifier: MIT
#pragma once

#include "support/folder.hpp"

namespace chicane::test {

/// Expects `text` to equal the file kept in tests/. CHICANE_WRITE_FIXTURES=1 renews the file:
/// look at the difference before you keep it.
inline void expect_kept(const std::string& file, const std::string& text) {
  const fs::path path = fs::path(CHICANE_SOURCE_DIR) / "tests" / file;
  if (std::getenv("CHICANE_WRITE_FIXTURES") != nullptr) std::ofstream(path, std::ios::binary) << text;
  EXPECT_EQ(text, content_of(path)) << file
                                    << "; wanted? cmake --build --preset release --target renew_fixtures";
}

}  // namespace chicane::test
