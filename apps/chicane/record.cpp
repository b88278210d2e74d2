// SPDX-License-Identifier: MIT
// Recording of a run from the command line: its file, and the report made of it.
#include "record.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <string_view>
#include <utility>

#include "chicane/base/file.hpp"
#include "chicane/base/text.hpp"
#include "chicane/live/description.hpp"
#include "chicane/recording/html_report.hpp"
#include "chicane/recording/log_files.hpp"

namespace chicane::apps {

namespace {

/// Checks before the run that its recording can become a report.
Result<void> can_be_reported(const std::string& file) {
  if (live::document_bundle().script.empty()) {
    return fail(
        ErrorCode::kNotFound,
        "--report: built without its dashboard: remove web_assets.cpp, build with Node.js and npm online");
  }
  return check_writable(file);
}

}  // namespace

Result<void> check_page_name(std::string_view option, const std::string& file) {
  const std::filesystem::path extension = std::filesystem::path(file).extension();
  std::error_code error;
  const bool is_device =
      std::filesystem::exists(file, error) && !std::filesystem::is_regular_file(file, error);
  if (file.empty() || extension == ".html" || extension == ".htm" || is_device) return {};
  return fail(refusal(option, file, "a name that ends in .html"));
}

Result<std::unique_ptr<KeptRun>> KeptRun::start(const Options& options, protocol::Run run,
                                                const scenario::Scenario& scenario, double step_budget) {
  std::unique_ptr<KeptRun> kept(new KeptRun(options));
  if (options.record_file.empty() && options.report_file.empty()) return kept;
  if (std::filesystem::weakly_canonical(options.record_file) ==
      std::filesystem::weakly_canonical(options.report_file)) {
    return fail(refusal("--report", options.report_file, "another file than --record"));
  }
  if (const Result<void> named = check_page_name("--report", options.report_file); !named)
    return fail(named.error());
  if (options.is_bag) {
    if (const Result<void> possible = recording::can_be_bag(options.record_file); !possible)
      return fail(possible.error());
  }
  if (!options.report_file.empty()) {
    if (const Result<void> possible = can_be_reported(options.report_file); !possible)
      return fail(possible.error());
    if (options.record_file.empty()) kept->temporary_.emplace(".mcap");
  }
  auto recorder =
      recording::Recorder::create({.path = kept->temporary_ ? kept->temporary_->path() : options.record_file,
                                   .run = std::move(run),
                                   .scenario = scenario,
                                   .is_compressed = options.is_compressed,
                                   .step_budget = step_budget,
                                   .may_wait = options.is_fast,
                                   .say = [](std::string_view line) { fmt::print(stderr, "\n{}\n", line); }});
  if (!recorder) return fail(recorder.error());
  kept->recorder_ = std::move(*recorder);
  return kept;
}

Result<void> KeptRun::finish() {
  if (!recorder_) return {};
  const Result<recording::RecorderReport> report = recorder_->finish();
  if (!report) return fail(report.error());
  const std::string& main_file = temporary_ ? report_file_ : record_file_;
  if (!temporary_)
    fmt::print(stderr, "{}: recorded {} steps, {:.1f} MB\n", main_file, report->frames,
               1e-6 * static_cast<double>(report->bytes));
  if (report->left_out > 0)
    fmt::print(stderr, "{}: the disk was too slow for {} steps\n", main_file, report->left_out);
  if (report->missing > 0)
    fmt::print(stderr, "{}: {} steps are missing: the disk did not take them\n", main_file, report->missing);
  if (is_bag_) {
    if (const Result<void> written = recording::write_bag_metadata(record_file_); !written)
      return fail(written.error());
  }
  if (report_file_.empty()) return {};
  if (report->frames > 0) return write_report();
  return fail(
      ErrorCode::kInvalidArgument,
      fmt::format("--report: got a run without a control step, expected one at least; {} is not written",
                  report_file_));
}

Result<void> KeptRun::write_report() const {
  const std::string& log = temporary_ ? temporary_->path() : record_file_;
  const std::string name = std::filesystem::path(temporary_ ? report_file_ : record_file_).filename();
  const Result<recording::ReportSummary> written = recording::write_report(
      {.output = report_file_, .logs = {{name, log}}, .bundle = live::document_bundle()});
  if (!written) return fail(written.error());
  fmt::print(stderr, "{}: {:.1f} MB, {:g} control steps a second; open it in a browser\n", report_file_,
             1e-6 * static_cast<double>(written->bytes), written->rate);
  return {};
}

}  // namespace chicane::apps
