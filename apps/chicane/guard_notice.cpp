// SPDX-License-Identifier: MIT
#include "guard_notice.hpp"

#include <fmt/format.h>

namespace chicane::apps {

std::string guard_notice(const safety::GuardOptions& guard) {
  switch (guard.mode) {
    case safety::GuardMode::kOff:
      return "guard.mode=off: only range and rate of commands are limited; nothing stops the car on the road "
             "when sensors, link or controller fail (docs/safety.md)";
    case safety::GuardMode::kObserve:
      return "guard.mode=observe: the guard only reports; nothing stops the car on the road when sensors or "
             "controller fail (docs/safety.md)";
    case safety::GuardMode::kOn:
      break;
  }
  if (guard.blind_time > 0.0) return "";
  return "guard.blind_time_s=0: a car that gets no commands may leave the road; `chicane campaign` measures "
         "how often (docs/safety.md)";
}

void print_guard_notice(const Options& options, const safety::GuardOptions& guard) {
  const std::string notice = guard_notice(guard);
  if (!options.is_json && !notice.empty()) fmt::print(stderr, "{}\n", notice);
}

void print_notices(const scenario::Scenario& scenario) {
  for (const std::string& notice : scenario.notices) fmt::print(stderr, "{}\n", notice);
}

}  // namespace chicane::apps
