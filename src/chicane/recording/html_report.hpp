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
  std::string name;  ///< for people
  std::string file;
};

/// A page in two files, gzip-compressed. Empty in a program that was built without Node.
struct ReportBundle {
  std::string_view script;
  std::string_view style;
};

/// Everything of a report that is not a log.
struct ReportOptions {
  std::string output;  ///< written anew; an older file of that name is replaced when all is done
  std::vector<ReportedLog> logs;
  ReportBundle bundle;                              ///< live::report_bundle()
  std::size_t most_bytes = std::size_t{48} << 20U;  ///< of all logs in the page
};

struct ReportSummary {
  std::size_t bytes = 0;  ///< of the file
  double rate = 0.0;      ///< messages of one topic per second that were kept [Hz]
};

/// Writes a document (protocol/report_document.hpp) as one HTML file that needs no network and no program.
/// `bundle`: live::document_bundle(). Bytes of the file; kNotFound when this program was built without its
/// dashboard, kIo.
[[nodiscard]] Result<std::size_t> write_document(const std::string& file, std::string document,
                                                 const ReportBundle& bundle);

/// Writes the dashboard with its recordings as one HTML file that needs no network and no program. Recordings
/// are thinned to 10 messages a second and topic, or fewer, down to 1, so that they fit.
///
/// kInvalidArgument when they do not fit even so, kNotFound when this program was built without its
/// dashboard; otherwise as excerpt() fails.
[[nodiscard]] Result<ReportSummary> write_report(const ReportOptions& options);

}  // namespace chicane::recording
