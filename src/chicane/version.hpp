// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

/// The version of the headers that a program is compiled with, for #if; CMakeLists.txt reads it here. Numbers
/// follow SemVer: before 1.0 a new minor version may change any interface.
#define CHICANE_VERSION_MAJOR 0
#define CHICANE_VERSION_MINOR 3
#define CHICANE_VERSION_PATCH 0

#define CHICANE_DETAIL_TEXT(number) #number
#define CHICANE_DETAIL_VERSION(major, minor, patch) \
  CHICANE_DETAIL_TEXT(major) "." CHICANE_DETAIL_TEXT(minor) "." CHICANE_DETAIL_TEXT(patch)
/// The version, "MAJOR.MINOR.PATCH", as a string literal.
#define CHICANE_VERSION \
  CHICANE_DETAIL_VERSION(CHICANE_VERSION_MAJOR, CHICANE_VERSION_MINOR, CHICANE_VERSION_PATCH)

namespace chicane {

inline constexpr int kVersionMajor = CHICANE_VERSION_MAJOR;
inline constexpr int kVersionMinor = CHICANE_VERSION_MINOR;
inline constexpr int kVersionPatch = CHICANE_VERSION_PATCH;
inline constexpr std::string_view kVersion = CHICANE_VERSION;  ///< "0.3.0"

}  // namespace chicane
