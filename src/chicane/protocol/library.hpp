// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/protocol/data_folders.hpp"
#include "chicane/protocol/yaml_codec.hpp"
#include "chicane/scenario/scenario.hpp"

/// The files that ship: presets, cars, tracks and scenarios, found by name in the folders of
/// data_folders.hpp, the first hit wins. The functions keep nothing between calls: any thread may call them.
namespace chicane::protocol {

enum class Shelf { kPreset, kCar, kTrack, kScenario };

struct Entry {
  std::string name;  ///< file name without its extension
  std::string file;
  std::string description;  ///< the first comment line of the file
};

/// All entries of a shelf by name, each name once.
[[nodiscard]] std::vector<Entry> entries(Shelf shelf);

/// Checks that a shelf has an entry. kNotFound names each folder that was searched: "preset: found no presets
/// in ./presets, /usr/share/chicane/presets; set CHICANE_DATA_DIR to the folder that holds the folder
/// presets".
[[nodiscard]] Result<void> check_shelf(Shelf shelf);

/// Checks a name that comes over the network: nothing if `name` is one of the shelf's entries, letter for
/// letter; kNotFound, "track: got ../x.csv, expected one of lakeside, ...", for everything else, paths
/// included. Opens no file that it names.
[[nodiscard]] Result<void> check_name(Shelf shelf, std::string_view name);

/// The file behind a name, or behind a path when `name_or_file` has a slash or an extension.
/// kNotFound: `preset: got "dfault", expected one of default, ... (did you mean default?)`, or the message of
/// check_shelf() where there is nothing to choose from.
[[nodiscard]] Result<std::string> locate(Shelf shelf, std::string_view name_or_file);

/// The bytes of a file of at most 64 MiB. kNotFound when there is none, kIo with the system's reason when it
/// cannot be read.
[[nodiscard]] Result<std::string> read_file(const std::string& path);

/// Request of a user: a scenario file (empty: none) and settings by schema key, in the order given.
struct Request {
  std::string scenario_file;
  std::vector<std::pair<std::string, std::string>> settings;
  std::string speed_mps{};            ///< reference of whichever controller drives; empty: its own
  std::vector<std::string> faults{};  ///< NAME@S+S*X (schema_json.hpp), added to the scenario file's
  std::string speed_mph{};  ///< speed_mps as a user typed it in mph, for messages; empty: it was in m/s
};

/// The experiment asked for. Later layers win: defaults, car file, preset (with the presets it builds on),
/// scenario file, settings, speed. The names `preset`, `car` and `track` may be files, relative to the
/// working directory or to the scenario file. All faults at once, each with its file and line. Its
/// notices are the warnings of the track's reader, and settings that have no effect.
[[nodiscard]] Result<scenario::Scenario> compose(const Request& request);

/// Presets, cars, scenarios and names of tracks, read once for many compositions: to read them takes a
/// quarter of a millisecond, a tenth of a short run. What changes on the disk later is not seen. Keeps up to
/// kMost of them; failures are not kept. One thread.
class RememberedFiles {
 public:
  static constexpr std::size_t kMost = 64;

  /// The document of a name on a shelf; `read` is asked for one that is not known yet.
  [[nodiscard]] Result<Document> document(Shelf shelf, const std::string& name,
                                          const std::function<Result<Document>()>& read);

 private:
  std::map<std::pair<Shelf, std::string>, Document> documents_;
};

/// Same as compose(request), but takes files from `files` first, then from disk.
[[nodiscard]] Result<scenario::Scenario> compose(const Request& request, RememberedFiles& files);

}  // namespace chicane::protocol
