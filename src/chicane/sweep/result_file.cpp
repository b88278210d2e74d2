// SPDX-License-Identifier: MIT
// Files of results: lines of JSON, checked against the plan, completed after an interruption, and merged.
#include "chicane/sweep/result_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <optional>
#include <utility>

#include "chicane/base/file.hpp"
#include "chicane/base/instruction_set.hpp"
#include "chicane/base/text.hpp"
#include "chicane/sweep/trial.hpp"

namespace chicane::sweep {
namespace {

using protocol::Json;

constexpr std::size_t kLongestLine = 1U << 20U;  // [byte] bounds memory; chosen

/// Error of a failed write, from errno.
tl::unexpected<Error> io_failure(const std::string& path) {
  return fail(ErrorCode::kIo, fmt::format("{}: cannot be written: {}", path, std::strerror(errno)));
}

/// Number of the run of a line, 17 for `{"run":17,…}`; none for another line.
std::optional<std::uint64_t> run_of(const std::string& line) {
  constexpr std::string_view kBegin = "{\"run\":";
  if (!line.starts_with(kBegin) || !line.ends_with('}')) return std::nullopt;
  const std::size_t comma = line.find(',');
  if (comma == std::string::npos) return std::nullopt;
  const auto run = count_in(std::string_view(line).substr(kBegin.size(), comma - kBegin.size()));
  return run && *run < Plan::kMostRuns ? run : std::nullopt;
}

/// Wraps `on_line`: reads the number of the run from each line first. kParse for a line without one.
OnLine with_run_numbers(const OnLine& on_line) {
  return [on_line](LinePlace place, const std::string& line) -> Result<void> {
    const std::optional<std::uint64_t> run = run_of(line);
    if (!run)
      return fail(ErrorCode::kParse, fmt::format("got {}, expected the results of a run", printable(line)));
    place.run = *run;
    return on_line(place, line);
  };
}

/// Reads the lines of runs. `on_first` gets the first line; an empty text if the file has no complete line.
Result<void> read_results(const std::string& file,
                          const std::function<Result<void>(const std::string&)>& on_first,
                          const OnLine& on_run) {
  const auto contents = read_text_lines(file, on_first, with_run_numbers(on_run));
  if (contents && contents->header.empty()) return on_first("");
  return contents ? Result<void>{} : fail(contents.error());
}

/// Reason why the results of two different first lines do not belong together: "the plan 12, expected 17".
std::string difference_text(const Header& got, const Header& expected) {
  static constexpr std::pair<std::string_view, std::string Header::*> kParts[] = {
      {"the plan", &Header::plan},
      {"the program", &Header::program},
      {"the arithmetic", &Header::arithmetic},
      {"the guard", &Header::guard},
      {"presets, cars or tracks of other contents,", &Header::files}};
  for (const auto& [what, part] : kParts)
    if (got.*part != expected.*part)
      return fmt::format("{} {}, expected {}", what, got.*part, expected.*part);
  return "another first line, expected the same";
}

}  // namespace

Json json_of(const Settings& settings) {
  Json json = Json::object();
  for (const auto& [key, text] : settings) json[key] = text;
  return json;
}

Settings settings_in(const Json& json) {
  Settings settings;
  for (const auto& [key, text] : json.items()) settings.emplace_back(key, text);
  return settings;
}

std::string plain_text(const Json& value) {
  return value.is_string() ? value.get<std::string>() : protocol::json_text(value);
}

std::string header_of(const Plan& plan) {
  std::vector<std::string> kept = plan.keep;
  if (kept.empty())
    for (const Column& column : columns()) kept.emplace_back(column.name);
  if (plan.search) kept.insert(kept.begin(), {std::string(kSearchValue), std::string(kSearchTrials)});
  Json header{{"sweep", plan.name},
              {"plan", fmt::format("{:016x}", plan.hash())},
              {"runs", plan.size()},
              {"settings", json_of(plan.fixed)},
              {"axes", plan.keys()},
              {"columns", kept},
              {"program", program_name()},
              {"guard", {{"version", safety::kGuardVersion}}},
              {"arithmetic", arithmetic(chosen_instruction_set())},
              {"files", plan.digest_of_files()}};
  if (plan.search) header["search"] = plan.search->key;
  for (const Settings& mark : plan.marks) header["marks"].push_back(json_of(mark));
  for (const auto& [key, names] : plan.cases())
    for (const auto& [name, settings] : names) header["cases"][key][name] = json_of(settings);
  return protocol::json_text(header);
}

Result<Header> parse_header(std::string_view line, const std::string& file) {
  try {
    const Json json = protocol::parse_json(line);
    Header header{.name = json.at("sweep"),
                  .plan = json.at("plan"),
                  .program = json.at("program"),
                  .arithmetic = json.at("arithmetic"),
                  .guard = protocol::json_text(json.value("guard", Json())),
                  .files = json.value("files", ""),
                  .runs = json.at("runs")};
    header.fixed = settings_in(json.at("settings"));
    header.search_key = json.value("search", "");
    if (json.contains("marks"))
      for (const Json& mark : json["marks"]) header.marks.push_back(settings_in(mark));
    if (json.contains("cases"))
      for (const auto& [key, names] : json["cases"].items())
        for (const auto& [name, settings] : names.items()) header.cases[key][name] = settings_in(settings);
    header.keys = json.at("axes").get<std::vector<std::string>>();
    header.columns = json.at("columns").get<std::vector<std::string>>();
    if (header.runs <= Plan::kMostRuns) return header;
  } catch (const Json::exception&) {
    // reported below, as a line of too many runs is
  }
  return fail(refusal(file + ":1", line, "the first line of a sweep's results", ErrorCode::kParse));
}

Result<FileContents> read_text_lines(const std::string& file,
                                     const std::function<Result<void>(const std::string&)>& on_first,
                                     const OnLine& on_line) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return fail(ErrorCode::kNotFound, fmt::format("{}: {}", file, std::strerror(errno)));
  FileContents contents;
  std::string line;
  for (std::uint64_t number = 1; std::getline(stream, line) && !stream.eof(); ++number) {
    const LinePlace place{0, contents.complete_bytes, line.size()};
    contents.complete_bytes += line.size() + 1;
    const auto located = [&](const Error& error) {
      return fail(error.code, fmt::format("{}:{}: {}", file, number, error.message));
    };
    if (line.size() > kLongestLine)
      return located({ErrorCode::kParse, fmt::format("got {}, expected a shorter line", printable(line))});
    if (number == 1) {
      contents.header = line;
      if (const Result<void> taken = on_first(line); !taken) return fail(taken.error());
    } else if (const Result<void> taken = on_line(place, line); !taken) {
      return located(taken.error());
    }
  }
  if (stream.bad()) return fail(ErrorCode::kIo, fmt::format("{}: {}", file, std::strerror(errno)));
  return contents;
}

