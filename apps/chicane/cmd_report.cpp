// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <list>

#include "chicane/base/text.hpp"
#include "chicane/live/assets.hpp"
#include "chicane/recording/html_report.hpp"
#include "chicane/recording/reader.hpp"
#include "chicane/recording/temporary_file.hpp"
#include "chicane/sweep/result_table.hpp"
#include "chicane/sweep/summary_page.hpp"
#include "commands.hpp"
#include "foreign_log.hpp"
#include "record.hpp"

namespace chicane::apps {

namespace {

/// The results of a sweep are lines of JSON, recordings are MCAP.
bool are_results(const std::vector<std::string>& files) {
  return std::all_of(files.begin(), files.end(), [](const std::string& file) {
    return std::filesystem::path(file).extension() == ".jsonl";
  });
}

/// Prints runs that differ in one setting beside each other.
ExitCode report_comparison(const Options& options) {
  const std::size_t equals = options.comparison.find('=');
  if (equals == std::string::npos || !are_results(options.log_files))
    return report(Error{ErrorCode::kInvalidArgument,
                        fmt::format("--compare: got {}, expected KEY=VALUE and results of a sweep",
                                    printable(options.comparison))});
  const auto compared = sweep::compare(options.log_files, options.comparison.substr(0, equals),
                                       options.comparison.substr(equals + 1));
  if (!compared) return report(compared.error());
  fmt::print("{}", compared->table);
  fmt::print(stderr, "{} of {} are worse than with {}; {} have no run to compare with\n", compared->worse,
             compared->pairs, options.comparison, compared->missing);
  return compared->worse == 0 ? kSuccess : kRunFailed;
}

ExitCode report_sweep(const Options& options) {
  if (!options.maps_page.empty()) {
    const auto maps = sweep::write_maps(options.log_files, options.maps_page);
    if (!maps) return report(maps.error());
    fmt::print(stderr, "{}: maps of {} runs\n", options.maps_page, *maps);
    if (options.output_file.empty()) return kSuccess;
  }
  const auto summary = sweep::summary_document(options.log_files);
  if (!summary) return report(summary.error());
  const auto bytes = recording::write_document(options.output_file, summary->text, live::document_bundle());
  if (!bytes) return report(bytes.error());
  fmt::print("{}: {} runs, {:.1f} MB; open it in a browser\n", options.output_file, summary->runs,
             1e-6 * static_cast<double>(*bytes));
  return kSuccess;
}

}  // namespace

ExitCode report_logs(const Options& options) {
  if (!options.comparison.empty()) return report_comparison(options);
  if (options.output_file.empty() && options.maps_page.empty())
    return report(Error{ErrorCode::kInvalidArgument,
                        "report: got none of --output, --page and --compare, expected one"});
  const Result<void> named = check_page_name("--output", options.output_file);
  if (are_results(options.log_files)) return named ? report_sweep(options) : report(named.error());
  if (!options.maps_page.empty())
    return report(Error{ErrorCode::kInvalidArgument, "--page: got recordings, expected results of a sweep"});
  recording::ReportOptions reporting{
      .output = options.output_file, .logs = {}, .bundle = live::document_bundle()};
  std::list<recording::TemporaryFile> copies;
  for (const std::string& file : options.log_files) {
    std::error_code error;  // of a file that is not there: no reason to stop
    if (std::filesystem::equivalent(file, options.output_file, error)) {
      return report(Error{ErrorCode::kInvalidArgument,
                          fmt::format("--output: got {}, expected another file than a recording that is read",
                                      options.output_file)});
    }
    std::string read = file;
    if (named && recording::is_foreign_log(file)) {
      copies.emplace_back(".mcap");
      read = copies.back().path();
      if (const Result<void> made = convert_foreign_log(file, options, read); !made)
        return report(made.error());
    }
    reporting.logs.push_back({std::filesystem::path(file).filename().string(), read});
  }
  if (!named) return report(named.error());
  const Result<recording::ReportSummary> written = recording::write_report(reporting);
  if (!written) return report(written.error());
  fmt::print("{}: {:.1f} MB, {:g} control steps a second; open it in a browser\n", options.output_file,
             1e-6 * static_cast<double>(written->bytes), written->rate);
  return kSuccess;
}

}  // namespace chicane::apps
