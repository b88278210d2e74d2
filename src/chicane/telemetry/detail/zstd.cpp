// SPDX-License-Identifier: MIT
#include "chicane/telemetry/detail/zstd.hpp"

#include "chicane/base/compiler.hpp"

#ifdef CHICANE_HAVE_ZSTD
#include <zstd.h>
#endif

namespace chicane::telemetry::zstd {

#ifdef CHICANE_HAVE_ZSTD

bool is_available() noexcept { return true; }

std::string compress(std::string_view bytes) {
  constexpr int kFastest = 1;
  std::string compressed(ZSTD_compressBound(bytes.size()), '\0');
  const std::size_t size =
      ZSTD_compress(compressed.data(), compressed.size(), bytes.data(), bytes.size(), kFastest);
  CHICANE_ASSERT(ZSTD_isError(size) == 0);  // the bound is enough for any input
  compressed.resize(size);
  return compressed;
}

std::optional<std::string> decompress(std::string_view bytes, std::uint64_t size) {
  constexpr std::uint64_t kMost = 256U << 20U;  // the size is read from the file and not to be trusted
  if (size > kMost) return std::nullopt;
  std::string plain(static_cast<std::size_t>(size), '\0');
  if (ZSTD_decompress(plain.data(), plain.size(), bytes.data(), bytes.size()) != plain.size())
    return std::nullopt;
  return plain;
}

#else

bool is_available() noexcept { return false; }
std::string compress(std::string_view bytes) { return std::string(bytes); }
std::optional<std::string> decompress(std::string_view, std::uint64_t) { return std::nullopt; }

#endif

}  // namespace chicane::telemetry::zstd
