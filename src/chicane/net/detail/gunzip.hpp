// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace chicane::net {

/// What one member of gzip (RFC 1952) holds; none for anything else. For files of ours: sizes are not
/// bounded.
[[nodiscard]] std::optional<std::string> gunzip(std::string_view compressed);

/// Whether an Accept-Encoding header (RFC 9110 §12.5.3) takes gzip; without the header nobody asked for it.
[[nodiscard]] bool accepts_gzip(std::string_view accept_encoding);

}  // namespace chicane::net
