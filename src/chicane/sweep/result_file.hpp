// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/sweep/plan.hpp"
#include "chicane/sweep/shard.hpp"

/// The file of a sweep: one JSON object in each line, the first about plan and program, each further about
/// one run, `{"run":17,…}`, in the order in which they ended.
namespace chicane::sweep {

/// "chicane 0.2.0 (1f0c5e8a9b27)": the version, and a digest of the sources that runs can depend on.
[[nodiscard]] std::string program_name();

/// The first line, without its line break: what has to agree for results to belong together.
[[nodiscard]] std::string header_of(const Plan& plan);

/// What the first line says.
struct Header {
  std::string name{}, plan{}, program{}, arithmetic{};
  std::string files{};  ///< detail::digest_of_files()
  std::uint64_t runs = 0;
  Settings fixed{};
  std::vector<std::string> keys{}, columns{};
  Cases cases{};  ///< what names among the values of the keys stand for
  std::vector<Settings> marks{};
  std::string search_key{};  ///< whose largest clean value each run has looked for; empty: none
};
[[nodiscard]] Result<Header> parse_header(std::string_view line, const std::string& file);

/// Why results of two different first lines do not belong together: "the plan 12, expected 17".
[[nodiscard]] std::string difference_text(const Header& got, const Header& expected);

/// Where a line stands in its file.
struct LinePlace {
  std::uint64_t run = 0;
  std::uint64_t offset = 0;  ///< [byte]
  std::uint64_t size = 0;    ///< without the line break [byte]
};
/// What reading a file has found.
struct FileContents {
  std::string header;
  std::uint64_t whole = 0;  ///< bytes up to the last line break
  std::uint64_t lines = 0;  ///< about runs
};
/// Reads a file line by line; memory does not grow with it. A last line without its line break, which a
/// killed process has left, is not told. kParse "FILE:LINE: …" for a line that is none of ours; kIo.
[[nodiscard]] Result<FileContents> read_lines(
    const std::string& file,
    const std::function<Result<void>(const LinePlace&, const std::string&)>& on_line);

/// A file that a sweep appends to. Each line is written by one call, whole or not at all.
class ResultFile {
 public:
  /// Opens or makes the file, removes half a line at its end, and finds out which runs of the shard are done.
  /// kInvalidArgument when it belongs to another plan or program, or another process writes it; kIo.
  [[nodiscard]] static Result<ResultFile> open(const std::string& path, const Plan& plan, const Shard& shard);
  ResultFile(ResultFile&& other) noexcept;
  ResultFile& operator=(ResultFile&&) = delete;
  ~ResultFile();

  [[nodiscard]] bool has(std::uint64_t run) const { return done_[run / shard_.count]; }
  /// Runs that were there when it was opened.
  [[nodiscard]] std::uint64_t done() const noexcept { return done_count_; }
  /// Any thread. kIo, and the file is as before, when the disk is full or gone.
  [[nodiscard]] Result<void> append(std::string_view line);

 private:
  ResultFile(std::string path, int descriptor, const Shard& shard, std::uint64_t runs);

  std::string path_;
  int descriptor_;
  Shard shard_;
  std::vector<bool> done_;  ///< by the place in the shard
  std::uint64_t done_count_ = 0;
  std::uint64_t size_ = 0;  ///< [byte]
  std::mutex mutex_;
};

}  // namespace chicane::sweep
