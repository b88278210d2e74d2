// SPDX-License-Identifier: MIT
// Report page: recordings, thinned to what a screen shows, as one JSON document in the page of the dashboard.
#include "chicane/recording/html_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "chicane/base/file.hpp"
#include "chicane/base/text.hpp"
#include "chicane/protocol/json.hpp"
#include "chicane/recording/detail/ros_message.hpp"
#include "chicane/recording/replay.hpp"
#include "chicane/telemetry/mcap.hpp"

namespace chicane::recording {
namespace {

using protocol::Json;
using namespace std::string_view_literals;

// Chosen.
constexpr std::array kRates{20.0, 10.0, 5.0, 2.0, 1.0};  // [Hz] rates of kept control steps, tried in turn
// Significant digits of whole messages, whose lap times the page rounds again, and of drawn values.
constexpr int kExact = 9, kDrawn = 6;

// Topics whose messages are in the page whole.
constexpr std::array kWhole{"/chicane/run"sv, "/chicane/lap"sv, "/chicane/change"sv, "/chicane/limit"sv};
// Fields of control steps that the page draws.
constexpr std::array<const char*, 22> kColumns{"time_s",
                                               "lap",
                                               "lap_time_s",
                                               "last_lap_time_s",
                                               "s_m",
                                               "x_m",
                                               "y_m",
                                               "speed_mps",
                                               "lateral_error_m",
                                               "steer_applied_rad",
                                               "throttle_applied",
                                               "front_tire_use",
                                               "rear_tire_use",
                                               "step_time_us",
                                               "iterations",
                                               "cost",
                                               "delay_s",
                                               "prediction_error_m",
                                               "off_track_events",
                                               "rung",
                                               "is_gated",
                                               "active_faults"};
// Fields whose changes are kept: a step in which one of them changes is never left out.
constexpr std::array kKept{"lap"sv, "rung"sv, "is_gated"sv, "active_faults"sv, "off_track_events"sv};

// Beginning and end of the page. The dashboard's files stay gzip-compressed, because every browser can unpack
// them, and are in base64, which has no character with a meaning in HTML.
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

/// Number rounded to significant digits; null if it is not finite.
Json json_of(double value, int digits) {
  return std::isfinite(value) ? Json(std::stod(fmt::format("{:.{}g}", value, digits))) : Json(nullptr);
}

Json json_of(const std::vector<double>& values, int digits) {
  Json list = Json::array();
  for (const double value : values) list.push_back(json_of(value, digits));
  return list;
}

/// Message as lists, one for each field.
Json json_of(const RosContent& content) {
  Json fields = Json::object();
  for (const auto& [name, values] : content.numbers) fields[name] = json_of(values, kExact);
  for (const auto& [name, values] : content.texts) fields[name] = values;
  return fields;
}

/// Runs of a recording, thinned, in the form that the page reads (web/src/document/runs.ts).
class ReportedRuns {
 public:
  explicit ReportedRuns(double rate) : period_{1.0 / rate} {}

  Result<void> add(const telemetry::McapMessage& message) {
    const std::string& topic = message.channel.topic;
    const bool is_whole = std::find(kWhole.begin(), kWhole.end(), topic) != kWhole.end();
    if (!is_whole && topic != "/chicane/frame" && topic != "/track/centre") return {};
    const Result<RosContent> content = readers_.read(message);
    if (!content) return fail(content.error());
    if (topic == "/chicane/frame") {
      add_frame(*content);
    } else if (topic == "/track/centre") {
      centre_ = {{"x_m", json_of(content->list("poses.pose.position.x"), kDrawn)},
                 {"y_m", json_of(content->list("poses.pose.position.y"), kDrawn)}};
      if (!runs_.empty() && last_) runs_.back()["centre"] = centre_;
    } else if (topic == "/chicane/run") {
      run_ = json_of(*content);
      if (last_) limit_ = nullptr;
      last_.reset();
    } else if (topic == "/chicane/limit") {
      limit_ = content->number("is_known") != 0.0 ? json_of(*content) : Json(nullptr);
      if (!runs_.empty() && last_) runs_.back()["limit"] = limit_;
    } else if (!runs_.empty()) {
      runs_.back()[topic == "/chicane/lap" ? "laps" : "changes"].push_back(json_of(*content));
    }
    return {};
  }

  [[nodiscard]] Json take() {
    end_run();
    return std::move(runs_);
  }

