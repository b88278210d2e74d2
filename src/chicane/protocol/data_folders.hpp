// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

/// The folders that hold the shipped files: presets, cars, tracks, scenarios.

namespace chicane::protocol {

/// Places from which the search for folders starts; empty if unknown.
struct DataOrigins {
  std::string environment{};  ///< value of the variable CHICANE_DATA_DIR: a folder with the folder `presets`
  std::string program{};      ///< file of the running program, absolute
  std::string shared_object{};  ///< file of the shared object that contains this library, absolute
  std::string header{};         ///< absolute path of this header in the build's installation
};

/// The origins of this process. Reads the environment and, where the system has it, /proc. Without /proc the
/// program is the path that it was started with.
[[nodiscard]] DataOrigins data_origins();

/// Every folder in which a file of `kind` ("presets") is looked for, the first one first, whether it exists
/// or not, each once:
///
///   1. ./presets;
///   2. presets in the folder that CHICANE_DATA_DIR names;
///   3. share/chicane/presets in the program's folder, in the one above, and in the one above that: a folder
///      that was unpacked, an installation wherever it was moved to, a build tree;
///   4. the same for the shared object that contains the library, such as a Python module;
///   5. share/chicane/presets of the installation whose headers the program was compiled with;
///   6. share/chicane/presets of the prefix that the library was configured for, and of /usr.
[[nodiscard]] std::vector<std::string> data_folders(const DataOrigins& origins, std::string_view kind);

}  // namespace chicane::protocol

#ifdef CHICANE_USES_INSTALLATION
// Symbol from the CMake targets and .pc files of an installation. A program that includes this header then
// knows the installation's place, also after it was moved.
extern "C" {
[[gnu::used]] inline constexpr char chicane_installed_header[] = __FILE__;
}
#endif

namespace chicane::protocol {

/// The GNU build ids of this program and of its shared libraries, one after the other: another code, other
/// bytes. Empty where the program has none (`-Wl,--build-id=none`). Takes some 10 µs.
[[nodiscard]] std::string build_ids();

}  // namespace chicane::protocol
