// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "chicane/base/result.hpp"

namespace chicane::recording {

/// A recording in a report.
struct ReportedLog {
  std::string name;  ///< name for people
  std::string file;
};

/// A page in two files, gzip-compressed. Empty in a program that was built without Node.
struct ReportBundle {
  std::string_view script;
  std::string_view style;
};

/// Everything of a report that is not a log.
struct ReportOptions {
  std::string output;  ///< name of the page; an existing file is replaced at the end
  std::vector<ReportedLog> logs;
  ReportBundle bundle;                              ///< live::document_bundle()
  std::size_t most_bytes = std::size_t{16} << 20U;  ///< limit of all recordings in the page
};

struct ReportSummary {
  std::size_t bytes = 0;  ///< size of the file
  double rate = 0.0;  ///< control steps per second that were kept, beside those where something changes [Hz]
};

/// Writes a document (protocol/json.hpp) as one HTML file that needs no network and no program.
/// `bundle`: live::document_bundle(). Bytes of the file; kNotFound when this program was built without its
/// dashboard, kIo.
[[nodiscard]] Result<std::size_t> write_document(const std::string& file, std::string document,
                                                 const ReportBundle& bundle);

/// Writes what recordings show of their laps as one HTML file that needs no network and no program. Control
/// steps are thinned to 20 a second, or fewer, down to 1, so that they fit; plans are left out. The recording
/// stays the source.
///
/// kInvalidArgument when they do not fit even so, kNotFound when this program was built without its
/// dashboard, kParse for a message whose definition does not describe it; otherwise as check_recording()
/// fails.
[[nodiscard]] Result<ReportSummary> write_report(const ReportOptions& options);

}  // namespace chicane::recording
