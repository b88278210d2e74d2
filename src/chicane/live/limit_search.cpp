// SPDX-License-Identifier: MIT
#include "chicane/live/limit_search.hpp"

#include <optional>
#include <utility>

#include "chicane/run/plan_cache.hpp"

namespace chicane::live {

namespace {

Result<lap_time::PlantLimit> bound_of(const road::Track& track, const scenario::Scenario& scenario,
                                      const std::atomic<bool>& is_wanted) {
  if (std::optional<lap_time::PlantLimit> known = run::known_limit(scenario, track)) return std::move(*known);
  const lap_time::PlantLimitOptions options{
      .wants_witness = false, .budget = LimitSearch::kBudget, .go_on = [&](std::string_view, int, double) {
        return is_wanted.load();
      }};
  Result<lap_time::PlantLimit> limit = run::limit_of(scenario, track, options);
  if (limit && !limit->is_whole())
    return fail(ErrorCode::kNotFound, "its search takes longer than beside a run; `chicane limit` finds it");
  return limit;
}

}  // namespace

LimitSearch::LimitSearch(road::Track track, const scenario::Scenario& scenario, OnEnd on_end)
    : on_end_{std::move(on_end)}, worker_{[this, track = std::move(track), scenario] {
        work(track, scenario);
      }} {
  worker_.wake();
}

LimitSearch::~LimitSearch() { cancel(); }

void LimitSearch::cancel() {
  const std::lock_guard lock(telling_);
  is_wanted_ = false;
}

void LimitSearch::work(const road::Track& track, const scenario::Scenario& scenario) {
  const Result<lap_time::PlantLimit> limit = bound_of(track, scenario, is_wanted_);
  {
    const std::lock_guard lock(telling_);
    if (is_wanted_ && !limit) on_end_(fail(limit.error()));
    if (is_wanted_ && limit)
      on_end_(std::make_shared<const lap_time::Limit>(lap_time::bound_from_start(track, *limit)));
  }
  has_ended_.store(true, std::memory_order_release);
}

}  // namespace chicane::live
