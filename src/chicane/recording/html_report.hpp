// SPDX-License-Identifier: MIT
// Report of recordings, or of any document, as one HTML file that works without network and program.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "chicane/base/result.hpp"

namespace chicane::recording {

/// Recording in a report.
struct ReportedLog {
  std::string name;  ///< name for people
  std::string file;  ///< path of the recording
};

/// Program and style sheet of the page, gzip-compressed. Empty in a program that was built without Node.
struct ReportBundle {
  std::string_view script;
  std::string_view style;
};

/// Options of write_report().
struct ReportOptions {
  std::string output;  ///< name of the page; an existing file is replaced at the end
  std::vector<ReportedLog> logs;
  ReportBundle bundle;                              ///< live::document_bundle()
  std::size_t most_bytes = std::size_t{16} << 20U;  ///< limit of all recordings in the page [byte]; chosen
};

/// Result of write_report().
struct ReportSummary {
  std::size_t bytes = 0;  ///< size of the file
  double rate = 0.0;      ///< control steps kept per second [Hz], besides those at which a kept value changes
};

/// Writes a document (protocol/json.hpp) as one HTML file that needs no network and no program. `bundle`:
/// live::document_bundle(). Returns the size of the file [byte]. kNotFound when this program was built
/// without its dashboard, kIo.
[[nodiscard]] Result<std::size_t> write_document(const std::string& file, std::string document,
                                                 const ReportBundle& bundle);

/// Writes the laps of recordings as one HTML file that needs no network and no program. Control steps are
/// thinned to 20 a second, or as few as 1 so that they fit; plans are left out.
///
/// kInvalidArgument when the recordings do not fit at 1 step a second, kNotFound when this program was built
/// without its dashboard, kParse for a message that does not fit its definition; otherwise as
/// check_recording().
[[nodiscard]] Result<ReportSummary> write_report(const ReportOptions& options);

}  // namespace chicane::recording
