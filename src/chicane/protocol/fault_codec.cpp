// SPDX-License-Identifier: MIT
#include "chicane/protocol/fault_codec.hpp"

#include <fmt/format.h>

#include <optional>

#include "chicane/base/text.hpp"
#include "chicane/protocol/schema.hpp"

namespace chicane::protocol {
namespace {

constexpr double kLongest = 1e6;  // [s]

/// The number in [low, high] that `text` is; `otherwise` where it is empty.
Result<double> read(std::string_view key, std::string_view text, double low, double high, double otherwise) {
  return text.empty() ? otherwise : number_in(key, text, low, high);
}

}  // namespace

std::string expected_fault(std::string_view word) {
  std::vector<std::string_view> names;
  for (const sim::FaultKind& kind : sim::fault_kinds()) names.push_back(kind.name);
  const std::string_view best = nearest(word, names);
  return best.empty() ? "one of `chicane list faults`"
                      : fmt::format("one of `chicane list faults` (did you mean {}?)", best);
}

Result<sim::FaultEvent> read_fault(const FaultText& text) {
  const std::optional<sim::Fault> fault = sim::fault_named(text.name);
  if (!fault) {
    return fail(refusal("faults.name", text.name, expected_fault(text.name)));
  }
  const sim::FaultKind& kind = sim::kind_of(*fault);
  sim::FaultEvent event = sim::default_event(*fault, 0.0);
  if (text.at.empty()) return fail(refusal("faults.at_s", "", "when it begins [s]"));
  const auto at = read("faults.at_s", text.at, 0.0, kLongest, event.at);
  if (!at) return fail(at.error());
  const auto duration = read("faults.for_s", text.duration, 0.001, kLongest, event.duration);
  if (!duration) return fail(duration.error());
  if (kind.strength_meaning.empty() && !text.strength.empty())
    return fail(
        refusal("faults.strength", text.strength, fmt::format("none: {} has no strength", kind.name)));
  const auto strength = read("faults.strength", text.strength, kind.weakest, kind.strongest, event.strength);
  if (!strength) return fail(strength.error());
  event.at = *at;
  event.duration = *duration;
  event.strength = *strength;
  return event;
}

Result<sim::FaultEvent> parse_fault(std::string_view text) {
  FaultText parts;
  const auto cut = [](std::string_view& rest, char mark) {
    const std::size_t at = rest.find(mark);
    if (at == std::string_view::npos) return std::string{};
    std::string tail(rest.substr(at + 1));
    rest = rest.substr(0, at);
    return tail.empty() ? std::string(1, mark) : tail;  // "x@12+" says a plus and then nothing: no number
  };
  std::string_view rest = text;
  parts.strength = cut(rest, '*');
  parts.duration = cut(rest, '+');
  parts.at = cut(rest, '@');
  parts.name = rest;
  Result<sim::FaultEvent> event = read_fault(parts);
  if (event) return event;
  return fail(ErrorCode::kInvalidArgument,
              fmt::format("--fault {}: {}; written as NAME@SECOND+SECONDS*STRENGTH", printable(text),
                          event.error().message));
}

Result<sim::FaultEvent> read_switch(std::string_view name, std::string_view value) {
  if (value == "true") return parse_fault(fmt::format("{}@0", name));
  if (value.starts_with('+') || value.starts_with('*')) {
    if (const auto event = parse_fault(fmt::format("{}@0{}", name, value))) return event;
  }
  return fail(refusal(fmt::format("fault.{}", printable(name)), value,
                      "true, false or +SECONDS*STRENGTH in the range of `chicane list faults`"));
}

std::string write_fault(const sim::FaultEvent& event) {
  const sim::FaultKind& kind = sim::kind_of(event.fault);
  std::string text = fmt::format("{{name: {}, at_s: {}, for_s: {}", kind.name, event.at, event.duration);
  if (!kind.strength_meaning.empty()) text += fmt::format(", strength: {}", event.strength);
  return text + "}";
}

std::vector<std::string> fault_names() {
  std::vector<std::string> names;
  for (const sim::FaultKind& kind : sim::fault_kinds()) names.emplace_back(kind.name);
  return names;
}

std::vector<Control> fault_controls() {
  static const std::vector<std::string> keys = [] {
    std::vector<std::string> list = fault_names();
    for (std::string& name : list) name.insert(0, "fault.");
    return list;
  }();
  std::vector<Control> controls;
  for (std::size_t i = 0; i < keys.size(); ++i)
    controls.push_back({keys[i], switch_of(sim::fault_kinds()[i].meaning), false, &sim::fault_kinds()[i]});
  return controls;
}

}  // namespace chicane::protocol
