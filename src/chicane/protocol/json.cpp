// SPDX-License-Identifier: MIT
// JSON texts, and documents for the page that draws results.
#include "chicane/protocol/json.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace chicane::protocol {

std::string json_text(const Json& json, JsonLayout layout) {
  return json.dump(layout == JsonLayout::kIndented ? 2 : -1, ' ', layout == JsonLayout::kAscii,
                   Json::error_handler_t::replace);
}

Json parse_json(std::string_view text) { return Json::parse(text, nullptr, false); }

tl::expected<Json, JsonError> read_json(std::string_view text) {
  try {
    return Json::parse(text);
  } catch (const Json::parse_error& error) {
    return tl::unexpected(JsonError{error.byte});
  } catch (const Json::exception&) {
    return tl::unexpected(JsonError{});
  }
}

namespace {

constexpr double kSteps =
    1e4;  // least resolution of an axis, in steps; chosen: beyond the pixels of a screen

/// Steps per unit, a power of ten, to which the coordinates of an axis are rounded: of values `axis`, `axis`
/// + 2, …
double steps_per_unit(const std::vector<double>& values, std::size_t axis) {
  double low = std::numeric_limits<double>::max(), high = -low, steps = 1.0;
  for (std::size_t i = axis; i < values.size(); i += 2) {
    if (!std::isfinite(values[i])) continue;
    low = std::min(low, values[i]);
    high = std::max(high, values[i]);
  }
  const double extent = std::max(1e-12, high > low ? high - low : std::fabs(low));
  while (steps * extent < kSteps) steps *= 10.0;
  while (steps * extent > 10.0 * kSteps) steps /= 10.0;
  return steps;
}

}  // namespace

ReportDocument::ReportDocument(std::string_view kind, std::string_view title)
    : json_{{"kind", kind}, {"title", title}, {"sections", Json::array()}} {
  begin_section("");
}

void ReportDocument::begin_section(std::string_view title) {
  json_["sections"].push_back({{"title", title}, {"parts", Json::array()}});
}

void ReportDocument::add_text(std::string_view words) {
  parts().push_back({{"part", "text"}, {"text", words}});
}

void ReportDocument::add_table(const std::vector<std::string>& columns, Json rows) {
  parts().push_back({{"part", "table"}, {"title", ""}, {"columns", columns}, {"rows", std::move(rows)}});
}

void ReportDocument::add_grid(std::string_view title, const std::vector<std::string>& columns, Json rows) {
  parts().push_back({{"part", "grid"}, {"title", title}, {"columns", columns}, {"rows", std::move(rows)}});
}

void ReportDocument::begin_chart(std::string_view title, std::string_view x_name) {
  parts().push_back({{"part", "chart"}, {"title", title}, {"x", x_name}, {"series", Json::array()}});
}

void ReportDocument::begin_map(std::string_view title, std::string_view x_name) {
  begin_chart(title, x_name);
  parts().back()["part"] = "map";
}

void ReportDocument::add_series(std::string_view draw, std::string_view tone, std::string_view name,
                                const std::vector<double>& values) {
  const std::array steps{steps_per_unit(values, 0), steps_per_unit(values, 1)};
  Json rounded = Json::array();
  for (std::size_t i = 0; i < values.size(); ++i)
    rounded.push_back(std::round(values[i] * steps[i % 2]) / steps[i % 2]);
  parts().back()["series"].push_back(
      {{"draw", draw}, {"tone", tone}, {"name", name}, {"values", std::move(rounded)}});
}

}  // namespace chicane::protocol
