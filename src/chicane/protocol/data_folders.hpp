// SPDX-License-Identifier: MIT
// Search path of the shipped files: presets, cars, tracks, scenarios; and the build ids of a program.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace chicane::protocol {

/// Paths from which the search for folders starts; empty if unknown.
struct DataOrigins {
  std::string environment{};  ///< value of the variable CHICANE_DATA_DIR: a folder with the folder `presets`
  std::string program{};      ///< file of the running program, absolute
  std::string shared_object{};  ///< file of the shared object that contains this library, absolute
  /// Path of this header in the installation that the program was compiled with; empty in a build tree.
  std::string header{};
};

/// Origins of this process, from the environment and, where the system has it, /proc. Without /proc the
/// program is the path by which it was started.
[[nodiscard]] DataOrigins data_origins();

/// Folders in which a file of `kind` ("presets") is searched, in this order, each once, whether it exists or
/// not. The first two are returned as spelled here, the others with links resolved:
///
///   1. ./presets;
///   2. presets in the folder that CHICANE_DATA_DIR names;
///   3. share/chicane/presets in the program's folder (an unpacked archive), in the folder above it (an
///      installation, which may have been moved), and two above it (a build tree);
///   4. the same for the shared object that contains the library, such as a Python module;
///   5. share/chicane/presets of the installation whose headers the program was compiled with;
///   6. share/chicane/presets of the prefix that the library was configured for, and of /usr.
[[nodiscard]] std::vector<std::string> data_folders(const DataOrigins& origins, std::string_view kind);

}  // namespace chicane::protocol

#ifdef CHICANE_USES_INSTALLATION
// Defined for users of an installation's CMake targets and .pc files. A program that includes this header has
// the path of the installation in this symbol, also after the program was moved.
extern "C" {
[[gnu::used]] inline constexpr char chicane_installed_header[] = __FILE__;
}
#endif

namespace chicane::protocol {

/// GNU build ids of this program and of its shared libraries, one after the other. The texts of two programs
/// differ if their code differs. Empty if the program has no build id (`-Wl,--build-id=none`). Takes some
/// 10 µs.
[[nodiscard]] std::string build_ids();

}  // namespace chicane::protocol
