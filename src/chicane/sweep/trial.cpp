// SPDX-License-Identifier: MIT
#include "chicane/sweep/trial.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "chicane/base/angle.hpp"
#include "chicane/base/text.hpp"
#include "chicane/controller/registry.hpp"
#include "chicane/protocol/fault_codec.hpp"
#include "chicane/protocol/schema.hpp"

namespace chicane::sweep {
namespace {

constexpr std::string_view kFaultPart = "fault.";

std::string* part_of(protocol::FaultText& fault, std::string_view key) {
  if (key == "fault.name") return &fault.name;
  if (key == "fault.at_s") return &fault.at;
  if (key == "fault.for_s") return &fault.duration;
  if (key == "fault.strength") return &fault.strength;
  return nullptr;
}

std::optional<double> speed_in(const std::string& text) {
  const std::optional<double> value = number_in(text);
  return value && *value > 0.0 && *value < 1e6 ? value : std::nullopt;
}

bool is_speed(std::string_view key) { return key == "speed_mph" || key == "speed_mps"; }

Result<void> check_fault_part(std::string_view key, const std::string& text) {
  protocol::FaultText fault;
  fault.name = std::string(sim::fault_kinds().front().name);
  fault.at = "0";
  std::string* const part = part_of(fault, key);
  if (part == nullptr) {
    return fail(ErrorCode::kNotFound,
                fmt::format("{}: got an unknown key, expected fault.name, fault.at_s, fault.for_s or "
                            "fault.strength",
                            printable(key)));
  }
  *part = text;
  const Result<sim::FaultEvent> event = protocol::read_fault(fault);
  return event ? Result<void>{} : fail(event.error());
}

/// As a browser's URLSearchParams reads it.
std::string url_encoded(std::string_view text) {
  std::string encoded;
  for (const char c : text) {
    const bool is_plain = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                          c == '-' || c == '_' || c == '.';
    encoded += is_plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return encoded;
}

/// Each key once, with the value that wins, at the place of its last setting.
Settings winning(const Settings& settings) {
  Settings last;
  for (const auto& setting : settings) {
    std::erase_if(last, [&](const auto& each) { return each.first == setting.first; });
    last.push_back(setting);
  }
  return last;
}

/// The key and value of the reference speed of whichever controller drives.
std::optional<std::pair<std::string, std::string>> speed_setting(const protocol::Request& request) {
  const Result<scenario::Scenario> scenario = protocol::compose(request);
  if (!scenario) return std::nullopt;
  const auto* driver = controller::Registry::find(scenario->controller);
  const protocol::Parameter* row = protocol::find_option(driver->name, driver->speed_option);
  return std::pair{std::string(row->key), protocol::get_text(*scenario, *row)};
}

}  // namespace

Result<void> check_setting(std::string_view key, const std::string& text) {
  if (key == "scenario")
    return text.empty() ? fail(ErrorCode::kInvalidArgument, "scenario: got nothing, expected a name or file")
                        : Result<void>{};
  if (is_speed(key)) {
    if (speed_in(text)) return {};
    return fail(refusal(key, text, "a positive number"));
  }
  if (key == "fault") {
    const Result<sim::FaultEvent> event = protocol::parse_fault(text);
    return event ? Result<void>{} : fail(event.error());
  }
  if (key.starts_with(kFaultPart)) return check_fault_part(key, text);
  scenario::Scenario scratch;
  return protocol::set_text(scratch, key, text);
}

Result<protocol::Request> request_of(const Settings& settings) {
  protocol::Request request;
  protocol::FaultText fault;
  for (const auto& [key, text] : settings) {
    if (key == "scenario") {
      request.scenario_file = text;
    } else if (key == "speed_mps") {
      request.speed_mps = text;
    } else if (key == "speed_mph") {
      const std::optional<double> mph = speed_in(text);
      if (!mph) return fail(ErrorCode::kInvalidArgument, fmt::format("speed_mph: got {}", printable(text)));
      request.speed_mps = fmt::format("{}", mph_to_mps(*mph));
    } else if (key == "fault") {
      request.faults.push_back(text);
    } else if (std::string* const part = part_of(fault, key)) {
      *part = text;
    } else {
      request.settings.emplace_back(key, text);
    }
  }
  if (!fault.name.empty()) {
    std::string text = fmt::format("{}@{}", fault.name, fault.at.empty() ? "0" : fault.at);
    if (!fault.duration.empty()) text += "+" + fault.duration;
    if (!fault.strength.empty()) text += "*" + fault.strength;
    request.faults.push_back(std::move(text));
  }
  return request;
}

Result<scenario::Scenario> scenario_of(const Settings& settings) {
  const Result<protocol::Request> request = request_of(settings);
  return request ? protocol::compose(*request) : fail(request.error());
}

std::string shell_word(const std::string& text) {
  const bool is_plain = !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
           std::string_view("-_./:=+@,%*").find(static_cast<char>(c)) != std::string_view::npos;
  });
  if (is_plain && text.find('*') == std::string::npos) return text;
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

std::string command_of(const Settings& settings) {
  using Name = std::pair<std::string_view, std::string_view>;
  constexpr std::array kOptions{Name{"preset", "--preset"},
                                Name{"controller", "--controller"},
                                Name{"track", "--track"},
                                Name{"car", "--car"},
                                Name{"laps", "--laps"},
                                Name{"seed", "--seed"},
                                Name{"latency_ms", "--latency-ms"}};
  std::string command = "chicane drive --fast";
  const Result<protocol::Request> request = request_of(settings);
  if (!request) return command;
  if (!request->scenario_file.empty()) command += " " + shell_word(request->scenario_file);
  const Settings last = winning(request->settings);
  std::string rest;
  for (const auto& [key, text] : last) {
    const auto* const option = std::find_if(
        kOptions.begin(), kOptions.end(), [&, &name = key](const auto& each) { return name == each.first; });
    if (option != kOptions.end()) command += fmt::format(" {} {}", option->second, shell_word(text));
    if (option == kOptions.end()) rest += " --set " + shell_word(fmt::format("{}={}", key, text));
  }
  const auto speed = std::find_if(settings.rbegin(), settings.rend(),
                                  [](const auto& setting) { return is_speed(setting.first); });
  if (speed != settings.rend()) rest += fmt::format(" --speed-{} {}", speed->first.substr(6), speed->second);
  for (const std::string& fault : request->faults) rest += " --fault " + shell_word(fault);
  return command + rest;
}

std::string link_of(const Settings& settings) {
  const Result<protocol::Request> request = request_of(settings);
  if (!request || !request->scenario_file.empty() || !request->faults.empty()) return "";
  Settings held = winning(request->settings);
  for (const auto& [key, text] : held) {
    const bool is_name = key == "track" || key == "car" || key == "preset";
    if (is_name && text.find_first_of("/.") != std::string::npos) return "";
  }
  if (!request->speed_mps.empty()) {
    const auto speed = speed_setting(*request);
    if (!speed) return "";
    held.push_back(*speed);
  }
  std::string query;
  for (const auto& [key, text] : winning(held)) {
    if (key == "laps" || key == "time_limit_s") continue;  // how long it lasts is not what it is
    query += fmt::format("{}{}={}", query.empty() ? "" : "&", url_encoded(key), url_encoded(text));
  }
  return "http://localhost:4567/#run?" + query;
}

}  // namespace chicane::sweep