Result<void> read_runs(const std::string& file, const std::function<Result<void>(const Header&)>& on_header,
                       const std::function<Result<void>(std::uint64_t, const Json&)>& on_run) {
  const auto take_header = [&](const std::string& first) -> Result<void> {
    const Result<Header> header = parse_header(first, file);
    return header ? on_header(*header) : fail(header.error());
  };
  const auto take_run = [&](const LinePlace& place, const std::string& line) -> Result<void> {
    const Json run = protocol::parse_json(line);
    return run.is_object() ? on_run(place.run, run) : fail(ErrorCode::kParse, "got no JSON object");
  };
  return read_results(file, take_header, take_run);
}

LineFile::LineFile(LineFile&& other) noexcept { *this = std::move(other); }

LineFile& LineFile::operator=(LineFile&& other) noexcept {
  path_.swap(other.path_);
  std::swap(descriptor_, other.descriptor_);
  std::swap(size_, other.size_);
  return *this;
}

LineFile::~LineFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

Result<LineFile> LineFile::open(const std::string& path, const std::string& first,
                                const std::function<Error(const std::string&)>& refuse,
                                const OnLine& on_line) {
  LineFile file;
  file.path_ = path;
  file.descriptor_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (file.descriptor_ < 0) return io_failure(path);
  if (::flock(file.descriptor_, LOCK_EX | LOCK_NB) != 0)
    return fail(ErrorCode::kIo, fmt::format("{}: another process writes it", path));
  const auto check = [&](const std::string& line) {
    return line == first ? Result<void>{} : fail(refuse(line));
  };
  const auto contents = read_text_lines(path, check, on_line);
  if (!contents) return fail(contents.error());
  file.size_ = contents->complete_bytes;
  if (::ftruncate(file.descriptor_, static_cast<off_t>(file.size_)) != 0) return io_failure(path);
  if (file.size_ > 0) return file;
  if (const Result<void> written = file.append(first); !written) return fail(written.error());
  return file;
}

