// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace chicane::telemetry {

/// A text in fixed memory, so that it can be handed from thread to thread without allocation. What does not
/// fit is cut off: ask `fits` before.
template <std::size_t Capacity>
class ShortText {
 public:
  ShortText() = default;
  template <std::convertible_to<std::string_view> Text>
  ShortText(const Text& text) noexcept {  // NOLINT(google-explicit-constructor): it is a text
    const std::string_view all = text;
    size_ = std::min(all.size(), Capacity);
    std::copy_n(all.begin(), size_, bytes_.begin());
  }
  [[nodiscard]] static constexpr bool fits(std::string_view text) noexcept { return text.size() <= Capacity; }
  [[nodiscard]] std::string_view view() const noexcept { return {bytes_.data(), size_}; }

 private:
  std::array<char, Capacity> bytes_{};
  std::size_t size_ = 0;
};

/// One setting that changed while a run went on (live/live_settings.hpp).
struct Change {
  std::uint64_t cycle = 0;   ///< the first control cycle that follows it
  double time = 0.0;         ///< of the run [s]
  ShortText<64> name;        ///< schema key, "run.pace", "manual.…" or "fault.…"
  ShortText<256> value;      ///< as --set takes it: reads back into the same bits
  bool starts_anew = false;  ///< the run began anew with it: everything else is forgotten
};

}  // namespace chicane::telemetry
