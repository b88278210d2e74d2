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

/// Checks that the name of an HTML page is one that browsers open: `option`: got x.txt, expected a name that
/// ends in .html. An empty name is no file; devices may have any.
[[nodiscard]] Result<void> check_page_name(std::string_view option, const std::string& file);

/// What --record and --report keep of a run: every control step. Nothing is kept where neither is asked for.
class KeptRun {
 public:
  /// `step_budget` [s]: deadline of a control step in real time; 0 with --fast, where the run waits for the
  /// disk. Fails as Recorder::create does, and where a report could not be written at the end: kNotFound
  /// without a dashboard in this program, kIo without a folder for it.
  [[nodiscard]] static Result<std::unique_ptr<KeptRun>> start(const Options& options, protocol::Run run,
                                                              const scenario::Scenario& scenario,
                                                              double step_budget);

  /// Null where nothing is kept.
  [[nodiscard]] recording::Recorder* recorder() const { return recorder_.get(); }
  /// As Recorder::record does.
  template <class What>
  void record(What&& what) {
    if (recorder_) recorder_->record(std::forward<What>(what));
  }
  /// Closes the recording, writes the report, and says on stderr what is in them.
  [[nodiscard]] Result<void> finish();

 private:
  explicit KeptRun(const Options& options)
      : record_file_{options.record_file}, report_file_{options.report_file}, is_bag_{options.is_bag} {}
  [[nodiscard]] Result<void> write_report() const;

  std::string record_file_;
  std::string report_file_;
  bool is_bag_;  ///< metadata.yaml is written beside the recording
  std::optional<recording::TemporaryFile>
      temporary_;  ///< what a report is made of, where nothing is recorded
  std::unique_ptr<recording::Recorder> recorder_;
};

}  // namespace chicane::apps
