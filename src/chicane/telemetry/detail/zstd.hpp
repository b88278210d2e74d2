// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

/// Zstandard, where the program was built with libzstd.
namespace chicane::telemetry::zstd {

[[nodiscard]] bool is_available() noexcept;
/// At the fastest level. Pre: is_available().
[[nodiscard]] std::string compress(std::string_view bytes);
/// None when it is damaged, or is not of `size` bytes. Pre: is_available().
[[nodiscard]] std::optional<std::string> decompress(std::string_view bytes, std::uint64_t size);

}  // namespace chicane::telemetry::zstd