Result<void> LineFile::append(std::string_view line) {
  if (descriptor_ < 0) return {};
  std::string bytes(line);
  bytes += '\n';
  const std::lock_guard lock(mutex_);
  if (write_all(descriptor_, bytes)) {
    size_ += bytes.size();
    return {};
  }
  const int reason = errno;
  // Removes the part that was written. The failed write is reported, not a failure here; `!` uses the result,
  // as ftruncate() demands.
  static_cast<void>(!::ftruncate(descriptor_, static_cast<off_t>(size_)));
  errno = reason;
  return io_failure(path_);
}

Result<ResultFile> ResultFile::open(const std::string& path, const Plan& plan, const run::Shard& shard) {
  const std::string header = header_of(plan);
  ResultFile file(shard, plan.size());
  const auto refuse = [&](const std::string& first) {
    const Result<Header> got = parse_header(first, path);
    return got ? Error{ErrorCode::kInvalidArgument,
                       fmt::format("{}: got results of {}; choose another file", path,
                                   difference_text(*got, parse_header(header, path).value()))}
               : got.error();
  };
  const auto mark_done = [&](const LinePlace& line, const std::string&) -> Result<void> {
    if (line.run >= plan.size() || !shard.has(line.run))
      return fail(ErrorCode::kInvalidArgument,
                  fmt::format("got run {}, expected one of this shard", line.run));
    if (!file.done_[line.run / shard.count]) ++file.done_count_;
    file.done_[line.run / shard.count] = true;
    return {};
  };
  Result<LineFile> lines = LineFile::open(path, header, refuse, with_run_numbers(mark_done));
  if (!lines) return fail(lines.error());
  file.file_ = std::move(*lines);
  return file;
}

namespace {

// Most missing runs that are kept by number; the rest is only counted. Bounds memory; chosen.
constexpr std::size_t kMostNamed = 10000;
constexpr std::size_t kMostRanges = 10;  // ranges of missing runs in the message: some lines; chosen

/// Place of a run's line in the merged files, in 16 bytes: there may be 1e9 runs (Plan::kMostRuns).
struct Found {
  std::uint32_t file = 0;    ///< index of the file
  std::uint32_t size = 0;    ///< size of the line [byte]; 0: not found
  std::uint64_t offset = 0;  ///< begin of the line [byte]
};

/// Merges files of shards: finds the line of each run, then copies the lines in the order of the runs.
class Merger {
 public:
  explicit Merger(const std::vector<std::string>& files) : files_{files} {
    streams_.reserve(files.size());
    for (const std::string& file : files) streams_.emplace_back(file, std::ios::binary);
  }

  /// Finds the lines of all runs. Fails if one is missing, or has two different results.
  Result<void> read() {
    for (std::size_t i = 0; i < files_.size(); ++i)
      if (const Result<void> done = read(static_cast<std::uint32_t>(i)); !done) return done;
    return check_complete();
  }

  /// Writes the first line and the lines of all runs.
  Result<MergeSummary> write(const std::string& output) {
    FileWriter out(output);
    out.write(header_ + '\n');
    for (const Found& each : found_) {
      const Result<std::string> text = line(each);
      if (!text) return fail(text.error());
      out.write(*text + '\n');
    }
    if (const Result<void> written = out.finish(); !written) return fail(written.error());
    return MergeSummary{.runs = found_.size(), .repeated = repeated_};
  }

