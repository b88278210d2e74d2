// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

// Cyclone's.
struct ddsi_serdata;
struct ddsi_sertype;

namespace chicane::ros {

/// A type of Cyclone DDS whose samples are bytes: what is written is sent as it is, what arrives is handed on
/// as it is. The sample of dds_write() is a std::string_view. Freed by Cyclone.
[[nodiscard]] ddsi_sertype* make_cdr_type(const std::string& name);
/// The bytes of a message of such a type, as long as it lives.
[[nodiscard]] std::string_view bytes_of(const ddsi_serdata& message);

}  // namespace chicane::ros
