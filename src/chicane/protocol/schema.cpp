// SPDX-License-Identifier: MIT
#include "chicane/protocol/schema.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <numeric>

namespace chicane::protocol {
namespace {

using scenario::Scenario;

Field field_of(const Scenario& scenario, const Parameter& parameter) {
  return parameter.field(const_cast<Scenario&>(scenario));  // read only through the result
}

tl::unexpected<Error> unexpected(const Parameter& parameter, std::string_view got) {
  return fail(ErrorCode::kInvalidArgument,
              fmt::format("{}: got {}, expected {}", parameter.key, got, expectation(parameter)));
}

/// The shortest text that reads back as `value`.
std::string number_text(double value) { return fmt::format("{}", value); }

Result<double> parse_number(const Parameter& parameter, std::string_view text) {
  if (parameter.may_be_infinite && (text == "inf" || text == ".inf"))
    return std::numeric_limits<double>::infinity();
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return unexpected(parameter, quoted(text));
  return value;
}

int edit_distance(std::string_view a, std::string_view b) {
  std::vector<int> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0);
  for (std::size_t i = 0; i < a.size(); ++i) {
    int diagonal = row[0]++;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const int substituted = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({substituted, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

}  // namespace

Kind Parameter::kind() const {
  if (!choices.empty()) return Kind::kChoice;
  static Scenario any;
  const Field where = field(any);
  if (std::holds_alternative<double*>(where)) return Kind::kNumber;
  if (std::holds_alternative<bool*>(where)) return Kind::kBool;
  if (std::holds_alternative<std::string*>(where)) return Kind::kText;
  return Kind::kInteger;
}

bool is_live(const Parameter& parameter) {
  constexpr std::array<std::string_view, 5> kWhatRuns{"plant", "controller", "seed", "control_period_ms",
                                                      "waypoints_sent"};
  return parameter.kind() != Kind::kText &&  // preset, track, car: names
         std::find(kWhatRuns.begin(), kWhatRuns.end(), parameter.key) == kWhatRuns.end();
}

const Parameter* find(std::string_view key) {
  const auto row =
      std::find_if(list().begin(), list().end(), [&](const Parameter& p) { return p.key == key; });
  return row == list().end() ? nullptr : &*row;
}

std::string quoted(std::string_view text) {
  constexpr std::size_t kMost = 60;
  std::string shown(text.substr(0, kMost));
  std::replace_if(
      shown.begin(), shown.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; }, '?');
  return shown.empty() ? "nothing" : text.size() > kMost ? shown + "…" : shown;
}

std::string_view nearest(std::string_view word, std::span<const std::string_view> known) {
  std::string_view best;
  if (word.size() > 100) return best;
  int best_distance = std::max(2, static_cast<int>(word.size()) / 4) + 1;
  for (const std::string_view candidate : known) {
    const bool unit_forgotten =
        candidate.starts_with(word) && candidate.size() > word.size() && candidate[word.size()] == '_';
    const int distance = unit_forgotten ? 1 : edit_distance(word, candidate);
    if (distance < best_distance) {
      best = candidate;
      best_distance = distance;
    }
  }
  return best;
}

std::string suggestion(std::string_view key) {
  std::vector<std::string_view> keys;
  for (const Parameter& parameter : list()) keys.push_back(parameter.key);
  std::string_view best = nearest(key, keys);
  const std::string_view name =
      key.substr(key.rfind('.') + 1);  // the right name in the wrong group, or without one
  for (const std::string_view known : keys) {
    if (best.empty() && known.ends_with(fmt::format(".{}", name))) best = known;
  }
  return best.empty() ? "" : fmt::format(" (did you mean {}?)", best);
}

std::string unknown_key(std::string_view key) {
  return fmt::format("got an unknown key, expected one of `chicane list parameters`{}", suggestion(key));
}

std::string expectation(const Parameter& parameter) {
  const std::string unit = parameter.unit.name.empty() ? "" : fmt::format(" {}", parameter.unit.name);
  const std::string range =
      fmt::format("in [{}, {}]{}{}", number_text(parameter.minimum), number_text(parameter.maximum), unit,
                  parameter.may_be_infinite ? " or inf" : "");
  switch (parameter.kind()) {
    case Kind::kNumber:
      return "a number " + range;
    case Kind::kInteger:
      return "an integer " + range;
    case Kind::kBool:
      return "true or false";
    case Kind::kChoice:
      return fmt::format("one of {}", fmt::join(parameter.choices, ", "));
    case Kind::kText:
      break;
  }
  return "text";
}

Value get(const Scenario& scenario, const Parameter& parameter) {
  struct Reader {
    const Parameter& row;
    Value operator()(const double* v) const { return *v * row.unit.divisor / row.unit.factor; }
    Value operator()(const int* v) const { return static_cast<double>(*v); }
    Value operator()(const std::uint64_t* v) const { return static_cast<double>(*v); }
    Value operator()(const bool* v) const { return *v; }
    Value operator()(const std::string* v) const { return *v; }
    Value operator()(const controller::LatencyHandling* v) const {
      return std::string(row.choices[static_cast<std::size_t>(*v)]);
    }
  };
  return std::visit(Reader{parameter}, field_of(scenario, parameter));
}

Result<void> set(Scenario& scenario, const Parameter& parameter, const Value& value) {
  const Field field = parameter.field(scenario);
  if (const auto* number = std::get_if<double>(&value)) {
    const bool infinite = parameter.may_be_infinite && *number == std::numeric_limits<double>::infinity();
    const bool in_range = *number >= parameter.minimum && *number <= parameter.maximum;  // false for NaN
    const bool whole = parameter.kind() == Kind::kNumber || *number == std::floor(*number);
    if (!(in_range || infinite) || !whole) return unexpected(parameter, number_text(*number));
    if (auto* const* real = std::get_if<double*>(&field)) {
      **real = *number * parameter.unit.factor / parameter.unit.divisor;
      return {};
    }
    if (auto* const* integer = std::get_if<int*>(&field)) {
      **integer = static_cast<int>(*number);
      return {};
    }
    if (auto* const* large = std::get_if<std::uint64_t*>(&field)) {
      **large = static_cast<std::uint64_t>(*number);
      return {};
    }
    return unexpected(parameter, number_text(*number));
  }
  if (const auto* flag = std::get_if<bool>(&value)) {
    auto* const* target = std::get_if<bool*>(&field);
    if (target == nullptr) return unexpected(parameter, *flag ? "true" : "false");
    **target = *flag;
    return {};
  }
  const std::string& text = std::get<std::string>(value);
  const auto choice = std::find(parameter.choices.begin(), parameter.choices.end(), text);
  if (!parameter.choices.empty() && choice == parameter.choices.end())
    return unexpected(parameter, quoted(text));
  if (auto* const* handling = std::get_if<controller::LatencyHandling*>(&field)) {
    **handling = static_cast<controller::LatencyHandling>(choice - parameter.choices.begin());
    return {};
  }
  auto* const* target = std::get_if<std::string*>(&field);
  if (target == nullptr || text.empty()) return unexpected(parameter, quoted(text));
  **target = text;
  return {};
}

Result<Value> parse(const Parameter& parameter, std::string_view text) {
  Value value;
  switch (parameter.kind()) {
    case Kind::kNumber:
    case Kind::kInteger: {
      const Result<double> number = parse_number(parameter, text);
      if (!number) return fail(number.error());
      value = *number;
      break;
    }
    case Kind::kBool:
      if (text != "true" && text != "false") return unexpected(parameter, quoted(text));
      value = text == "true";
      break;
    case Kind::kChoice:
    case Kind::kText:
      value = std::string(text);
      break;
  }
  Scenario scratch;
  if (const Result<void> checked = set(scratch, parameter, value); !checked) return fail(checked.error());
  return value;
}

std::string get_text(const Scenario& scenario, const Parameter& parameter) {
  const Value value = get(scenario, parameter);
  if (const auto* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  const double number = std::get<double>(value);
  const Field field = field_of(scenario, parameter);
  const auto* const* real = std::get_if<double*>(&field);
  // What people wrote has few digits: prefer them when they give the same bits inside.
  const std::string rounded = fmt::format("{:.15g}", number);
  double read = 0.0;
  std::from_chars(rounded.data(), rounded.data() + rounded.size(), read);
  const bool is_same = real != nullptr && read * parameter.unit.factor / parameter.unit.divisor == **real;
  return is_same ? rounded : number_text(number);
}

Result<void> set_text(Scenario& scenario, std::string_view key, std::string_view text) {
  const Parameter* parameter = find(key);
  if (parameter == nullptr) {
    return fail(ErrorCode::kNotFound, fmt::format("{}: {}", quoted(key), unknown_key(key)));
  }
  const Result<Value> value = parse(*parameter, text);
  return value ? set(scenario, *parameter, *value) : fail(value.error());
}

std::vector<Contradiction> contradictions(const Scenario& s) {
  std::vector<Contradiction> found;
  constexpr double kSame = 1e-9;  // [s]: the same time, written in ms and in s
  const controller::CubicMpcOptions& cubic = s.cubic_mpc;
  if (s.controller == "cubic-mpc" && cubic.latency_handling == controller::LatencyHandling::kInsideModel &&
      std::fabs(cubic.latency - cubic.step_length) > kSame) {
    found.push_back(
        {"cubic_mpc.latency_ms",
         fmt::format("got {:g} ms, expected cubic_mpc.step_length_s ({:g} s), because latency_handling "
                     "inside-model shifts by exactly one step",
                     cubic.latency * 1e3, cubic.step_length)});
  }
  return found;
}

}  // namespace chicane::protocol
