// SPDX-License-Identifier: MIT
// Limit of the current run: searched during the run, again after a change of grip or mass.
#include "chicane/live/run_limit.hpp"

#include <thread>

#include "chicane/run/plan_cache.hpp"

namespace chicane::live {
namespace {

// Chosen.
constexpr auto kAnswerPoll = std::chrono::milliseconds(10);  // period of looking for the answer at the end
constexpr auto kSettle = std::chrono::milliseconds(300);     // time without changes before a new search
constexpr const char* kChanged = "the car's grip or mass has changed: it is being computed anew";
constexpr const char* kOpenRoad = "the road is open: it has no laps";

}  // namespace

RunLimit::RunLimit(std::function<void(const lap_time::LimitAnswer&)> on_news)
    : on_news_{std::move(on_news)}, search_{&RunLimit::found, [this](const lap_time::LimitAnswer& answer) {
                                              tell(answer);
                                            }} {}

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
  search_.begin({.track = *track_, .scenario = scenario_, .first_lap = first_lap_});
}

lap_time::LimitAnswer RunLimit::found(const Request& request, const std::function<bool()>& is_wanted) {
  const std::optional<lap_time::PlantLimit> known = run::known_limit(request.scenario, request.track);
  const Result<lap_time::PlantLimit> limit =
      known ? *known
            : run::limit_of(request.scenario, request.track,
                            {.wants_witness = false,
                             .budget = kBudget,
                             .go_on = [&](std::string_view, int, double) { return is_wanted(); }});
  lap_time::LimitAnswer answer{.first_lap = request.first_lap};
  if (!limit)
    answer.why_not = limit.error().message;
  else if (!limit->is_whole())
    answer.why_not = limit->is_cut_short
                         ? "its search takes longer than beside a run; `chicane limit` finds it"
                         : lap_time::kNoOptimum;
  else
    answer.found = std::make_shared<const lap_time::Limit>(lap_time::bound_from_start(request.track, *limit));
  return answer;
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
    // From laps completed to the next whole lap: numbers begin at 1, the running lap is left out.
    constexpr int kNext = 2;
    searched.friction_scale = asked.friction_scale;
    searched.mass_scale = asked.mass_scale;
    first_lap_ = frame.begins ? 1 : frame.lap + kNext;
    const bool is_announced = begins_at_.has_value();
    retire();
    begins_at_ = Clock::now() + kSettle;
    if (!is_announced) tell({.why_not = kChanged, .first_lap = first_lap_});
  }
  if (begins_at_ && Clock::now() >= *begins_at_) begin();
}

void RunLimit::give_up(std::string why) {
  retire();
  track_.reset();
  begins_at_.reset();
  answer_ = std::make_shared<const lap_time::LimitAnswer>(lap_time::LimitAnswer{.why_not = std::move(why)});
}

void RunLimit::retire() {
  search_.cancel();
  has_news_ = false;
  answer_.reset();
}

std::shared_ptr<const lap_time::LimitAnswer> RunLimit::news() noexcept {
  if (!has_news_.exchange(false, std::memory_order_acquire)) return nullptr;
  return answer_;
}

void RunLimit::end() {
  begins_at_.reset();
  search_.cancel();
}

bool RunLimit::is_awaited(const telemetry::RunSummary& run) const noexcept {
  return is_searching() && run.laps.size() >= static_cast<std::size_t>(first_lap_);
}

void RunLimit::compare(telemetry::RunSummary& run, const std::atomic<bool>& wants_stop,
                       std::chrono::milliseconds patience) {
  if (begins_at_ && is_awaited(run)) begin();
  const Clock::time_point end_of_patience = Clock::now() + patience;
  while (is_awaited(run) && !wants_stop && Clock::now() < end_of_patience)
    std::this_thread::sleep_for(kAnswerPoll);
  const bool is_cut_short = is_searching();
  end();  // no thread writes the answer after this
  if (is_cut_short || answer_ == nullptr) {
    run.why_no_limit = "the run ended before it was computed";
  } else if (answer_->found == nullptr) {
    run.why_no_limit = answer_->why_not;
  } else {
    telemetry::compare_with_limit(run, answer_->found->times, answer_->first_lap);
  }
}

}  // namespace chicane::live
