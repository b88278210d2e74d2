// SPDX-License-Identifier: MIT
#include "chicane/sweep/merge.hpp"

#include <fmt/format.h>

#include <fstream>

#include "chicane/base/file.hpp"
#include "chicane/sweep/result_file.hpp"

namespace chicane::sweep {
namespace {

constexpr std::size_t kMostNamed = 10000;  // missing runs that are looked at for a message
constexpr std::size_t kMostRanges = 10;

/// Where each run stands: 16 bytes for each, whatever is known of it.
struct Found {
  std::uint32_t file = 0;
  std::uint32_t size = 0;  ///< 0: not found
  std::uint64_t offset = 0;
};

class Merger {
 public:
  explicit Merger(const std::vector<std::string>& files) : files_{files} {
    streams_.reserve(files.size());
    for (const std::string& file : files) streams_.emplace_back(file, std::ios::binary);
  }

  Result<void> read() {
    for (std::size_t i = 0; i < files_.size(); ++i)
      if (const Result<void> done = read(static_cast<std::uint32_t>(i)); !done) return done;
    return check_complete();
  }

  Result<MergeSummary> write(const std::string& output) {
    FileWriter out(output);
    out.write(header_ + '\n');
    for (const Found& each : found_) out.write(line(each) + '\n');
    if (const Result<void> written = out.finish(); !written) return fail(written.error());
    return MergeSummary{.runs = found_.size(), .repeated = repeated_};
  }

 private:
  Result<void> read(std::uint32_t index) {
    const std::string& file = files_[index];
    std::string first;
    std::getline(streams_[index], first);
    const Result<Header> header = parse_header(first, file);
    if (!header) return fail(header.error());
    if (index == 0) {
      header_ = first;
      found_.resize(header->runs);
    } else if (first != header_) {
      return fail(ErrorCode::kInvalidArgument,
                  fmt::format("{}: got {} as in {}", file,
                              difference_text(*header, parse_header(header_, files_[0]).value()), files_[0]));
    }
    const auto contents = read_lines(
        file, [&](const LinePlace& place, const std::string& text) { return take(place, text, index); });
    return contents ? Result<void>{} : fail(contents.error());
  }

  Result<void> take(const LinePlace& place, const std::string& text, std::uint32_t index) {
    if (place.run >= found_.size())
      return fail(ErrorCode::kParse, fmt::format("got run {}, expected one of {}", place.run, found_.size()));
    Found& known = found_[place.run];
    if (known.size == 0) {
      known = {index, static_cast<std::uint32_t>(place.size), place.offset};
      return {};
    }
    ++repeated_;
    if (line(known) == text) return {};
    return fail(ErrorCode::kInvalidArgument,
                fmt::format("got other results of run {} than {} has: they were driven with other files or "
                            "another build",
                            place.run, files_[known.file]));
  }

  std::string line(const Found& place) {
    std::string text(place.size, '\0');
    std::ifstream& stream = streams_[place.file];
    stream.clear();
    stream.seekg(static_cast<std::streamoff>(place.offset));
    stream.read(text.data(), static_cast<std::streamsize>(text.size()));
    return text;
  }

  [[nodiscard]] Result<void> check_complete() const {
    std::vector<std::uint64_t> missing;
    std::uint64_t more = 0;
    for (std::uint64_t run = 0; run < found_.size(); ++run) {
      if (found_[run].size != 0) continue;
      if (missing.size() < kMostNamed) {
        missing.push_back(run);
      } else {
        ++more;
      }
    }
    if (missing.empty()) return {};
    return fail(ErrorCode::kInvalidArgument,
                fmt::format("{} of {} runs are missing: {}; the same sweep command drives them",
                            missing.size() + more, found_.size(), ranges_text(missing, more)));
  }

  const std::vector<std::string>& files_;
  std::vector<std::ifstream> streams_;
  std::string header_;
  std::vector<Found> found_;
  std::uint64_t repeated_ = 0;
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
