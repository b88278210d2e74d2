// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <filesystem>

#include "chicane/live/assets.hpp"
#include "chicane/recording/html_report.hpp"
#include "commands.hpp"

namespace chicane::apps {

ExitCode report_logs(const Options& options) {
  recording::ReportOptions reporting{
      .output = options.output_file, .logs = {}, .bundle = live::report_bundle()};
  for (const std::string& file : options.log_files) {
    std::error_code error;  // of a file that is not there: no reason to stop
    if (std::filesystem::equivalent(file, options.output_file, error)) {
      return report(Error{ErrorCode::kInvalidArgument,
                          fmt::format("--output: got {}, expected another file than a recording that is read",
                                      options.output_file)});
    }
    reporting.logs.push_back({std::filesystem::path(file).filename().string(), file});
  }
  const Result<recording::ReportSummary> written = recording::write_report(reporting);
  if (!written) return report(written.error());
  fmt::print("{}: {:.1f} MB, {:g} messages a second; open it in a browser\n", options.output_file,
             1e-6 * static_cast<double>(written->bytes), written->rate);
  return kSuccess;
}

}  // namespace chicane::apps
