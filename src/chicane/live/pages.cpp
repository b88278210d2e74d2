// SPDX-License-Identifier: MIT
// Pages that the server of the dashboard answers to GET, and descriptions of runs for viewers.
#include "chicane/live/pages.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <memory>
#include <utility>

#include "chicane/protocol/json.hpp"
#include "chicane/protocol/schema_json.hpp"

namespace chicane::live {
namespace {

using protocol::Json;

std::function<net::Content()> json_page(std::function<std::string()> text) {
  return
      [text = std::move(text)] { return net::Content{.content_type = "application/json", .bytes = text()}; };
}

std::function<net::Content()> mode_page(const Json& mode) {
  return json_page([text = protocol::json_text(mode) + "\n"] { return text; });
}

}  // namespace

wire::Pages live_pages() { return {{"/mode.json", mode_page({{"mode", "live"}})}}; }

wire::Pages live_pages(const LiveSettings& settings) {
  wire::Pages pages = live_pages();
  // Hundreds of viewers may ask for the schema at once: make it once for each run, and share its bytes.
  struct Made {
    std::uint64_t version = 0;
    std::shared_ptr<const std::string> bytes{};
  };
  pages["/schema.json"] = [&settings, made = std::make_shared<Made>()] {
    if (!made->bytes || made->version != settings.schema_version())
      *made = {settings.schema_version(), std::make_shared<const std::string>(settings.schema_json())};
    return net::Content{.content_type = "application/json", .shared = made->bytes};
  };
  pages["/preset.yaml"] = [&settings] {
    return net::Content{
        .content_type = "application/yaml", .bytes = settings.preset_yaml(), .save_as = "preset.yaml"};
  };
  return pages;
}

void add_what_if(wire::Pages& pages, WhatIf& what_if) {
  pages["/what_if.json"] = json_page([&what_if] { return what_if.answer(); });
}

void add_rival(wire::Pages& pages, const Rival& rival) {
  pages["/rival.json"] = json_page([&rival] { return rival.answer(); });
}

wire::Pages replay_pages(const std::vector<ServedLog>& logs, double start) {
  wire::Pages pages;
  Json list = Json::array();
  for (const ServedLog& log : logs) {
    std::string url = fmt::format("/log/{}.mcap", list.size());
    if (!log.settings.empty()) {
      pages[fmt::format("/log/{}.settings.json", list.size())] =
          json_page([text = log.settings] { return text; });
    }
    list.push_back({{"name", log.name}, {"url", url}});
    pages[std::move(url)] = [file = log.file] {
      return net::Content{.content_type = "application/octet-stream", .file = file};
    };
  }
  pages["/mode.json"] = mode_page({{"mode", "replay"}, {"logs", std::move(list)}, {"start_s", start}});
  return pages;
}

void describe(const road::Track& track, protocol::Run& run) {
  constexpr double kRoadSpacing = 2.0;  // [m] between the drawn points of the road, in full size; chosen
  run.track = track.name();
  run.track_length = track.centre().length();
  run.is_closed = track.centre().is_closed();
  run.kerb_width = track.kerb_width();
  run.track_points = track.raw_points().size();
  run.track_fit = road::point_fit(track);
  run.road = protocol::road_lines(track, kRoadSpacing * run.vehicle.scale);
}

void describe(const scenario::Scenario& scenario, protocol::Run& run) {
  run.vehicle = scenario.vehicle;
  run.notices = scenario.notices;
  run.origin = protocol::origin_of(scenario);
  run.track_scale = scenario.size_of_track();
}

protocol::Run description(const run::ClosedLoop& loop) {
  const scenario::Scenario& scenario = loop.scenario();
  protocol::Run run;
  run.preset = scenario.preset;
  run.latency = scenario.latency;
  run.control_period = scenario.control_period;
  run.mode = "drive";
  run.guard = protocol::guard_facts(scenario.guard);
  describe(scenario, run);
  describe(loop.track(), run);
  protocol::describe(loop.controller(), run);
  run.faults = protocol::fault_names();
  return run;
}

}  // namespace chicane::live
