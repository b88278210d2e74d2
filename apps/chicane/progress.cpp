// SPDX-License-Identifier: MIT
// Progress on the terminal: notices and the line of a run, the line of a completed lap, and the wait for a
// plan, with a page at the dashboard's address meanwhile.
#include "progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <string>
#include <utility>

#include "access.hpp"
#include "chicane/base/math.hpp"
#include "chicane/run/make.hpp"

namespace chicane::apps {
namespace {

using telemetry::Situation;

bool is_replaced(const Situation& now) {
  return now.rung != controller::Rung::kController && now.driver != Situation::Driver::kPerson;
}

bool is_stuck(const Situation& now, double time) {
  return now.stands_since >= 0.0 && time - now.stands_since >= telemetry::kStuckAfter;
}

}  // namespace

std::vector<std::string> RunNotices::look_at(const telemetry::Frame& frame) {
  if (frame.time < last_time_) *this = {};  // another run began
  last_time_ = frame.time;
  const Situation& now = frame.situation;
  if (now.driver == Situation::Driver::kPerson) said_.clear();
  // No event: report the end of the last one.
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
  // One sentence for a new event, and another one when it changes.
  const bool is_held = now.kind == telemetry::SituationKind::kGuardHolds;
  if (is_held && !is_stuck(now, frame.time) && !begins) return {};  // a known stop that has ended
  std::string text = sentence_of(now);
  if (const auto reason = reason_of(now); !reason.empty() && (begins || !is_held))
    text.append(": ").append(reason);
  if (is_stuck(now, frame.time)) text.append(". ").append(what_ends(now));
  if (text == said_ || (!begins && frame.time - said_at_ < telemetry::kAlarmPause)) return {};
  said_ = std::move(text);
  said_at_ = frame.time;
  return {fmt::format("{:.1f} s: {}", frame.time, said_)};
}

/// Line that reports the end of an event, once, after a pause.
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

constexpr std::chrono::milliseconds kTerminalPeriod{100};
constexpr double kLinePeriod = 10.0;  // seconds of the run

/// At most 80 columns.
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

Progress::Progress() : is_terminal_{isatty(STDERR_FILENO) == 1} {}

Progress::~Progress() {
  if (has_line_) fmt::print(stderr, "\n");
}

void Progress::show(const telemetry::Frame& frame) {
  for (const std::string& notice : notices_.look_at(frame)) say(notice);
  if (is_terminal_) {
    const Clock::time_point now = Clock::now();
    if (now < next_) return;
    next_ = now + kTerminalPeriod;
    has_line_ = true;
    fmt::print(stderr, "\r{}\x1b[K", line(frame));  // clears the rest of the old line
    std::fflush(stderr);
  } else if (frame.time >= next_run_time_) {
    next_run_time_ = frame.time + kLinePeriod;
    fmt::print(stderr, "{}\n", line(frame));
  }
}

void Progress::say(std::string_view line) {
  fmt::print(stderr, "{}{}\n", has_line_.exchange(false) ? "\n" : "", line);
}

namespace {

constexpr std::chrono::milliseconds kRedrawPeriod{100};
constexpr std::chrono::seconds kReportPeriod{10};
constexpr std::chrono::milliseconds kGoodbyeOfPage{50};

/// Road in SVG as a stroke of its mean width, with a dashed stroke on it; the caller appends the dash length.
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

/// Page shown while a lap is planned; `done`: share of the work [%], drawn on the road in the colour of plans
/// (web/src/styles/tokens.css).
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

/// State shared with the network thread, which answers while this one plans.
struct PlanWait::Page {
  std::string road;
  std::mutex mutex;
  std::string line;
  lap_time::PlanProgress now;
  std::unique_ptr<net::Server> server;  // last: destroyed first
};

std::string plan_line(const lap_time::PlanProgress& now, double elapsed, double budget) {
  const double per_work = now.work > 0.0 ? elapsed / now.work : 0.0;
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
    : scenario_{scenario}, server_{server}, is_terminal_{isatty(STDERR_FILENO) == 1} {}

PlanWait::~PlanWait() {
  clear_line();
  if (page_ && page_->server) (*server_)->port = page_->server->port();
}

run::PlanHooks PlanWait::hooks() {
  return {.on_progress = [this](const lap_time::PlanProgress& now) { show(now); },
          .say =
              [this](std::string_view line) {
                clear_line();
                fmt::print(stderr, "{}\n", line);
              }};
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
  fmt::print(stderr, "the lap is planned first; then the dashboard will be at {} (Ctrl-C ends)\n",
             link(options, page_->server->port()));
}

void PlanWait::show(const lap_time::PlanProgress& now) {
  const Clock::time_point time = Clock::now();
  const std::string line =
      plan_line(now, std::chrono::duration<double>(time - begin_).count(), run::plan_budget(scenario_));
  if (!shown_) open();
  if (page_) {
    const std::lock_guard lock(page_->mutex);
    page_->line = line;
    page_->now = now;
  }
  const Clock::duration period = is_terminal_ ? Clock::duration(kRedrawPeriod) : kReportPeriod;
  if (shown_ && time - *shown_ < period) return;
  const bool is_first = !shown_.has_value();
  shown_ = time;
  if (is_terminal_) {
    has_line_ = true;
    fmt::print(stderr, "\r{}\x1b[K", line);
    std::fflush(stderr);
  } else if (!is_first) {
    fmt::print(stderr, "{}\n", line);
  }
}

void PlanWait::clear_line() {
  if (std::exchange(has_line_, false)) fmt::print(stderr, "\r\x1b[K");
}

}  // namespace chicane::apps
