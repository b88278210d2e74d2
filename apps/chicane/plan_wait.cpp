// SPDX-License-Identifier: MIT
#include "plan_wait.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <utility>

#include "access.hpp"

namespace chicane::apps {
namespace {

constexpr std::chrono::milliseconds kRedrawPeriod{100};
constexpr std::chrono::seconds kReportPeriod{10};
constexpr std::chrono::milliseconds kGoodbyeOfPage{50};

net::Content waiting_page(const std::string& line) {
  return {.content_type = "text/html; charset=utf-8",
          .bytes = fmt::format(
              "<!doctype html><meta charset=\"utf-8\"><meta http-equiv=\"refresh\" "
              "content=\"1\"><title>chicane</title>"
              "<body style=\"color-scheme:light dark;margin:24px;font:14px/1.4 system-ui,sans-serif;"
              "background:light-dark(#f6f7f8,#0f1419);color:light-dark(#17202a,#e8edf2)\">"
              "<b>chicane</b><h1 style=\"font-size:28px;font-weight:500\">{}</h1><p>The dashboard follows "
              "here.</p>",
              line)};
}

}  // namespace

/// What the network thread answers while this one plans.
struct PlanWait::Page {
  std::mutex mutex;
  std::string line;
  std::unique_ptr<net::Server> server;  // last: it ends first
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

PlanWait::PlanWait(double budget, std::optional<net::ServerOptions>* server)
    : budget_{budget}, server_{server}, is_terminal_{isatty(STDERR_FILENO) == 1} {}

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
    return waiting_page(page->line);
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
  const std::string line = plan_line(now, std::chrono::duration<double>(time - begin_).count(), budget_);
  if (!shown_) open();
  if (page_) {
    const std::lock_guard lock(page_->mutex);
    page_->line = line;
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
