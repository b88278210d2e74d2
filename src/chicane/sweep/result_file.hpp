// SPDX-License-Identifier: MIT
// File of a sweep's results: one JSON object in each line. The first line describes plan and program, each
// further one a run, `{"run":17,…}`, in the order in which the runs ended.
#pragma once

#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/protocol/json.hpp"
#include "chicane/run/parallel.hpp"
#include "chicane/sweep/plan.hpp"

namespace chicane::sweep {

/// Name of this program, "chicane 0.3.0 (1f0c5e8a9b27)": its version, and a digest of all sources that can
/// change a run.
[[nodiscard]] std::string program_name();

/// Settings as a JSON object of texts.
[[nodiscard]] protocol::Json json_of(const Settings& settings);
/// Settings of such an object. Throws Json::exception for another value.
[[nodiscard]] Settings settings_in(const protocol::Json& json);
/// Value as text: a text without quotes, any other value as JSON.
[[nodiscard]] std::string plain_text(const protocol::Json& value);

/// First line of a plan's results, without its line break. Files with equal first lines belong together.
[[nodiscard]] std::string header_of(const Plan& plan);

/// Content of the first line.
struct Header {
  std::string name{}, plan{};  ///< name of the plan, and Plan::hash()
  /// program_name(), the arithmetic of its instruction set, and its guard as JSON: `{"version":3}`.
  std::string program{}, arithmetic{}, guard{};
  std::string files{};                         ///< Plan::digest_of_files()
  std::uint64_t runs = 0;                      ///< Plan::size()
  Settings fixed{};                            ///< settings of all runs
  std::vector<std::string> keys{}, columns{};  ///< keys of the axes, and names of the columns
  Cases cases{};
  std::vector<Settings> marks{};
  std::string search_key{};  ///< key whose largest clean value each run searches; empty: no search
};
/// Reads a first line; `file` is for messages. kParse.
[[nodiscard]] Result<Header> parse_header(std::string_view line, const std::string& file);

/// Place of a line in its file.
struct LinePlace {
  std::uint64_t run = 0;     ///< number of its run; 0 for a line without
  std::uint64_t offset = 0;  ///< begin [byte]
  std::uint64_t size = 0;    ///< size without the line break [byte]
};
/// Function that takes a line of a file, without its line break.
using OnLine = std::function<Result<void>(const LinePlace&, const std::string&)>;

/// What reading a file has found.
struct FileContents {
  std::string header;                ///< first line; empty: none is complete
  std::uint64_t complete_bytes = 0;  ///< size of all complete lines [byte]
};
/// Reads a file line by line; memory does not grow with the file. `on_first` gets the first line, `on_line`
/// each further one. Skips a last line without line break, which a killed process has left. Errors of
/// `on_line` get "FILE:LINE: " in front, errors of `on_first` are passed on. kParse for a line of more than 1
/// MiB; kIo.
[[nodiscard]] Result<FileContents> read_text_lines(
    const std::string& file, const std::function<Result<void>(const std::string&)>& on_first,
    const OnLine& on_line);
/// Reads a file of results: the header, then the lines of runs as JSON objects. kParse "FILE:LINE: …" for a
/// line that is none; otherwise fails as read_text_lines() does.
[[nodiscard]] Result<void> read_runs(
    const std::string& file, const std::function<Result<void>(const Header&)>& on_header,
    const std::function<Result<void>(std::uint64_t run, const protocol::Json&)>& on_run);

/// File that grows by lines, and whose first line identifies it. Only one process at a time writes it. Each
/// line is written by one call, whole or not at all.
class LineFile {
 public:
  /// Makes an object without a file: append() does nothing.
  LineFile() = default;
  /// Opens the file, or makes it with the first line `first`, and removes an incomplete line at its end. A
  /// file with another first line stays as it is, and fails with the error of `refuse`. `on_line` gets the
  /// further lines, as in read_text_lines(). kIo, also if another process writes the file.
  [[nodiscard]] static Result<LineFile> open(const std::string& path, const std::string& first,
                                             const std::function<Error(const std::string&)>& refuse,
                                             const OnLine& on_line);
  LineFile(LineFile&& other) noexcept;
  LineFile& operator=(LineFile&& other) noexcept;
  ~LineFile();

  /// Appends a line; `line` has no line break. Any thread. kIo if the disk is full or gone: the file is then
  /// unchanged.
  [[nodiscard]] Result<void> append(std::string_view line);

 private:
  std::string path_{};
  int descriptor_ = -1;     ///< of the open file; -1: none
  std::uint64_t size_ = 0;  ///< size of the file [byte]
  std::mutex mutex_{};      ///< guards the file and size_; stays when an object is moved
};

/// Result file of one shard of a sweep, open for appending.
class ResultFile {
 public:
  /// Opens the file as LineFile::open() does, and finds the runs that are done. kInvalidArgument for the file
  /// of another plan, program or shard.
  [[nodiscard]] static Result<ResultFile> open(const std::string& path, const Plan& plan,
                                               const run::Shard& shard);

  /// Whether the file had the run when it was opened. Pre: a run of the shard.
  [[nodiscard]] bool has(std::uint64_t run) const { return done_[run / shard_.count]; }
  /// Number of runs in the file when it was opened.
  [[nodiscard]] std::uint64_t done() const noexcept { return done_count_; }
  /// Appends as LineFile::append() does.
  [[nodiscard]] Result<void> append(std::string_view line) { return file_.append(line); }

 private:
  ResultFile(const run::Shard& shard, std::uint64_t runs) : shard_{shard}, done_(shard.size(runs), false) {}

  LineFile file_{};
  run::Shard shard_;
  std::vector<bool> done_;  ///< done runs by their place in the shard
  std::uint64_t done_count_ = 0;
};

/// Result of merge().
struct MergeSummary {
  std::uint64_t runs = 0;
  std::uint64_t repeated = 0;  ///< runs found a second time, with the same results
};

/// Joins the files of a sweep's shards into `output`: the first line, then one line for each run in the order
/// of the plan. The bytes do not depend on the number of shards or on their order. `output` appears whole or
/// not at all, and may be one of the files.
///
/// kInvalidArgument for files of different plans or programs, for missing runs, which the message names, and
/// for a run with two different results; kParse for lines that are no results; kIo, also for a pipe among the
/// files, since lines are read twice.
[[nodiscard]] Result<MergeSummary> merge(const std::vector<std::string>& files, const std::string& output);

/// Rising numbers as ranges: "17-20, 33 and 5 more". `more`: numbers that are only counted.
[[nodiscard]] std::string ranges_text(const std::vector<std::uint64_t>& numbers, std::uint64_t more = 0);

}  // namespace chicane::sweep
