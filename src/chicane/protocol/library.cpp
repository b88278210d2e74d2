// SPDX-License-Identifier: MIT
// Shipped files by name, and the composition of a scenario: preset, car, track and settings in layers, with
// every fault of all of them.
#include "chicane/protocol/library.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <span>

#include "chicane/base/math.hpp"
#include "chicane/base/text.hpp"
#include "chicane/protocol/schema_json.hpp"
#include "chicane/protocol/track_codec.hpp"

namespace chicane::protocol {
namespace {

namespace fs = std::filesystem;

// Chosen: bounds memory, and ends a circle of presets.
constexpr std::uintmax_t kMostBytes = 64U << 20U;  // [byte] of a file
constexpr std::size_t kMostPresets = 8;            // presets that build on each other

/// Words and extensions of a shelf.
struct ShelfNames {
  std::string_view singular, folder;
  std::span<const std::string_view> extensions;
};
ShelfNames names(Shelf shelf) {
  static constexpr std::array<std::string_view, 1> kSettings{".yaml"};
  switch (shelf) {
    case Shelf::kPreset:
      return {"preset", "presets", kSettings};
    case Shelf::kCar:
      return {"car", "cars", kSettings};
    case Shelf::kTrack:
      return {"track", "tracks", track_extensions()};
    case Shelf::kScenario:
      break;
  }
  return {"scenario", "scenarios", kSettings};
}

std::vector<std::string> folders(Shelf shelf) { return data_folders(data_origins(), names(shelf).folder); }

/// First comment line of a file that describes it: neither licence nor CSV header; at most 200 bytes.
std::string first_comment(const fs::path& file) {
  std::ifstream stream(file);
  std::string line;
  for (int i = 0; i < 5 && std::getline(stream, line); ++i) {
    if (!line.starts_with("#") || line.find("SPDX") != std::string::npos ||
        line.find("x_m") != std::string::npos)
      continue;
    const std::size_t begin = line.find_first_not_of("# \t");
    const std::size_t end = line.find_last_not_of(" \t\r");
    if (begin != std::string::npos) return line.substr(begin, std::min<std::size_t>(end - begin + 1, 200));
  }
  return "";
}

/// Whether a name is a path: has a slash or an extension.
bool is_path(std::string_view name) {
  return name.find('/') != std::string_view::npos || !fs::path(name).extension().empty();
}

/// Message for an empty shelf: searched folders, and the remedy.
std::string nothing_found(Shelf shelf) {
  const std::string_view folder = names(shelf).folder;
  return fmt::format("found no {} in {}; set CHICANE_DATA_DIR to the folder that holds the folder {}", folder,
                     fmt::join(folders(shelf), ", "), folder);
}

/// Error of a name that is on no entry: `preset: got "dfault", expected a file or one of default, ... (did
/// you mean default?)`.
Error unknown_name(Shelf shelf, std::string_view name, const std::vector<Entry>& known,
                   std::string_view or_what) {
  const std::string got = fmt::format("{}: got \"{}\", expected ", names(shelf).singular, printable(name));
  if (known.empty()) return {ErrorCode::kNotFound, got + "a file that exists; " + nothing_found(shelf)};
  std::vector<std::string_view> known_names;
  known_names.reserve(known.size());
  for (const Entry& entry : known) known_names.push_back(entry.name);
  const std::string_view best = nearest(name, known_names);
  std::string hint = best.empty() ? "" : fmt::format(" (did you mean {}?)", best);
  for (const Shelf other : {Shelf::kTrack, Shelf::kCar, Shelf::kPreset}) {
    const std::vector<Entry> there = entries(other);
    const bool has_it =
        std::any_of(there.begin(), there.end(), [&](const Entry& each) { return each.name == name; });
    if (shelf == Shelf::kScenario && has_it)
      hint = fmt::format(" (did you mean --{} {}?)", names(other).singular, name);
  }
  if (const std::size_t equals = name.find('='); equals != std::string_view::npos) {  // a setting
    const std::string_view key = name.substr(0, equals), group_key = first_of(key);
    hint = fmt::format(" (did you mean --set {}{}?)", printable(group_key.empty() ? key : group_key),
                       printable(name.substr(equals)));
  }
  return {ErrorCode::kNotFound,
          fmt::format("{}{}one of {}{}", got, or_what, fmt::join(known_names, ", "), hint)};
}

/// Name of a file, and the position of that name for messages.
struct Reference {
  std::string name;
  std::string place{};  ///< "runs/wet.yaml:3: "; empty for the command line and for defaults
};

/// locate(), with the place in the error.
Result<std::string> locate(Shelf shelf, const Reference& reference) {
  Result<std::string> file = locate(shelf, reference.name);
  if (!file) return fail(file.error().code, reference.place + file.error().message);
  return file;
}

Result<Document> read_document(Shelf shelf, const Reference& reference, RememberedFiles& files) {
  return files.document(shelf, reference.name, [&]() -> Result<Document> {
    const Result<std::string> file = locate(shelf, reference);
    if (!file) return fail(file.error());
    const Result<std::string> text = read_file(*file);
    return text ? parse_document(*text, *file) : fail(text.error());
  });
}

/// Checks that a track exists. Its document has no settings.
Result<Document> find_track(const Reference& reference, RememberedFiles& files) {
  return files.document(Shelf::kTrack, reference.name, [&]() -> Result<Document> {
    const Result<std::string> file = locate(Shelf::kTrack, reference);
    if (!file) return fail(file.error());
    Document document;
    document.file = *file;
    return document;
  });
}

/// Reference by the last layer that sets `key`; `otherwise` if none does.
Reference last_reference(const std::vector<Document>& layers, std::string_view key,
                         const std::string& otherwise) {
  Reference found{otherwise};
  for (const Document& layer : layers) {
    for (const Assignment& assignment : layer.assignments) {
      if (assignment.parameter->key == key)
        found = {std::get<std::string>(assignment.value), place(layer.file, assignment.line)};
    }
  }
  return found;
}

bool is_set(const std::vector<Document>& layers, std::string_view key) {
  return std::any_of(layers.begin(), layers.end(), [&](const Document& layer) {
    return std::any_of(layer.assignments.begin(), layer.assignments.end(),
                       [&](const Assignment& assignment) { return assignment.parameter->key == key; });
  });
}

/// Collects the faults of independent steps, so that a user sees all of them at once.
class Faults {
 public:
  void add(const Error& error) {
    if (message_.empty()) code_ = error.code;
    message_ += (message_.empty() ? "" : "\n") + error.message;
  }
  [[nodiscard]] bool empty() const { return message_.empty(); }
  [[nodiscard]] tl::unexpected<Error> failure() const { return fail(code_, message_); }

