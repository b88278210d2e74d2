// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/scenario/scenario.hpp"

/// The files that ship: presets, cars, tracks and scenarios, found by name. Looked for, the first hit wins:
///
///   1. in ./presets (cars, tracks, scenarios);
///   2. in $CHICANE_DATA_DIR/presets;
///   3. in ../share/chicane/presets seen from the folder of the running program, where `cmake --install` puts
///      them, wherever the installation was moved to; or one folder further up, as in a build tree;
///   4. in share/chicane/presets of the prefix that the library was configured for.
///
/// A program of your own that uses a moved installation sets CHICANE_DATA_DIR (CMake: chicane_DATA_DIR;
/// pkg-config: the variable datadir). The functions keep nothing between calls: any thread may call them.
namespace chicane::protocol {

enum class Shelf { kPreset, kCar, kTrack, kScenario };

struct Entry {
  std::string name;  ///< file name without its extension
  std::string file;
  std::string description;  ///< the first comment line of the file
};

/// All entries of a shelf by name, each name once.
[[nodiscard]] std::vector<Entry> entries(Shelf shelf);

/// For names that come over the network: nothing when `name` is one of the shelf's entries, letter for
/// letter; kNotFound, "track: got ../x.csv, expected one of lakeside, ...", for everything else, paths
/// included. Opens no file that it names.
[[nodiscard]] Result<void> check_name(Shelf shelf, std::string_view name);

/// The file behind a name, or behind a path when `name_or_file` has a slash or an extension.
/// kNotFound: `preset: got "dfault", expected one of default, ... (did you mean default?)`.
[[nodiscard]] Result<std::string> locate(Shelf shelf, std::string_view name_or_file);

/// The bytes of a file of at most 64 MiB. kNotFound when there is none, kIo with the system's reason when it
/// cannot be read.
[[nodiscard]] Result<std::string> read_file(const std::string& path);

/// Where to write what shall take the place of `path` as a whole, by a rename: a file beside it, a name of
/// this process alone. `path` itself where that is there and no file, but a device or a pipe.
[[nodiscard]] std::string unfinished_name(const std::string& path);

/// What a user asks for: a scenario file (empty: none) and settings by schema key, in the order given.
struct Request {
  std::string scenario_file;
  std::vector<std::pair<std::string, std::string>> settings;
  std::string speed_mps{};            ///< reference of whichever controller drives; empty: its own
  std::vector<std::string> faults{};  ///< NAME@S+S*X (fault_codec.hpp), beside those of the scenario file
};

/// The experiment asked for. Later layers win: defaults, car file, preset (with the presets it builds on),
/// scenario file, settings, speed. The names `preset`, `car` and `track` may be files, relative to the
/// working directory or to the scenario file. All faults at once, each with its file and line.
[[nodiscard]] Result<scenario::Scenario> compose(const Request& request);

}  // namespace chicane::protocol
