// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>

#include "support/chicane_test.hpp"

namespace chicane::test {

/// From a published log of the original (udacity/CarND-MPC-Project issue 45).
inline constexpr const char* kRealTelemetry =
    R"(42["telemetry",{"ptsx":[-32.16173,-43.49173,-61.09,-78.29172,-93.05002,-107.7717],)"
    R"("ptsy":[113.361,105.941,92.88499,78.73102,65.34102,50.57938],"psi_unity":4.120315,"psi":3.733667,)"
    R"("x":-40.62008,"y":108.7301,"steering_angle":0,"throttle":0,"speed":2.995219E-06}])";

inline std::string with(const std::string& from, const std::string& to) {
  std::string text = kRealTelemetry;
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

inline std::string without(const std::string& key) {
  nlohmann::json event = nlohmann::json::parse(std::string(kRealTelemetry).substr(2));
  event[1].erase(key);
  return "42" + event.dump();
}

inline std::string repeat(const std::string& text, int count) {
  std::string result;
  for (int i = 0; i < count; ++i) result += text;
  return result;
}

/// `[1,1,1]` for ("1", 3).
inline std::string repeated(const std::string& element, int count) {
  return "[" + repeat(element + ",", count - 1) + element + "]";
}

/// Telemetry that must be refused.
struct Hostile {
  std::string text;
  std::string words;  ///< that the reason must contain
};

/// These texts are refused with the same words.
struct Refused {
  std::string words;
  std::vector<std::string> texts;
};

inline std::vector<Hostile> hostile_messages() {
  const std::vector<Refused> framing{
      {"digit", {" ", "{}", "\xff\xfe\xfd"}},
      {"no array", {"42", "42{}", "42/namespace,[]", "42null", "42" + repeat("9", 60'000)}},
      {"name", {"42[]", "42[null]", "42[\"telemetry\",{},{}]"}},
      {"not JSON at byte", {"42["}},
      {"not JSON",
       {"42[\"telemetry\",{}]]", "42[\"telemetry\",{\"x\":1", "42[\"telemetry\",{'x':1}]",
        "42[\"telemetry\",{\"x\":+1}]", "42[\"telemetry\",{\"x\":0x10}]", "42[\"tele\xffmetry\",{}]",
        "42[\"telemetry\",{\"x\":\"\xc3\x28\"}]", "42[\"telemetry\",{\"x\":\"\\ud800\"}]",
        "42" + repeat("[", 10'000)}},
      {"at most 65536", {"42[\"telemetry\",\"" + repeat("x", 70'000) + "\"]", repeat("4", 70'000)}}};
  std::vector<Hostile> list{
      {"", "empty"},
      {"42[\"telemetry\",{\"x\":NaN}]", "x: got NaN, expected a number"},
      {"42[\"telemetry\",{\"x\":-Infinity}]", "x: got -Infinity, expected a number"},
      {"42[\"telemetry\"," + repeat("[", 10'000) + repeat("]", 10'000) + "]", "an object or null"},
      {"42[\"telemetry\"," + repeat("{\"x\":", 10'000) + "1" + repeat("}", 10'000) + "]", "missing"},
      // The payload.
      {R"(42["telemetry"])", "telemetry: without data"},
      {R"(42["telemetry",{}])", "ptsx: missing"},
      {R"(42["telemetry",[]])", "got an array of 0, expected an object or null"},
      {R"(42["telemetry",7])", "got 7"},
      {R"(42["telemetry","null"])", "got \"null\""},
      // One field.
      {with("\"x\":-40.62008", "\"x\":\"-40.62008\""), "x: got \"-40.62008\", expected a number"},
      {with("\"x\":-40.62008", "\"x\":\"NaN\""), "x: got \"NaN\""},
      {with("\"y\":108.7301", "\"y\":\"INFINITY\""), "y: got \"INFINITY\""},
      {with("\"x\":-40.62008", "\"x\":null"), "x: got null"},
      {with("\"x\":-40.62008", "\"x\":{}"), "x: got an object"},
      {with("\"x\":-40.62008", "\"x\":1e999"), "too large"},
      {with("\"x\":-40.62008", "\"x\":1e308"), "x: got 1e+308, expected a number in"},
      {with("\"x\":-40.62008", "\"x\":99999999999999999999999999"), "x: got"},
      {with("\"x\":-40.62008", "\"x\":\"" + repeat("<script>", 1000) + "\""), "x: got \"<script>"},
      {with("\"psi\":3.733667", "\"psi\":1e9"), "psi: got"},
      {with("\"speed\":2.995219E-06", "\"speed\":-1"), "speed: got -1, expected a number in [0, 1000]"},
      {with("\"speed\":2.995219E-06", "\"speed\":1e6"), "speed: got"},
      {with("\"throttle\":0", "\"throttle\":2"), "throttle: got 2"},
      {with("\"throttle\":0", "\"throttle\":true"), "throttle: got true"},
      {with("\"steering_angle\":0", "\"steering_angle\":25"), "steering_angle: got 25"},
      // Waypoints.
      {with("[-32.16173,", "["), "ptsx has 5 points, ptsy 6"},
      {with("[113.361,", "[113.361,1,"), "ptsx has 6 points, ptsy 7"},
      {with("[-32.16173,", "[\"-32.16173\","), "ptsx[0]: got \"-32.16173\""},
      {with("-107.7717]", "null]"), "ptsx[5]: got null"},
      {with("-107.7717]", "nan]"), "ptsx[5]: got nan, expected a number"},
      {with("-107.7717]", "1e300]"), "ptsx[5]: got 1e+300"},
      {with("\"speed\":2.995219E-06", "\"speed\":-0.01"), "speed: got -0.01, expected a number in [0, 1000]"},
      {with("[-32.16173,", "[[1],"), "ptsx[0]: got an array of 1"},
      {with("[-32.16173,", "[" + repeat("1,", 30)), "at most 32"},
      {with("[-32.16173,", "[" + repeat("1,", 30'000)), "at most 32"},
      {with("\"ptsx\":[", "\"ptsx\":5,\"was\":["), "ptsx: got 5"},
      {with("\"ptsx\":[", "\"ptsx\":{},\"was\":["), "ptsx: got an object"},
      {with("\"speed\":2.995219E-06", "\"speed\":0,\"speed\":\"twice\""), "speed: got \"twice\""},
      // Decimal commas.
      {with("-40.62008", "-40,62008"), "decimal comma"},
      {with("\"psi\":3.733667", "\"psi\":3,733667"), "LC_NUMERIC=C"},
      {with("\"speed\":2.995219E-06", "\"speed\":2,995219E-06"), "decimal comma"},
  };
  for (const auto& [words, texts] : framing)
    for (const std::string& text : texts) list.push_back({text, words});
  for (const std::string key : {"ptsx", "ptsy", "psi", "x", "y", "speed", "throttle", "steering_angle"})
    list.push_back({without(key), key + ": missing"});
  return list;
}

}  // namespace chicane::test
