// SPDX-License-Identifier: MIT
#pragma once

#include "support/chicane_test.hpp"

namespace chicane::test {

/// Texts, each with words.
using Said = std::vector<std::pair<std::string, std::string>>;

/// `saying` says the words of each text.
template <class Saying>
void expect_said(const Saying& saying, const Said& rows) {
  for (const auto& [text, words] : rows) EXPECT_THAT(saying(text), HasSubstr(words)) << text;
}

}  // namespace chicane::test
