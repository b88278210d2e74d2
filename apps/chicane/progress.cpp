// SPDX-License-Identifier: MIT
// Output of a run on stderr: notices, progress and laps, the wait for a plan with a page at the dashboard's
// address, the recording and the report; and the address of the dashboard.
#include "progress.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <mutex>

#include "chicane/base/file.hpp"
#include "chicane/base/math.hpp"
#include "chicane/base/text.hpp"
#include "chicane/live/pages.hpp"
#include "chicane/net/http_response.hpp"
#include "chicane/recording/html_report.hpp"
#include "chicane/run/make.hpp"

namespace chicane::apps {
namespace {

using telemetry::Situation;

/// Whether the guard replaces the commands of the controller.
bool is_replaced(const Situation& now) {
  return now.rung != controller::Rung::kController && now.driver != Situation::Driver::kPerson;
}

/// Whether the car has been standing for long.
bool is_stuck(const Situation& now, double time) {
  return now.stands_since >= 0.0 && time - now.stands_since >= telemetry::kStuckAfter;
}

}  // namespace

std::vector<std::string> RunNotices::look_at(const telemetry::Frame& frame) {
  if (frame.time < last_time_) *this = {};  // another run has begun
  last_time_ = frame.time;
  const Situation& now = frame.situation;
  if (now.driver == Situation::Driver::kPerson) said_.clear();
  // No event now: report the end of the last one.
  if (!is_replaced(now) && severity_of(now) != Severity::kError) {
    std::string line = ended(frame.time);
    return line.empty() ? std::vector<std::string>{} : std::vector{std::move(line)};
  }
  const bool begins = said_.empty();
  if (begins) {
    began_ = frame.time;
    replaced_ = 0;
  }
  goes_on_ = true;
  if (is_replaced(now)) ++replaced_;
  // A line for a new event, and another line when its text changes.
  const bool is_held = now.kind == telemetry::SituationKind::kGuardHolds;
  if (is_held && !is_stuck(now, frame.time) && !begins) return {};  // a stored stop that has ended
  std::string text = sentence_of(now);
  if (const auto reason = reason_of(now); !reason.empty() && (begins || !is_held))
    text.append(": ").append(reason);
  if (is_stuck(now, frame.time)) text.append(". ").append(what_ends(now));
  if (text == said_ || (!begins && frame.time - said_at_ < telemetry::kAlarmPause)) return {};
  said_ = std::move(text);
  said_at_ = frame.time;
  return {fmt::format("{:.1f} s: {}", frame.time, said_)};
}

std::string RunNotices::ended(double time) {
  if (std::exchange(goes_on_, false)) ended_ = time;
  if (said_.empty() || time - ended_ < telemetry::kAlarmPause) return "";
  said_.clear();
  const double lasted = ended_ - began_;
  if (replaced_ == 0) return fmt::format("{:.1f} s: the car moves again, after {:.1f} s", ended_, lasted);
  return fmt::format("{:.1f} s: the controller drives again, after {:.1f} s and {} replaced {}", ended_,
                     lasted, replaced_, replaced_ == 1 ? "command" : "commands");
}

namespace {

constexpr double kLinePeriod = 10.0;  // [s] of the run between two lines without a terminal; chosen

/// Line about a frame, at most 80 columns.
std::string line(const telemetry::Frame& frame) {
  const double error = frame.has_truth ? frame.lateral_error : frame.result.report.lateral_error;
  const std::string place =
      frame.has_truth ? fmt::format("lap {:<2} {:5.0f} m ", frame.lap + 1, frame.s) : "";
  const std::string off = std::isfinite(error) ? fmt::format("error {:+6.2f} m", error) : "error unknown";
  const double speed = mps_to_mph(frame.measurement.speed);
  const std::string fast = std::isfinite(speed) ? fmt::format("{:5.1f} mph", speed) : "speed unknown";
  return fmt::format("{:6.1f} s  {}{}  {}  {}", frame.time, place, fast, off, sentence_of(frame.situation));
}

}  // namespace

std::string line_of(const telemetry::CompletedLap& lap) {
  const std::string_view verdict = !std::isfinite(lap.min_edge_distance) ? ""  // road unknown
                                   : lap.is_clean                        ? ", clean"
                                                                         : ", off the road";
  return fmt::format("lap {}: {:.2f} s, {:.1f} mph in the mean{}", lap.lap, lap.lap_time,
                     mps_to_mph(lap.mean_speed), verdict);
}

void Progress::show(const telemetry::Frame& frame) {
  for (const std::string& notice : notices_.look_at(frame)) say(notice);
  if (!(line_.is_terminal() ? line_.is_due() : frame.time >= next_run_time_)) return;
  next_run_time_ = frame.time + kLinePeriod;
  line_.show(line(frame));
}

void Progress::say(std::string_view line) {
  line_.end();
  print_sentence(stderr, line);
}

namespace {

constexpr std::chrono::milliseconds kGoodbyeOfPage{50};  // time for closing connections of the page; chosen

/// Begin of a drawing of the road in SVG: a stroke of the road's mean width, and a dashed stroke on it, up to
/// the length of the dash.
std::string picture_of(const road::Track& track) {
  constexpr int kPoints = 240;  // samples along the road
  std::string path;
  Vec2 low = track.centre().at(0.0).position, high = low;
  double width = 0.0;
  for (int i = 0; i <= kPoints; ++i) {
    const double s = track.lap_length() * i / kPoints;
    const Vec2 at = track.centre().at(s).position;
    low = {std::min(low.x(), at.x()), std::min(low.y(), at.y())};
    high = {std::max(high.x(), at.x()), std::max(high.y(), at.y())};
    width += (track.left_width(s) + track.right_width(s)) / (kPoints + 1);
    path += fmt::format("{}{:.1f} {:.1f}", i == 0 ? "M" : "L", at.x(), -at.y());
  }
  return fmt::format(
      "viewBox=\"{:.0f} {:.0f} {:.0f} {:.0f}\" stroke-width=\"{:.1f}\"><path id=\"road\" pathLength=\"100\" "
      "d=\"{}\"/><use href=\"#road\" style=\"stroke:#ffcb3d\" stroke-width=\"{:.1f}\" stroke-dasharray=\"",
      low.x() - width, -high.y() - width, high.x() - low.x() + 2.0 * width, high.y() - low.y() + 2.0 * width,
      width, path, 0.25 * width);
}

/// Page shown while a lap is planned. `road`: picture_of() the road; `done`: share of the work [%], drawn
/// along the road in the colour of plans (web/src/styles/tokens.css); `lap_time`: of the plan so far [s].
net::Content waiting_page(const std::string& road, const std::string& line, double done, double lap_time) {
  return {.content_type = "text/html; charset=utf-8",
          .bytes = fmt::format(
              "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><meta http-equiv=\"refresh\" "
              "content=\"1\"><meta name=\"viewport\" content=\"width=device-width\"><title>chicane</title>"
              "<body style=\"color-scheme:light dark;margin:0;height:100vh;display:grid;"
              "grid-template-rows:48px minmax(0,1fr) auto;font:14px/1.4 system-ui,sans-serif;"
              "background:light-dark(#f6f7f8,#0f1419);color:light-dark(#17202a,#e8edf2)\">"
              "<style>h1::first-letter{{text-transform:uppercase}}</style><b style=\"padding:14px "
              "24px\">chicane</b><svg aria-hidden=\"true\" fill=\"none\" width=\"100%\" "
              "height=\"100%\" style=\"background:light-dark(#dfe4da,#141b1c);"
              "box-sizing:border-box;padding:24px;stroke:light-dark(#5c646e,#2a323a)\" {}{:.1f} "
              "100\"/></svg><main style=\"padding:8px 24px\">"
              "<h1 style=\"font-size:18px;font-weight:500;margin:0\">{}.</h1>"
              "The plan so far takes {:.2f} s for the lap. The dashboard follows here.</main>",
              road, done, line, lap_time)};
}

}  // namespace

/// Page of the wait: the network thread answers requests while this thread plans.
struct PlanWait::Page {
  std::string road;  ///< picture_of() the road
  std::mutex mutex;  ///< guards `line` and `now`
  std::string line;  ///< plan_line()
  lap_time::PlanProgress now;
  std::unique_ptr<net::Server> server;  // last: destroyed first
};

std::string plan_line(const lap_time::PlanProgress& now, double elapsed, double budget) {
  const double per_work = now.work > 0.0 ? elapsed / now.work : 0.0;  // time for a second of work [s]
  if (now.work < now.expected)
    return fmt::format("planning the lap: {:.0f} %, about {:.0f} s left", 100.0 * now.work / now.expected,
                       std::ceil(per_work * (now.expected - now.work)));
  const double seconds = std::ceil(elapsed);
  if (!std::isfinite(budget))
    return fmt::format("planning the lap: {:.0f} s so far, more than estimated", seconds);
  return fmt::format("planning the lap: {:.0f} s so far, at most {:.0f} s left", seconds,
                     std::ceil(per_work * std::max(budget - now.work, 0.0)));
}

PlanWait::PlanWait(const scenario::Scenario& scenario, std::optional<net::ServerOptions>* server)
    : scenario_{scenario}, server_{server} {}

PlanWait::~PlanWait() {
  line_.clear();
  if (page_ && page_->server) (*server_)->port = page_->server->port();
}

run::PlanHooks PlanWait::hooks() {
  return {.on_progress = [this](const lap_time::PlanProgress& now) { show(now); },
          .say = [this](std::string_view line) { line_.clear(), print_sentence(stderr, line); }};
}

void PlanWait::open() {
  if (server_ == nullptr || !server_->has_value()) return;
  page_ = std::make_unique<Page>();
  const Result<road::Track> track = run::make_track(scenario_);
  page_->road = track ? picture_of(*track) : "><path stroke-dasharray=\"";
  net::ServerOptions options = **server_;
  options.goodbye = kGoodbyeOfPage;
  net::ServerHandlers handlers;
  handlers.on_upgrade = [](const net::UpgradeRequest&) {
    return net::UpgradeAnswer{.status = 503, .reason = "the lap is being planned: try again in some seconds"};
  };
  handlers.on_open = [](net::ConnectionId, int) {};
  handlers.on_message = [](net::ConnectionId, int, std::string_view, bool) {};
  handlers.on_close = [](net::ConnectionId, int, std::string_view) {};
  handlers.on_get = [page = page_.get()](std::string_view path) -> std::optional<net::Content> {
    if (path != "/") return {};
    const std::lock_guard lock(page->mutex);
    const double done = 100.0 * std::min(page->now.work / std::max(page->now.expected, 1e-9), 1.0);
    return waiting_page(page->road, page->line, done, page->now.lap_time);
  };
  auto server = net::Server::create(options, std::move(handlers), {});
  if (!server) {
    opened_ = fail(server.error());
    page_.reset();
    return;
  }
  page_->server = std::move(*server);
  print_sentence(stderr,
                 fmt::format("the lap is planned first; then the dashboard will be at {} (Ctrl-C ends)",
                             link(options, page_->server->port())));
}

void PlanWait::show(const lap_time::PlanProgress& now) {
  const std::string line = plan_line(now, line_.seconds(), run::plan_budget(scenario_));
  if (!std::exchange(has_begun_, true)) open();
  if (page_) {
    const std::lock_guard lock(page_->mutex);
    page_->line = line;
    page_->now = now;
  }
  if (line_.is_due()) line_.show(line);
}

namespace {

/// Checks before a run that its recording can become a report.
Result<void> can_be_reported(const std::string& file) {
  if (live::document_bundle().script.empty()) {
    return fail(ErrorCode::kNotFound,
                "--report: this program has no dashboard: install Node.js and npm, remove the build folder, "
                "and build again");
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

namespace {

/// Address of this machine that others may reach; empty if there is none.
std::string own_address() {
  ifaddrs* all = nullptr;
  if (::getifaddrs(&all) != 0) return {};
  std::string found;
  for (const ifaddrs* each = all; each != nullptr && found.empty(); each = each->ifa_next) {
    const bool is_ours = each->ifa_addr != nullptr && each->ifa_addr->sa_family == AF_INET &&
                         (each->ifa_flags & IFF_UP) != 0U && (each->ifa_flags & IFF_LOOPBACK) == 0U;
    if (!is_ours) continue;
    std::array<char, INET_ADDRSTRLEN> text{};
    const auto* address = reinterpret_cast<const sockaddr_in*>(each->ifa_addr);
    if (::inet_ntop(AF_INET, &address->sin_addr, text.data(), text.size()) != nullptr) found = text.data();
  }
  ::freeifaddrs(all);
  return found;
}

/// Host in the address of the dashboard, for the address that the server listens on.
std::string host_of(const std::string& address) {
  if (address == "127.0.0.1") return "localhost";
  if (address == "0.0.0.0" || address == "::") {
    const std::string own = own_address();
    return own.empty() ? "localhost" : own;
  }
  return address.find(':') == std::string::npos ? address : "[" + address + "]";
}

}  // namespace

Result<net::ServerOptions> server_options(const Options& options) {
  net::ServerOptions server;
  server.address = options.address;
  server.port = options.port;
  server.allowed_origins = options.allowed_origins;
  server.allowed_hosts = options.allowed_hosts;
  server.goodbye = std::chrono::seconds{4};  // chosen: a page on a busy machine may be behind
  if (!options.needs_token) return server;
  Result<std::string> token = net::make_token();
  if (!token) return fail(token.error());
  server.token = std::move(*token);
  return server;
}

std::string link(const net::ServerOptions& server, std::uint16_t port) {
  const std::string page = fmt::format("http://{}:{}/", host_of(server.address), port);
  return server.token.empty() ? page : page + "?token=" + server.token;
}

}  // namespace chicane::apps
