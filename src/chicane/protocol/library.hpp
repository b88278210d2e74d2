// SPDX-License-Identifier: MIT
// Shipped files by name, and the scenario that a user asks for, composed from them.
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

/// Shipped files are presets, cars, tracks and scenarios. A name is searched in the folders of
/// data_folders.hpp, and the first file of that name is taken. The functions store nothing between calls: any
/// thread may call them.
namespace chicane::protocol {

/// Kind of shipped files.
enum class Shelf { kPreset, kCar, kTrack, kScenario };

/// File on a shelf.
struct Entry {
  std::string name;         ///< file name without its extension
  std::string file;         ///< path
  std::string description;  ///< the first comment line of the file
};

/// Entries of a shelf, sorted by name, each name once.
[[nodiscard]] std::vector<Entry> entries(Shelf shelf);

/// Checks that a shelf has an entry. Fails with kNotFound, which names each folder that was searched:
/// "preset: found no presets in ./presets, /usr/share/chicane/presets; set CHICANE_DATA_DIR to the folder
/// that holds the folder presets".
[[nodiscard]] Result<void> check_shelf(Shelf shelf);

/// Checks a name that comes over the network. Fails with kNotFound, "track: got ../x.csv, expected one of
/// lakeside,
/// ...", unless `name` is the name of an entry of the shelf; paths are refused. Opens no file of that name.
[[nodiscard]] Result<void> check_name(Shelf shelf, std::string_view name);

/// File of a name, or of a path if `name_or_file` has a slash or an extension. Fails with kNotFound: `preset:
/// got "dfault", expected one of default, ... (did you mean default?)`, or the message of check_shelf() where
/// there is nothing to choose from.
[[nodiscard]] Result<std::string> locate(Shelf shelf, std::string_view name_or_file);

/// Bytes of a file of at most 64 MiB. Fails with kNotFound if there is no such file, kIo with the system's
/// reason if it cannot be read.
[[nodiscard]] Result<std::string> read_file(const std::string& path);

/// Request of a user: a scenario file (empty: none) and settings by schema key, in the order given.
struct Request {
  std::string scenario_file;
  std::vector<std::pair<std::string, std::string>> settings;
  std::string speed_mps{};            ///< reference speed of the controller that drives; empty: its own
  std::vector<std::string> faults{};  ///< NAME@S+S*X (schema_json.hpp), added to the scenario file's
  std::string speed_mph{};  ///< text of speed_mps as typed in mph, for messages; empty: typed in m/s
};

/// Scenario of a request. Its layers, of which later ones override earlier ones: defaults, car file, preset
/// (with the presets that it builds on), scenario file, settings, speed. The names `preset`, `car` and
/// `track` may be files, relative to the working directory or to the scenario file. Fails with all faults at
/// once, each with its file and line. The scenario's notices are the warnings of the track's reader, and
/// settings that have no effect.
[[nodiscard]] Result<scenario::Scenario> compose(const Request& request);

/// Cache of presets, cars, scenarios and names of tracks for many compositions: reading them takes a quarter
/// of a millisecond, a tenth of a short run. Later changes on the disk have no effect. Failures are not
/// stored. One thread.
class RememberedFiles {
 public:
  static constexpr std::size_t kMost = 64;  ///< limit of documents; chosen: bounds memory

  /// Document of a name on a shelf; calls `read` for one that is not stored.
  [[nodiscard]] Result<Document> document(Shelf shelf, const std::string& name,
                                          const std::function<Result<Document>()>& read);

 private:
  std::map<std::pair<Shelf, std::string>, Document> documents_;
};

/// Same as compose(request), but takes files from `files` first, then from disk.
[[nodiscard]] Result<scenario::Scenario> compose(const Request& request, RememberedFiles& files);

}  // namespace chicane::protocol
