// SPDX-License-Identifier: MIT
#include "chicane/runtime/run_limit.hpp"

#include <chrono>
#include <string>
#include <thread>
#include <utility>

namespace chicane::runtime {
namespace {

constexpr auto kNap = std::chrono::milliseconds(10);
constexpr const char* kOpenRoad = "the road is open: it has no laps";

}  // namespace

RunLimit::~RunLimit() { retire(); }

lap_time::LimitAnswer RunLimit::first_answer(const path::Track& track) {
  return {.why_not = track.centre().is_closed() ? "it is still being computed" : kOpenRoad};
}

void RunLimit::search(const path::Track& track, const scenario::Scenario& scenario) {
  if (!track.centre().is_closed()) return give_up(kOpenRoad);
  retire();
  search_ = std::make_unique<LimitSearch>(
      track, scenario, [this](Result<std::shared_ptr<const lap_time::Limit>> limit) {
        answer_ = std::make_shared<const lap_time::LimitAnswer>(
            limit ? lap_time::LimitAnswer{.found = *std::move(limit)}
                  : lap_time::LimitAnswer{.why_not = limit.error().message});
        has_news_.store(true, std::memory_order_release);
        if (on_news_) on_news_(*answer_);
      });
}

void RunLimit::give_up(std::string why) {
  retire();
  answer_ = std::make_shared<const lap_time::LimitAnswer>(lap_time::LimitAnswer{.why_not = std::move(why)});
}

/// The search before tells nothing any more; its thread is waited for when it has ended by itself.
void RunLimit::retire() {
  if (search_) {
    search_->cancel();
    retired_.push_back(std::move(search_));
  }
  std::erase_if(retired_, [](const auto& search) { return search->has_ended(); });
  has_news_ = false;
  answer_.reset();
}

std::shared_ptr<const lap_time::LimitAnswer> RunLimit::news() noexcept {
  if (!has_news_.exchange(false, std::memory_order_acquire)) return nullptr;
  return answer_;
}

void RunLimit::end() {
  if (search_) search_->cancel();
}

void RunLimit::compare(telemetry::RunSummary& run, const std::atomic<bool>& wants_stop) {
  while (is_searching() && !run.laps.empty() && !wants_stop) std::this_thread::sleep_for(kNap);
  end();  // from here on nobody writes the answer
  if (answer_ == nullptr) {
    run.why_no_limit = "the run ended before it was computed";
  } else if (answer_->found == nullptr) {
    run.why_no_limit = answer_->why_not;
  } else {
    telemetry::compare_with_limit(run, answer_->found->times);
  }
}

}  // namespace chicane::runtime
