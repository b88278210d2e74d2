// SPDX-License-Identifier: MIT
#include "chicane/recording/html_report.hpp"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string_view>
#include <utility>

#include "chicane/base/file.hpp"
#include "chicane/base/text.hpp"
#include "chicane/protocol/json.hpp"
#include "chicane/recording/excerpt.hpp"
#include "chicane/recording/reader.hpp"
#include "chicane/recording/temporary_file.hpp"

namespace chicane::recording {
namespace {

using protocol::Json;
using namespace std::string_view_literals;

// What the dashboard draws of a log. The standard messages beside them say the same to other viewers.
const std::vector<std::string> kTopics{"/chicane/frame",  "/chicane/plan",     "/chicane/run", "/chicane/lap",
                                       "/chicane/change", "/chicane/limit",    "/track/left",  "/track/right",
                                       "/track/centre",   "/chicane/situation"};
constexpr std::array kRates{10.0, 5.0, 2.0, 1.0};  // [Hz]

// The dashboard's files are gzip-compressed in the program, and stay so in the page: every browser unpacks
// them. Base64 has no character that means anything in HTML.
constexpr std::string_view kHead = R"(<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; script-src 'unsafe-inline' 'wasm-unsafe-eval' blob:; style-src 'unsafe-inline'; img-src data: blob:; worker-src blob:; connect-src data: blob:; font-src data:">
<title>chicane report</title>
<link rel="icon" href="data:,">
</head>
<body>
<div id="app"></div>
<noscript>This report is drawn with JavaScript.</noscript>
)";
constexpr std::string_view kStart = R"(<script>
(async () => {
  try {
    const text = async (id) => {
      const bytes = Uint8Array.from(atob(document.getElementById(id).textContent.trim()), (c) => c.charCodeAt(0));
      const plain = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('gzip'));
      return new Response(plain).text();
    };
    const add = (name, content, type) => {
      const element = document.createElement(name);
      if (type) element.type = type;
      element.textContent = content;
      document.head.append(element);
    };
    add('style', await text('chicane-style'));
    add('script', await text('chicane-program'), 'module');
  } catch (fault) {
    document.getElementById('app').textContent =
      'This report needs a browser of 2023 or later: Chrome 80, Firefox 113, Safari 16.4. (' + fault + ')';
  }
})();
</script>
</body>
</html>
)";

Result<std::string> read_all(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream bytes;
  bytes << stream.rdbuf();
  if (!stream) return fail(ErrorCode::kIo, file + ": cannot be read: " + std::strerror(errno));
  return std::move(bytes).str();
}

/// {"logs":[{"name":…,"mcap_base64":…}]}; empty where they are too large.
Result<std::string> logs_json(const ReportOptions& options, double rate) {
  Json logs = Json::array();
  std::size_t bytes = 0;
  for (const ReportedLog& log : options.logs) {
    const TemporaryFile thinned(".mcap");
    const auto read = excerpt(log.file, thinned.path(), {.topics = kTopics, .rate = rate});
    if (!read) return fail(read.error());
    const Result<std::string> content = read_all(thinned.path());
    if (!content) return fail(content.error());
    bytes += content->size();
    if (bytes > options.most_bytes) return std::string{};
    logs.push_back({{"name", log.name}, {"mcap_base64", base64(*content)}});
  }
  return protocol::json_text(Json{{"logs", std::move(logs)}});
}

}  // namespace

Result<std::size_t> write_document(const std::string& file, std::string document,
                                   const ReportBundle& bundle) {
  if (bundle.script.empty())
    return fail(
        ErrorCode::kNotFound,
        "report: this program was built without its dashboard: install Node.js and npm, and build again");
  // The one way out of a script element, or into a comment that hides its end, begins with this character.
  for (std::size_t at = 0; (at = document.find('<', at)) != std::string::npos; at += 6)
    document.replace(at, 1, "\\u003c");
  const std::string program = base64(bundle.script), style = base64(bundle.style);
  std::size_t bytes = 0;
  FileWriter page(file);
  for (const std::string_view part :
       {kHead, "<script type=\"application/json\" id=\"chicane-report\">"sv, std::string_view(document),
        "</script>\n<script type=\"text/plain\" id=\"chicane-style\">"sv, std::string_view(style),
        "</script>\n<script type=\"text/plain\" id=\"chicane-program\">"sv, std::string_view(program),
        "</script>\n"sv, kStart}) {
    page.write(part);
    bytes += part.size();
  }
  if (const Result<void> written = page.finish(); !written) return fail(written.error());
  return bytes;
}

Result<ReportSummary> write_report(const ReportOptions& options) {
  for (const ReportedLog& log : options.logs) {
    if (const auto read = check_recording(log.file); !read) return fail(read.error());
  }
  for (const double rate : kRates) {
    Result<std::string> logs = logs_json(options, rate);
    if (!logs) return fail(logs.error());
    if (logs->empty()) continue;
    const Result<std::size_t> bytes = write_document(options.output, std::move(*logs), options.bundle);
    if (!bytes) return fail(bytes.error());
    return ReportSummary{.bytes = *bytes, .rate = rate};
  }
  return fail(ErrorCode::kInvalidArgument,
              fmt::format("report: got more than {} MiB of logs at one message a second, expected shorter or "
                          "fewer recordings",
                          options.most_bytes >> 20U));
}

}  // namespace chicane::recording
