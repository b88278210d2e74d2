// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "chicane/runtime/replay.hpp"
#include "commands.hpp"

namespace chicane::apps {
namespace {

using Json = nlohmann::ordered_json;

Json cycle(const std::optional<std::uint64_t>& number) { return number ? Json(*number) : Json(nullptr); }

std::string to_json(const runtime::ReplayReport& report) {
  const Json object{{"recorded_by", report.recorded_by},
                    {"controller", report.controller},
                    {"track", report.track},
                    {"verified", report.is_verified()},
                    {"steps", report.steps},
                    {"identical", report.identical},
                    {"different", report.different},
                    {"unknown", report.unknown},
                    {"first_difference", cycle(report.first_difference)},
                    {"late", report.late},
                    {"first_late", cycle(report.first_late)},
                    {"damaged", report.damaged},
                    {"closed", report.is_complete}};
  return object.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string to_text(const runtime::ReplayReport& report) {
  const double share =
      report.steps == 0 ? 0.0
                        : 100.0 * static_cast<double>(report.identical) / static_cast<double>(report.steps);
  // Never rounded up to 100.
  const std::string percent = report.is_verified() ? "100" : fmt::format("{:.3f}", std::min(share, 99.999));
  std::string text = fmt::format(
      "{} on {}, recorded by {}: {} of {} commands came out identical, bit for bit ({} %)\n",
      report.controller, report.track, report.recorded_by, report.identical, report.steps, percent);
  if (report.first_difference) {
    text +=
        fmt::format("first difference: cycle {} ({} in all)\n", *report.first_difference, report.different);
  }
  if (report.unknown > 0) text += fmt::format("behind missing steps, not comparable: {}\n", report.unknown);
  if (report.first_late) {
    text += fmt::format("deadline spent, cannot come out the same: {}, first in cycle {}\n", report.late,
                        *report.first_late);
  }
  if (report.damaged > 0) text += fmt::format("damaged parts left out: {}\n", report.damaged);
  if (!report.is_complete) text += "the recording was not closed: its end is missing\n";
  return text;
}

}  // namespace

ExitCode replay(const Options& options) {
  const Result<runtime::ReplayReport> result = runtime::verify_recording(options.log_file);
  if (!result) return report(result.error());
  fmt::print("{}", options.is_json ? to_json(*result) : to_text(*result));
  return result->is_verified() ? kSuccess : kBrokenPromise;
}

}  // namespace chicane::apps