 private:
  /// Adds a control step; a time that falls begins another run.
  void add_frame(const RosContent& frame) {
    const double time = frame.number("time_s");
    if (!last_ || time < last_->number("time_s")) begin_run();
    Json& columns = runs_.back()["frames"];
    const bool has_changed = !last_ || std::any_of(kKept.begin(), kKept.end(), [&](std::string_view name) {
      return frame.number(name) != last_->number(name);
    });
    if (const double taken = frame.number("step_time_us"); std::isfinite(taken)) step_times_.push_back(taken);
    iterations_ += frame.number("iterations");
    last_ = frame;
    if (!has_changed && time < next_) return;
    next_ = std::max(next_ + period_, time + 0.5 * period_);
    for (const char* name : kColumns)
      columns[name].push_back(json_of(frame.number(name, std::nan("")), kDrawn));
  }

  void begin_run() {
    end_run();
    runs_.push_back({{"run", run_},
                     {"centre", centre_},
                     {"limit", limit_},
                     {"laps", Json::array()},
                     {"changes", Json::array()},
                     {"frames", Json::object()}});
    last_.reset();
    next_ = 0.0;
    step_times_.clear();
    iterations_ = 0.0;
  }

  /// Adds durations and iterations of all control steps, also of those left out, to the run that ends.
  void end_run() {
    if (runs_.empty() || step_times_.empty()) return;
    std::sort(step_times_.begin(), step_times_.end());
    const auto count = static_cast<double>(step_times_.size());
    const auto quantile = [&](double share) {
      return json_of(step_times_[static_cast<std::size_t>(share * (count - 1.0))], kDrawn);
    };
    runs_.back()["steps"] = {{"count", step_times_.size()},
                             {"p50_us", quantile(0.5)},
                             {"p99_us", quantile(0.99)},
                             {"longest_us", quantile(1.0)},
                             {"mean_iterations", json_of(iterations_ / count, kDrawn)}};
  }

  double period_;                                            ///< least time between kept steps [s]
  double next_ = 0.0;                                        ///< time of the next step to keep [s]
  double iterations_ = 0.0;                                  ///< sum of iterations in this run
  Json runs_ = Json::array();                                ///< runs so far
  Json run_ = nullptr, centre_ = nullptr, limit_ = nullptr;  ///< newest description, road and limit
  std::optional<RosContent> last_;  ///< last control step of this run; none: the next begins one
  std::vector<double> step_times_;  ///< durations of this run's control steps [µs]
  RosReaders readers_;
};

/// Recording with name and settings, thinned to `rate` [Hz].
Result<Json> json_of(const ReportedLog& log, double rate) {
  ReportedRuns runs(rate);
  std::string settings;
  std::optional<Error> failure;
  telemetry::McapVisitor visitor;
  visitor.on_message = [&](const telemetry::McapMessage& message) {
    if (failure) return;
    if (const Result<void> added = runs.add(message); !added) failure = added.error();
  };
  visitor.on_attachment = [&](std::string_view, std::string_view bytes) {
    if (settings.empty()) settings = bytes;
  };
  if (const auto read = telemetry::read_mcap(log.file, visitor); !read) return fail(read.error());
  if (failure) return fail(failure->code, fmt::format("{}: {}", log.file, failure->message));
  return Json{{"name", log.name}, {"settings", settings}, {"runs", runs.take()}};
}

/// JSON document of the page, thinned to `rate` [Hz]; empty if it is too large.
Result<std::string> document_of(const ReportOptions& options, double rate) {
  Json logs = Json::array();
  for (const ReportedLog& log : options.logs) {
    Result<Json> json = json_of(log, rate);
    if (!json) return fail(json.error());
    logs.push_back(std::move(*json));
  }
  std::string text = protocol::json_text(Json{{"kind", "runs"}, {"logs", std::move(logs)}});
  return text.size() > options.most_bytes ? std::string{} : text;
}

}  // namespace

Result<std::size_t> write_document(const std::string& file, std::string document,
                                   const ReportBundle& bundle) {
  if (bundle.script.empty())
    return fail(ErrorCode::kNotFound,
                "report: this program has no dashboard: install Node.js and npm, remove the build folder, "
                "and build again");
  // Only this character can end a script element, or begin a comment that hides its end.
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
    Result<std::string> document = document_of(options, rate);
    if (!document) return fail(document.error());
    if (document->empty()) continue;
    const Result<std::size_t> bytes = write_document(options.output, std::move(*document), options.bundle);
    if (!bytes) return fail(bytes.error());
    return ReportSummary{.bytes = *bytes, .rate = rate};
  }
  return fail(
      ErrorCode::kInvalidArgument,
      fmt::format("report: got more than {} MiB at one control step a second, expected shorter or fewer "
                  "recordings",
                  options.most_bytes >> 20U));
}

}  // namespace chicane::recording
