// SPDX-License-Identifier: MIT
#include "chicane/telemetry/lap_ledger.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <string_view>
#include <utility>

namespace chicane::telemetry {
namespace {

constexpr std::string_view kManual = "manual.is_on";
constexpr std::string_view kFault = "fault.";

/// What says nothing of how a lap was driven: the pace, and where a person's hands are.
bool is_left_out(std::string_view name) {
  return name.starts_with("run.") || (name.starts_with("manual.") && name != kManual);
}

}  // namespace

void LapLedger::restart() {
  std::erase_if(log_, [](const Noted& each) { return each.name.starts_with(kFault); });
  fold(log_.size());
}

void LapLedger::add(const Change& change) {
  if (change.starts_anew) return begin();
  if (is_left_out(change.name.view())) return;
  if (log_.size() >= kMostKept) fold(kMostKept / 2);
  log_.push_back({change.time, std::string(change.name.view()), std::string(change.value.view())});
}

/// Of the oldest `count` only what they came to is kept.
void LapLedger::fold(std::size_t count) {
  std::map<std::string, std::string> outcome;
  const auto end = log_.begin() + static_cast<std::ptrdiff_t>(count);
  for (auto each = log_.begin(); each != end; ++each) outcome[each->name] = std::move(each->value);
  std::vector<Noted> folded;
  for (auto& [name, value] : outcome) folded.push_back({kBefore, name, std::move(value)});
  std::move(end, log_.end(), std::back_inserter(folded));
  log_ = std::move(folded);
}

LapSetup LapLedger::setup(double end, double lap_time) const {
  const double start = end - lap_time;
  LapSetup setup;
  std::map<std::string, std::string> settings;
  std::map<std::string, bool> faults;  // that acted in the lap, or act still
  double by_hand_since = end;          // later than this nobody's hands count
  double by_hand = 0.0;
  for (const Noted& each : log_) {
    if (each.time > end) break;
    const bool is_on = each.value != "false";
    if (each.name == kManual) {
      by_hand += std::max(0.0, std::max(start, each.time) - std::max(start, by_hand_since));
      by_hand_since = is_on ? each.time : end;
    } else if (each.name.starts_with(kFault)) {
      // One that was over before the lap began did not act in it.
      if (is_on || each.time > start)
        faults[each.name.substr(kFault.size())] = true;
      else
        faults.erase(each.name.substr(kFault.size()));
    } else {
      std::string& value = settings[each.name];
      setup.is_mixed |= each.time > start && value != each.value;
      value = each.value;
    }
  }
  by_hand += std::max(0.0, end - std::max(start, by_hand_since));
  setup.by_hand_share = lap_time > 0.0 ? std::clamp(by_hand / lap_time, 0.0, 1.0) : 0.0;
  for (auto& [name, value] : settings) {
    setup.names.push_back(name);
    setup.values.push_back(std::move(value));
  }
  for (const auto& [name, acted] : faults) setup.faults.push_back(name);
  return setup;
}

}  // namespace chicane::telemetry