 private:
  ErrorCode code_ = ErrorCode::kInvalidArgument;
  std::string message_;
};

/// Settings of a request as a layer; faults of values go to `faults`.
Document parse_settings(const Request& request, Faults& faults) {
  Document document;
  for (const auto& [key, text] : request.settings) {
    const Parameter* parameter = find(key);
    if (parameter == nullptr) continue;  // reported by refuse_unknown()
    scenario::Scenario scratch;
    if (const Result<void> checked = set_text(scratch, key, text); !checked) {
      faults.add(checked.error());
    } else if (key == "preset") {
      document.preset = text;
    } else {
      document.assignments.push_back({parameter, get(scratch, *parameter), 0});
    }
  }
  return document;
}

/// Refuses settings with unknown keys. Needs all files: only then the controller is known.
void refuse_unknown(const Request& request, std::string_view driver, Faults& faults) {
  for (const auto& [key, text] : request.settings) {
    if (find(key) == nullptr)
      faults.add({ErrorCode::kNotFound, fmt::format("{}: {}", printable(key), unknown_key(key, driver))});
  }
}

/// Adds a notice for each setting without effect: options of controllers that do not drive.
void note_idle(const Document& asked, scenario::Scenario& scenario) {
  for (const Assignment& assignment : asked.assignments) {
    const Parameter& parameter = *assignment.parameter;
    if (parameter.controller.empty() || parameter.controller == scenario.controller) continue;
    scenario.notices.push_back(fmt::format("{}{}: has no effect: {} drives, not {}",
                                           place(asked.file, assignment.line), parameter.key,
                                           scenario.controller, parameter.controller));
  }
}

/// Adds the assumptions of the road's reader as notices. Shipped tracks have the scale of the car; roads of
/// other files have their own size.
Result<void> note_track(bool is_asked_for, scenario::Scenario& scenario) {
  const double scale = scenario.vehicle.scale;
  if (!is_path(scenario.track)) {
    if (is_asked_for && scale != 1.0 && scenario.track_scale == 0.0)
      scenario.notices.push_back(
          fmt::format("track_scale: got none, so {} is driven at {:g} of its size, the scale of the car {}",
                      scenario.track, scale, scenario.car));
    return {};
  }
  if (scenario.track_scale != 0.0 && scenario.track_scale != 1.0)
    return fail(ErrorCode::kInvalidArgument,
                fmt::format("track_scale: got {:g} with the file {}, expected none: a file's road has the "
                            "size that its file says",
                            scenario.track_scale, scenario.track));
  if (scale != 1.0) scenario.track_scale = 1.0;
  const Result<std::string> file = locate(Shelf::kTrack, scenario.track);
  const Result<std::string> text = file ? read_file(*file) : fail(file.error());
  const auto content = text ? parse_track(*text, *file, {.scale = scenario.scale_of_file()})
                            : Result<TrackFile>{fail(text.error())};
  if (content)  // the run itself reports faults of the road
    scenario.notices.insert(scenario.notices.end(), content->warnings.begin(), content->warnings.end());
  return {};
}

/// Adds a notice if a race is planned with less friction than the model has.
void note_friction(scenario::Scenario& scenario) {
  const double friction = scenario.assumed_vehicle().friction;
  if (friction < scenario.vehicle.friction)
    scenario.notices.push_back(
        fmt::format("friction_low: the race is planned with a friction of {:.3g}, the least that is known of "
                    "the car; its model has {:.3g}",
                    friction, scenario.vehicle.friction));
}

/// Makes paths that are relative to the document's folder relative to the working directory.
void resolve_names(Document& document) {
  const fs::path folder = fs::path(document.file).parent_path();
  const auto resolve = [&](std::string& name) {
    std::error_code ignored;
    if (is_path(name) && !fs::exists(name, ignored) && fs::exists(folder / name, ignored))
      name = (folder / name).string();
  };
  if (document.preset) resolve(*document.preset);
  for (Assignment& assignment : document.assignments) {
    const std::string_view key = assignment.parameter->key;
    if (key == "car" || key == "track") resolve(std::get<std::string>(assignment.value));
  }
}

/// Preset `name` after the presets that it builds on.
std::vector<Document> read_presets(Reference name, RememberedFiles& files, Faults& faults) {
  std::vector<Document> presets;
  std::optional<Reference> next = std::move(name);
  while (next) {
    if (presets.size() == kMostPresets) {
      faults.add(
          {ErrorCode::kInvalidArgument,
           fmt::format("{}: preset: got more than {} presets that build on each other, expected an end",
                       presets.front().file, kMostPresets)});
      return {};
    }
    Result<Document> preset = read_document(Shelf::kPreset, *next, files);
    if (!preset) {
      faults.add(preset.error());
      return {};
    }
    resolve_names(*preset);
    next.reset();
    if (preset->preset) next = Reference{*preset->preset, place(preset->file, preset->preset_line)};
    presets.insert(presets.begin(), std::move(*preset));
  }
  return presets;
}

/// Settings of a car file; none if it cannot be read. A car file has settings of the car alone.
std::optional<Document> read_car(const Reference& reference, RememberedFiles& files, Faults& faults) {
  Result<Document> car = read_document(Shelf::kCar, reference, files);
  if (!car) {
    faults.add(car.error());
    return std::nullopt;
  }
  for (const Assignment& assignment : car->assignments) {
    const std::string_view key = assignment.parameter->key;
    if (key == "plant" || key.starts_with("vehicle.") || key.starts_with("plant_params.") ||
        key == "latency_ms" || key == "control_period_ms" || key == "friction_low")
      continue;
    faults.add({ErrorCode::kParse,
                fmt::format("{}:{}: {}: got a setting of a run, expected only plant, plant_params, vehicle, "
                            "latency_ms, control_period_ms and friction_low in a car file",
                            car->file, assignment.line, key)});
  }
  return std::move(*car);
}

}  // namespace

std::vector<Entry> entries(Shelf shelf) {
  std::map<std::string, Entry> found;
  for (const std::string& folder : folders(shelf)) {
    for (const std::string_view extension : names(shelf).extensions) {
      std::error_code error;
      for (fs::directory_iterator item(folder, error), end; !error && item != end; item.increment(error)) {
        if (item->path().extension() != extension) continue;
        const std::string name = item->path().stem().string();
        if (!found.contains(name)) found[name] = {name, item->path().string(), first_comment(item->path())};
      }
    }
  }
  std::vector<Entry> result;
  result.reserve(found.size());
  for (auto& [name, entry] : found) result.push_back(std::move(entry));
  return result;
}

Result<void> check_shelf(Shelf shelf) {
  if (!entries(shelf).empty()) return {};
  return fail(ErrorCode::kNotFound, fmt::format("{}: {}", names(shelf).singular, nothing_found(shelf)));
}

Result<void> check_name(Shelf shelf, std::string_view name) {
  const std::vector<Entry> known = entries(shelf);
  const auto is_it = [&](const Entry& entry) { return entry.name == name; };
  if (std::any_of(known.begin(), known.end(), is_it)) return {};
  return fail(unknown_name(shelf, name, known, ""));
}

Result<std::string> locate(Shelf shelf, std::string_view name_or_file) {
  const auto [singular, folder, extensions] = names(shelf);
  std::error_code ignored;
  if (is_path(name_or_file)) {
    if (fs::is_regular_file(fs::path(name_or_file), ignored)) return std::string(name_or_file);
    std::string message =
        fmt::format("{}: got {}, expected a file that exists", singular, printable(name_or_file));
    const std::string name = fs::path(name_or_file).stem().string();
    if (name_or_file.find('/') == std::string_view::npos && check_name(shelf, name))
      message += fmt::format(" (did you mean {}?)", name);
    return fail(ErrorCode::kNotFound, std::move(message));
  }
  for (const std::string& place : folders(shelf)) {
    for (const std::string_view extension : extensions) {
      const fs::path file = fs::path(place) / fmt::format("{}{}", name_or_file, extension);
      if (fs::is_regular_file(file, ignored)) return file.lexically_normal().string();
    }
  }
  return fail(unknown_name(shelf, name_or_file, entries(shelf), "a file or "));
}

Result<std::string> read_file(const std::string& path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) {
    const std::string_view got = fs::is_directory(path, error) ? "a folder" : "none";
    return fail(ErrorCode::kNotFound, fmt::format("{}: file: got {}, expected a file", path, got));
  }
  const std::uintmax_t size = fs::file_size(path, error);
  if (!error && size > kMostBytes) {
    return fail(ErrorCode::kParse,
                fmt::format("{}: file: got {} bytes, expected at most {}", path, size, kMostBytes));
  }
  errno = 0;
  std::ifstream stream(path, std::ios::binary);
  std::string text(error ? 0 : static_cast<std::size_t>(size), '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (!stream)
    return fail(ErrorCode::kIo,
                fmt::format("{}: file: {}", path, errno != 0 ? std::strerror(errno) : "cannot be read"));
  return text;
}

namespace {

/// Sets the reference speed of the controller that drives. Fails with kInvalidArgument, in the unit that the
/// user typed, if it has no such option or the speed is out of range.
Result<void> set_speed(const Request& request, scenario::Scenario& scenario) {
  const bool is_mph = !request.speed_mph.empty();
  const std::string_view key = is_mph ? "--speed-mph" : "--speed-mps";
  const std::string& typed = is_mph ? request.speed_mph : request.speed_mps;
  const auto* driver = controller::Registry::find(scenario.controller);
  if (driver->speed_option.empty())
    return fail(refusal(key, typed, fmt::format("none: {} has no speed to set", driver->name)));
  const Parameter& row = *find_option(driver->name, driver->speed_option);
  const Result<Value> value = parse(row, request.speed_mps);
  if (value) return set(scenario, row, *value);
  const auto in_unit = [is_mph](double mps) { return is_mph ? mps_to_mph(mps) : mps; };
  return fail(refusal(key, typed,
                      fmt::format("a number in [{:.4g}, {:.4g}] {}", in_unit(row.option.minimum),
                                  in_unit(row.option.maximum), is_mph ? "mph" : "m/s")));
}

}  // namespace

Result<scenario::Scenario> compose(const Request& request) {
  RememberedFiles none;
  return compose(request, none);
}

Result<scenario::Scenario> compose(const Request& request, RememberedFiles& files) {
  Faults faults;
  std::vector<Document> layers;
  Document settings = parse_settings(request, faults);
  const scenario::Scenario defaults;
  Reference preset{settings.preset.value_or(defaults.preset)};
  if (!request.scenario_file.empty()) {
    Result<Document> file = read_document(Shelf::kScenario, Reference{request.scenario_file}, files);
    if (!file) {
      faults.add(file.error());
    } else {
      resolve_names(*file);
      if (!settings.preset && file->preset) preset = {*file->preset, place(file->file, file->preset_line)};
      layers.push_back(std::move(*file));
    }
  }
  layers.push_back(std::move(settings));
  const std::size_t asked = layers.size();  // user's layers, without presets and car

  std::vector<Document> presets = read_presets(preset, files, faults);
  layers.insert(layers.begin(), std::make_move_iterator(presets.begin()),
                std::make_move_iterator(presets.end()));
  std::optional<Document> car = read_car(last_reference(layers, "car", defaults.car), files, faults);
  if (car) layers.insert(layers.begin(), std::move(*car));
  if (const auto track = find_track(last_reference(layers, "track", defaults.track), files); !track)
    faults.add(track.error());

  refuse_unknown(request, last_reference(layers, "controller", defaults.controller).name, faults);
  scenario::Scenario scenario;
  scenario.preset = preset.name;
  if (const Result<void> applied = apply_layers(layers, scenario); !applied) faults.add(applied.error());
  for (const std::string& text : request.faults) {
    const Result<sim::FaultEvent> event = parse_fault(text);
    if (event) scenario.faults.push_back(*event);
    if (!event) faults.add(event.error());
  }
  if (faults.empty() && !request.speed_mps.empty()) {
    if (const Result<void> done = set_speed(request, scenario); !done) faults.add(done.error());
  }
  if (!faults.empty()) return faults.failure();
  for (auto layer = layers.end() - static_cast<std::ptrdiff_t>(asked); layer != layers.end(); ++layer)
    note_idle(*layer, scenario);
  if (const Result<void> noted = note_track(is_set(layers, "track"), scenario); !noted)
    return fail(noted.error());
  note_friction(scenario);
  return scenario;
}

Result<Document> RememberedFiles::document(Shelf shelf, const std::string& name,
                                           const std::function<Result<Document>()>& read) {
  const auto known = documents_.find({shelf, name});
  if (known != documents_.end()) return known->second;
  Result<Document> document = read();
  if (!document) return document;
  if (documents_.size() == kMost) documents_.clear();
  documents_[{shelf, name}] = *document;
  return document;
}

}  // namespace chicane::protocol
