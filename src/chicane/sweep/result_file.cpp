// SPDX-License-Identifier: MIT
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
#include "chicane/protocol/json.hpp"
#include "chicane/sweep/detail/named_files.hpp"
#include "chicane/sweep/outcome.hpp"

namespace chicane::sweep {
namespace {

using protocol::Json;

constexpr std::size_t kLongestLine = 1U << 20U;

tl::unexpected<Error> io_failure(const std::string& path) {
  return fail(ErrorCode::kIo, fmt::format("{}: cannot be written: {}", path, std::strerror(errno)));
}

/// `17` of `{"run":17,…}`; none for anything else.
std::optional<std::uint64_t> run_of(const std::string& line) {
  constexpr std::string_view kBegin = "{\"run\":";
  if (!line.starts_with(kBegin) || !line.ends_with('}')) return std::nullopt;
  const std::size_t comma = line.find(',');
  if (comma == std::string::npos) return std::nullopt;
  const auto run = count_in(std::string_view(line).substr(kBegin.size(), comma - kBegin.size()));
  return run && *run < Plan::kMostRuns ? run : std::nullopt;
}

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

}  // namespace

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
              {"files", detail::digest_of_files(plan)}};
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
    // said below
  }
  return fail(refusal(file + ":1", line, "the first line of a sweep's results", ErrorCode::kParse));
}

std::string difference_text(const Header& got, const Header& expected) {
  const auto words = [](std::string_view what, const std::string& a, const std::string& b) {
    return fmt::format("{} {}, expected {}", what, a, b);
  };
  if (got.plan != expected.plan) return words("the plan", got.plan, expected.plan);
  if (got.program != expected.program) return words("the program", got.program, expected.program);
  if (got.arithmetic != expected.arithmetic)
    return words("the arithmetic", got.arithmetic, expected.arithmetic);
  if (got.files != expected.files)
    return words("presets, cars or tracks of other contents,", got.files, expected.files);
  return "another first line, expected the same";
}

Result<FileContents> read_lines(
    const std::string& file,
    const std::function<Result<void>(const LinePlace&, const std::string&)>& on_line) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return fail(ErrorCode::kNotFound, fmt::format("{}: {}", file, std::strerror(errno)));
  FileContents contents;
  std::string line;
  for (std::uint64_t number = 1; std::getline(stream, line) && !stream.eof(); ++number) {
    const LinePlace place{run_of(line).value_or(Plan::kMostRuns), contents.whole, line.size()};
    if (line.size() > kLongestLine || (number > 1 && place.run == Plan::kMostRuns)) {
      return fail(
          refusal(fmt::format("{}:{}", file, number), line, "the results of a run", ErrorCode::kParse));
    }
    contents.whole += line.size() + 1;
    if (number == 1) {
      contents.header = line;
      continue;
    }
    ++contents.lines;
    if (const Result<void> done = on_line(place, line); !done)
      return fail(done.error().code, fmt::format("{}:{}: {}", file, number, done.error().message));
  }
  if (stream.bad()) return fail(ErrorCode::kIo, fmt::format("{}: {}", file, std::strerror(errno)));
  return contents;
}

ResultFile::ResultFile(std::string path, int descriptor, const Shard& shard, std::uint64_t runs)
    : path_{std::move(path)}, descriptor_{descriptor}, shard_{shard}, done_(shard.size(runs), false) {}

ResultFile::ResultFile(ResultFile&& other) noexcept
    : path_{std::move(other.path_)},
      descriptor_{std::exchange(other.descriptor_, -1)},
      shard_{std::move(other.shard_)},
      done_{std::move(other.done_)},
      done_count_{other.done_count_},
      size_{other.size_} {}

ResultFile::~ResultFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

Result<ResultFile> ResultFile::open(const std::string& path, const Plan& plan, const Shard& shard) {
  const int descriptor = ::open(path.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (descriptor < 0) return io_failure(path);
  ResultFile file(path, descriptor, shard, plan.size());
  if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0)
    return fail(ErrorCode::kIo, fmt::format("{}: another process writes it", path));
  const std::string header = header_of(plan);
  const auto contents = read_lines(path, [&](const LinePlace& line, const std::string&) -> Result<void> {
    if (line.run >= plan.size() || !shard.has(line.run))
      return fail(ErrorCode::kInvalidArgument,
                  fmt::format("got run {}, expected one of this shard", line.run));
    if (!file.done_[line.run / shard.count]) ++file.done_count_;
    file.done_[line.run / shard.count] = true;
    return {};
  });
  if (!contents) return fail(contents.error());
  if (!contents->header.empty() && contents->header != header) {
    const Result<Header> got = parse_header(contents->header, path);
    if (!got) return fail(got.error());
    return fail(ErrorCode::kInvalidArgument,
                fmt::format("{}: got results of {}; choose another file", path,
                            difference_text(*got, parse_header(header, path).value())));
  }
  file.size_ = contents->whole;
  if (::ftruncate(descriptor, static_cast<off_t>(file.size_)) != 0) return io_failure(path);
  if (contents->header.empty()) {
    if (const Result<void> written = file.append(header); !written) return fail(written.error());
  }
  return file;
}

Result<void> ResultFile::append(std::string_view line) {
  std::string bytes(line);
  bytes += '\n';
  const std::lock_guard lock(mutex_);
  if (write_all(descriptor_, bytes)) {
    size_ += bytes.size();
    return {};
  }
  const int reason = errno;
  static_cast<void>(!::ftruncate(descriptor_, static_cast<off_t>(size_)));  // no half line is left behind
  errno = reason;
  return io_failure(path_);
}

}  // namespace chicane::sweep
