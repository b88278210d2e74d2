// SPDX-License-Identifier: MIT
#include "chicane/live/run_limit.hpp"

#include <chrono>
#include <string>
#include <thread>
#include <utility>

namespace chicane::live {
namespace {

constexpr auto kNap = std::chrono::milliseconds(10);
constexpr auto kSettle = std::chrono::milliseconds(300);
constexpr const char* kChanged = "the car's grip or mass has changed: it is being computed anew";
constexpr const char* kOpenRoad = "the road is open: it has no laps";

}  // namespace

RunLimit::~RunLimit() { retire(); }

lap_time::LimitAnswer RunLimit::first_answer(const road::Track& track) {
  return {.why_not = track.centre().is_closed() ? "it is still being computed" : kOpenRoad};
}

void RunLimit::search(const road::Track& track, const scenario::Scenario& scenario) {
  if (!track.centre().is_closed()) return give_up(kOpenRoad);
  track_ = track;
  scenario_ = scenario;
  first_lap_ = 1;
  begin();
}

void RunLimit::begin() {
  retire();
  begins_at_.reset();
  search_ = std::make_unique<LimitSearch>(
      *track_, scenario_,
      [this, first_lap = first_lap_](Result<std::shared_ptr<const lap_time::Limit>> limit) {
        tell(limit ? lap_time::LimitAnswer{.found = *std::move(limit), .first_lap = first_lap}
                   : lap_time::LimitAnswer{.why_not = limit.error().message, .first_lap = first_lap});
      });
}

void RunLimit::tell(lap_time::LimitAnswer answer) {
  answer_ = std::make_shared<const lap_time::LimitAnswer>(std::move(answer));
  has_news_.store(true, std::memory_order_release);
  if (on_news_) on_news_(*answer_);
}

void RunLimit::follow(const scenario::Scenario& now, const telemetry::Frame& frame) {
  if (!track_) return;
  sim::PlantDeviation& searched = scenario_.plant_options;
  const sim::PlantDeviation& asked = now.plant_options;
  const bool is_other =
      searched.friction_scale != asked.friction_scale || searched.mass_scale != asked.mass_scale;
  const bool counts_anew = frame.begins && first_lap_ > 1;
  if (is_other || counts_anew) {
    constexpr int kNext = 2;  // laps count from 1, and the one that goes on has begun with the car of before
    searched.friction_scale = asked.friction_scale;
    searched.mass_scale = asked.mass_scale;
    first_lap_ = frame.begins ? 1 : frame.lap + kNext;
    const bool is_told = begins_at_.has_value();
    retire();
    begins_at_ = Clock::now() + kSettle;
    if (!is_told) tell({.why_not = kChanged, .first_lap = first_lap_});
  }
  if (begins_at_ && Clock::now() >= *begins_at_) begin();
}

void RunLimit::give_up(std::string why) {
  retire();
  track_.reset();
  begins_at_.reset();
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
  begins_at_.reset();
  if (search_) search_->cancel();
}

bool RunLimit::is_awaited(const telemetry::RunSummary& run) const noexcept {
  return is_searching() && run.laps.size() >= static_cast<std::size_t>(first_lap_);
}

void RunLimit::compare(telemetry::RunSummary& run, const std::atomic<bool>& wants_stop,
                       std::chrono::milliseconds patience) {
  if (begins_at_ && is_awaited(run)) begin();
  const Clock::time_point end_of_patience = Clock::now() + patience;
  while (is_awaited(run) && !wants_stop && Clock::now() < end_of_patience) std::this_thread::sleep_for(kNap);
  const bool is_cut_short = is_searching();
  end();  // from here on no thread writes the answer
  if (is_cut_short || answer_ == nullptr) {
    run.why_no_limit = "the run ended before it was computed";
  } else if (answer_->found == nullptr) {
    run.why_no_limit = answer_->why_not;
  } else {
    telemetry::compare_with_limit(run, answer_->found->times, answer_->first_lap);
  }
}

}  // namespace chicane::live