 private:
  /// Finds the lines of one file.
  Result<void> read(std::uint32_t index) {
    const std::string& file = files_[index];
    if (!streams_[index]) return fail(refusal(file + ": file", "none", "a file"));
    const auto check_header = [&](const std::string& first) -> Result<void> {
      const Result<Header> header = parse_header(first, file);
      if (!header) return fail(header.error());
      if (index == 0) {
        header_ = first;
        found_.resize(header->runs);
      } else if (first != header_) {
        return fail(
            ErrorCode::kInvalidArgument,
            fmt::format("{}: got {} as in {}", file,
                        difference_text(*header, parse_header(header_, files_[0]).value()), files_[0]));
      }
      return {};
    };
    return read_results(file, check_header, [&](const LinePlace& place, const std::string& text) {
      return record(place, text, index);
    });
  }

  /// Keeps the place of a line; compares the text with an earlier line of the same run.
  Result<void> record(const LinePlace& place, const std::string& text, std::uint32_t index) {
    if (place.run >= found_.size())
      return fail(ErrorCode::kParse, fmt::format("got run {}, expected one of {}", place.run, found_.size()));
    Found& known = found_[place.run];
    if (known.size == 0) {
      // The size fits: read_text_lines() refuses lines of more than kLongestLine.
      known = {index, static_cast<std::uint32_t>(place.size), place.offset};
      return {};
    }
    ++repeated_;
    const Result<std::string> earlier = line(known);
    if (!earlier) return fail(earlier.error());
    if (*earlier == text) return {};
    return fail(ErrorCode::kInvalidArgument,
                fmt::format("got other results of run {} than {} has: they were driven with other files or "
                            "another build",
                            place.run, files_[known.file]));
  }

  /// Text of a line that was found. kIo if the file has no such bytes: it is a pipe, or has become shorter.
  Result<std::string> line(const Found& place) {
    std::string text(place.size, '\0');
    std::ifstream& stream = streams_[place.file];
    stream.clear();
    stream.seekg(static_cast<std::streamoff>(place.offset));
    if (stream.read(text.data(), static_cast<std::streamsize>(text.size()))) return text;
    return fail(ErrorCode::kIo, fmt::format("{}: cannot be read a second time", files_[place.file]));
  }

  /// Fails with the numbers of the missing runs, if there are any.
  [[nodiscard]] Result<void> check_complete() const {
    std::vector<std::uint64_t> missing;
    std::uint64_t count = 0;
    for (std::uint64_t run = 0; run < found_.size(); ++run)
      if (found_[run].size == 0 && count++ < kMostNamed) missing.push_back(run);
    if (missing.empty()) return {};
    return fail(ErrorCode::kInvalidArgument,
                fmt::format("{} of {} runs are missing: {}; the same sweep command drives them", count,
                            found_.size(), ranges_text(missing, count - missing.size())));
  }

  const std::vector<std::string>& files_;
  std::vector<std::ifstream> streams_;
  std::string header_;          ///< first line of the first file
  std::vector<Found> found_;    ///< by run
  std::uint64_t repeated_ = 0;  ///< runs found a second time
};

}  // namespace

std::string ranges_text(const std::vector<std::uint64_t>& numbers, std::uint64_t more) {
  std::string text;
  std::size_t ranges = 0;
  std::size_t i = 0;
  while (i < numbers.size() && ranges < kMostRanges) {
    std::size_t end = i;
    while (end + 1 < numbers.size() && numbers[end + 1] == numbers[end] + 1) ++end;
    if (ranges++ > 0) text += ", ";
    text += end == i ? fmt::format("{}", numbers[i]) : fmt::format("{}-{}", numbers[i], numbers[end]);
    i = end + 1;
  }
  more += numbers.size() - i;
  return more > 0 ? fmt::format("{} and {} more", text, more) : text;
}

Result<MergeSummary> merge(const std::vector<std::string>& files, const std::string& output) {
  Merger merger(files);
  if (const Result<void> read = merger.read(); !read) return fail(read.error());
  return merger.write(output);
}

}  // namespace chicane::sweep
