// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string_view>

/// What reads bytes from outside, each as one function that takes any bytes. Driven by libFuzzer (fuzzer.cpp,
/// tools/fuzz.sh) and, over the kept corpora, by corpus_test.cpp. A target ends the program where a promise
/// is broken.
namespace chicane::fuzz {

struct Target {
  std::string_view name;  ///< its corpus is corpus/NAME
  void (*run)(std::string_view bytes);
};

[[nodiscard]] std::span<const Target> targets() noexcept;
/// nullptr when there is none.
[[nodiscard]] const Target* find(std::string_view name) noexcept;

}  // namespace chicane::fuzz
