// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace chicane::protocol {

/// The GNU build ids of this program and of its shared libraries, one after the other: another code, other
/// bytes. Empty where the program has none (`-Wl,--build-id=none`). Takes some 10 µs.
[[nodiscard]] std::string build_ids();

}  // namespace chicane::protocol
