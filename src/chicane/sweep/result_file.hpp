// SPDX-License-Identifier: MIT
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

/// The file of a sweep: one JSON object in each line, the first about plan and program, each further about
/// one run, `{"run":17,…}`, in the order in which they ended.
namespace chicane::sweep {

/// Name of this program, "chicane 0.3.0 (1f0c5e8a9b27)": the version, and a digest of the sources that runs
/// can depend on.
[[nodiscard]] std::string program_name();

/// Settings as an object of texts, and back. Throws Json::exception for another value.
[[nodiscard]] protocol::Json json_of(const Settings& settings);
[[nodiscard]] Settings settings_in(const protocol::Json& json);
/// A text without quotes, any other value as JSON.
[[nodiscard]] std::string plain_text(const protocol::Json& value);

/// First line, without its line break: results with the same line belong together.
[[nodiscard]] std::string header_of(const Plan& plan);

/// Content of the first line.
struct Header {
  std::string name{}, plan{}, program{}, arithmetic{};
  std::string files{};  ///< Plan::digest_of_files()
  std::uint64_t runs = 0;
  Settings fixed{};
  std::vector<std::string> keys{}, columns{};
  Cases cases{};  ///< settings of each named case
  std::vector<Settings> marks{};
  std::string search_key{};  ///< key whose largest clean value each run has searched; empty: none
};
[[nodiscard]] Result<Header> parse_header(std::string_view line, const std::string& file);

/// Why results of two different first lines do not belong together: "the plan 12, expected 17".
[[nodiscard]] std::string difference_text(const Header& got, const Header& expected);

/// Place of a line in its file.
struct LinePlace {
  std::uint64_t run = 0;
  std::uint64_t offset = 0;  ///< [byte]
  std::uint64_t size = 0;    ///< size without the line break [byte]
};
/// Contents found by reading a file.
struct FileContents {
  std::string header;
  std::uint64_t whole = 0;  ///< bytes of complete lines
};
/// Reads a file line by line; memory does not grow with it. `on_first` gets the first line, `on_line` each
/// further one. A last line without its line break, which a killed process has left, is skipped. An error of
/// `on_line` gets "FILE:LINE: " in front, an error of `on_first` nothing. kParse for a line of more than 1
/// MiB; kIo.
[[nodiscard]] Result<FileContents> read_text_lines(
    const std::string& file, const std::function<Result<void>(const std::string&)>& on_first,
    const std::function<Result<void>(const LinePlace&, const std::string&)>& on_line);
/// Reads the lines about runs as JSON objects, after the header. kParse "FILE:LINE: …" for a line that is
/// none; otherwise fails as read_text_lines() does.
[[nodiscard]] Result<void> read_runs(
    const std::string& file, const std::function<Result<void>(const Header&)>& on_header,
    const std::function<Result<void>(std::uint64_t run, const protocol::Json&)>& on_run);

/// File that grows by lines; the first line identifies the rest. One process writes it. Each line is written
/// by one call, whole or not at all.
class LineFile {
 public:
  /// No file: append() does nothing.
  LineFile() = default;
  /// Opens the file, or makes it with the first line `first`, and removes half a line at its end. `refuse`:
  /// the error for a file with another first line, which stays as it is; `on_line` gets the others, as in
  /// read_text_lines(). kIo, also when another process writes it.
  [[nodiscard]] static Result<LineFile> open(
      const std::string& path, const std::string& first,
      const std::function<Error(const std::string&)>& refuse,
      const std::function<Result<void>(const LinePlace&, const std::string&)>& on_line);
  LineFile(LineFile&& other) noexcept;
  LineFile& operator=(LineFile&& other) noexcept;
  ~LineFile();

  /// Appends a line. kIo, and the file is unchanged, if the disk is full or gone. Any thread.
  [[nodiscard]] Result<void> append(std::string_view line);

 private:
  std::string path_{};
  int descriptor_ = -1;
  std::uint64_t size_ = 0;  ///< [byte]
  std::mutex mutex_{};
};

/// Result file of one shard of a sweep, open for appending.
class ResultFile {
 public:
  /// Opens as LineFile::open() does, and finds out which runs of the shard are done. kInvalidArgument if it
  /// belongs to another plan or program.
  [[nodiscard]] static Result<ResultFile> open(const std::string& path, const Plan& plan,
                                               const run::Shard& shard);

  [[nodiscard]] bool has(std::uint64_t run) const { return done_[run / shard_.count]; }
  /// Runs that were there when it was opened.
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

struct MergeSummary {
  std::uint64_t runs = 0;
  std::uint64_t repeated = 0;  ///< runs that came twice, with the same results
};

/// Joins the files of a sweep's shards, in whatever order and however many, into `output`: the first line,
/// then one line for each run in the order of the plan, the same bytes whichever process drove which run.
/// `output` appears whole or not at all, and may be one of the files.
///
/// kInvalidArgument for files of different plans or programs, for missing runs, which are named, and for a
/// run with two different results; kParse for lines that are none; kIo.
[[nodiscard]] Result<MergeSummary> merge(const std::vector<std::string>& files, const std::string& output);

/// Rising numbers as ranges: "17-20, 33 and 5 more".
[[nodiscard]] std::string ranges_text(const std::vector<std::uint64_t>& numbers, std::uint64_t more = 0);

}  // namespace chicane::sweep
