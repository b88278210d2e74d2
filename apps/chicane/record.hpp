// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "chicane/protocol/ros_messages.hpp"
#include "chicane/recording/log_files.hpp"
#include "chicane/recording/recorder.hpp"
#include "options.hpp"

namespace chicane::apps {

/// Checks that browsers open a page of this name. Fails with "OPTION: got x.txt, expected a name that ends in
/// .html". Passes the empty name, which is no file, and devices.
[[nodiscard]] Result<void> check_page_name(std::string_view option, const std::string& file);

/// Recording and report of a run (--record, --report), made of every control step. Does nothing without
/// either option.
class KeptRun {
 public:
  /// `step_budget` [s]: deadline of a control step in real time; 0 with --fast, where the run waits for the
  /// disk. Fails as Recorder::create does. Fails also if the report cannot be written at the end: kNotFound
  /// without a dashboard in this program, kIo without a folder.
  [[nodiscard]] static Result<std::unique_ptr<KeptRun>> start(const Options& options, protocol::Run run,
                                                              const scenario::Scenario& scenario,
                                                              double step_budget);

  /// Recorder; null without --record and --report.
  [[nodiscard]] recording::Recorder* recorder() const { return recorder_.get(); }
  /// Passes a frame, lap or change to Recorder::record.
  template <class What>
  void record(What&& what) {
    if (recorder_) recorder_->record(std::forward<What>(what));
  }
  /// Closes the recording, writes the report, and sums them up on stderr.
  [[nodiscard]] Result<void> finish();

 private:
  explicit KeptRun(const Options& options)
      : record_file_{options.record_file}, report_file_{options.report_file}, is_bag_{options.is_bag} {}
  [[nodiscard]] Result<void> write_report() const;

  std::string record_file_;
  std::string report_file_;
  bool is_bag_;                                        ///< writes metadata.yaml next to the recording
  std::optional<recording::TemporaryFile> temporary_;  ///< recording for a report without --record
  std::unique_ptr<recording::Recorder> recorder_;
};

}  // namespace chicane::apps
