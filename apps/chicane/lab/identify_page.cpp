// SPDX-License-Identifier: MIT
// Page of `chicane identify`: a function for each section, in the order of the page.
#include "lab/identify_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "chicane/base/math.hpp"
#include "chicane/base/text.hpp"
#include "chicane/protocol/json.hpp"

namespace chicane::apps {
namespace {

using identify::Compared;
using identify::Estimate;
using identify::Identification;
using protocol::Json;
using protocol::ReportDocument;

constexpr std::size_t kMostStretches = 6;  // maps of predictions: two rows on a screen; chosen
constexpr std::size_t kMostDots = 1500;    // dots of one chart: more cover each other; chosen

/// Section of the estimates.
void add_numbers(ReportDocument& document, const Identification& found) {
  document.begin_section("Numbers");
  document.add_text(
      "Dot: found. Bar: 95 % interval. Stroke: what the search began with. "
      "Not excited: the log hardly narrows what was assumed.");
  Json rows = Json::array();
  for (const Estimate& each : found.estimates)
    rows.push_back({Json{{"text", each.key}, {"is_code", true}}, number_text(each.value, 4),
                    fmt::format("{} to {}", number_text(each.low, 3), number_text(each.high, 3)),
                    number_text(each.assumed, 4), each.unit,
                    Json{{"text", ""}, {"interval", {each.low, each.high, each.value, each.assumed}}},
                    each.is_excited ? "" : "not excited"});
  document.add_table({"number", "found", "95 % interval", "assumed", "unit", "drawn", "remark"},
                     std::move(rows));
}

/// Map of one stretch: measured path, and prediction from the last known sample on. Dots mark whole seconds.
void add_path(ReportDocument& document, const identify::PredictedStretch& stretch) {
  std::vector<double> measured, model, measured_seconds, model_seconds;
  double next = stretch.known;
  for (const Compared& each : stretch.samples) {
    measured.insert(measured.end(), {each.x, each.y});
    if (each.time >= stretch.known) model.insert(model.end(), {each.model_x, each.model_y});
    if (each.time < next) continue;
    measured_seconds.insert(measured_seconds.end(), {each.x, each.y});
    model_seconds.insert(model_seconds.end(), {each.model_x, each.model_y});
    next += 1.0;
  }
  document.begin_map(fmt::format("from {} s, dots a second apart [m]", number_text(stretch.known, 4)),
                     "x [m]");
  document.add_series("line", "ink", "measured", measured);
  document.add_series("line", "other", "predicted", model);
  document.add_series("dots", "ink", "", measured_seconds);
  document.add_series("dots", "other", "", model_seconds);
}

/// Section of the predictions on held-out ends.
void add_predictions(ReportDocument& document, const Identification& found) {
  document.begin_section("Predicted against measured");
  if (found.stretches.empty())
    return document.add_text("No end of a log was held out (`--hold-out`), or none was long enough.");
  document.add_text(
      "The end of each log was not fitted. The model knows half a second of samples, "
      "and goes on from there by the commands alone. Root mean square:");
  Json rows = Json::array();
  for (const identify::PredictionError& error : found.held_out)
    rows.push_back({number_text(error.ahead, 3), fmt::format("{:.3f}", error.position),
                    fmt::format("{:.2f}", error.yaw * 180.0 / kPi), fmt::format("{:.3f}", error.speed)});
  document.add_table({"ahead [s]", "place [m]", "yaw [deg]", "speed [m/s]"}, std::move(rows));
  document.begin_chart("distance of predicted from measured place, a line for each stretch [m]",
                       "time ahead [s]");
  for (const identify::PredictedStretch& stretch : found.stretches) {
    std::vector<double> line;
    for (const Compared& each : stretch.samples)
      line.insert(line.end(),
                  {each.time - stretch.known, hypot(each.model_x - each.x, each.model_y - each.y)});
    document.add_series("line", "ink", "", line);
  }
  const std::size_t step = std::max<std::size_t>(1, found.stretches.size() / kMostStretches);
  for (std::size_t i = 0, shown = 0; i < found.stretches.size() && shown < kMostStretches; i += step, ++shown)
    add_path(document, found.stretches[i]);
}

/// Kind of residual.
struct ResidualKind {
  const char* name;               ///< title of its chart
  double (*of)(const Compared&);  ///< model less measurement
};

/// Correlation of a residual with the next one: 0 for white noise.
double lag_one_correlation(const std::vector<double>& values) {
  double product = 0.0, square = 0.0;
  for (std::size_t i = 0; i + 1 < values.size(); ++i) {
    product += values[i] * values[i + 1];
    square += values[i] * values[i];
  }
  return square > 0.0 ? product / square : 0.0;
}

/// Section of the residuals of the fit.
void add_residuals(ReportDocument& document, const Identification& found) {
  static constexpr ResidualKind kKinds[] = {
      {"along the car [m]",
       [](const Compared& c) { return cos(c.psi) * (c.model_x - c.x) + sin(c.psi) * (c.model_y - c.y); }},
      {"across the car [m]",
       [](const Compared& c) { return cos(c.psi) * (c.model_y - c.y) - sin(c.psi) * (c.model_x - c.x); }},
      {"yaw [deg]", [](const Compared& c) { return (c.model_psi - c.psi) * 180.0 / kPi; }},
      {"speed [m/s]", [](const Compared& c) { return c.model_speed - c.speed; }}};
  document.begin_section("Residuals");
  document.add_text(
      "Model less measurement at the fitted samples. Noise of sensors has no pattern; "
      "what repeats in every bend is what the model lacks. "
      "The last figure is the correlation of a residual with the next one: 0 for noise alone.");
  const std::size_t step = std::max<std::size_t>(1, found.fitted.size() / kMostDots);
  for (const ResidualKind& kind : kKinds) {
    if (found.fitted.empty()) continue;
    std::vector<double> values, dots;
    double squares = 0.0;
    for (std::size_t i = 0; i < found.fitted.size(); ++i) {
      values.push_back(kind.of(found.fitted[i]));
      squares += values.back() * values.back();
      if (i % step == 0) dots.insert(dots.end(), {found.fitted[i].time, values.back()});
    }
    document.begin_chart(fmt::format("{}: rms {}, correlation {:.2f}", kind.name,
                                     number_text(std::sqrt(squares / static_cast<double>(values.size())), 3),
                                     lag_one_correlation(values)),
                         "time [s]");
    document.add_series("dots", "ink", "", dots);
  }
}

/// Section of the correlations of the estimates.
void add_correlations(ReportDocument& document, const Identification& found) {
  document.begin_section("Correlations");
  document.add_text(
      "Of the errors of two numbers. Near 1 or −1 the log tells only their difference, or their sum.");
  std::vector<std::string> columns{"number"};
  Json rows = Json::array();
  for (std::size_t i = 0; i < found.correlations.size(); ++i) {
    columns.push_back(std::to_string(i + 1));
    Json row{fmt::format("{} {}", i + 1, found.estimates[i].key)};
    for (std::size_t j = 0; j < found.correlations[i].size(); ++j) {
      const double value = found.correlations[i][j];
      row.push_back(i == j ? Json("") : Json{{"text", fmt::format("{:.2f}", value)}, {"signed", value}});
    }
    rows.push_back(std::move(row));
  }
  document.add_grid("", columns, std::move(rows));
}

/// Section of the slip that the logs cover.
void add_slip(ReportDocument& document, const Identification& found) {
  document.begin_section("Slip covered");
  document.add_text(
      fmt::format("Fitted samples by the slip of an axle, over the slip at its peak force. "
                  "Grip counts as known where 1 % of the samples lie beyond {:.0f} % at one axle and {:.0f} "
                  "% at the other. "
                  "The log reached {:.0f} % at the front and {:.0f} % at the rear.",
                  100.0 * identify::kRaceUse, 100.0 * identify::kLeastRaceUse, 100.0 * found.use_front,
                  100.0 * found.use_rear));
  for (const auto& [name, bins] :
       {std::pair{"front", found.slip.front}, std::pair{"rear", found.slip.rear}}) {
    double all = 0.0;
    for (const int count : bins) all += count;
    std::vector<double> bars;
    for (std::size_t i = 0; i < bins.size(); ++i)
      bars.insert(bars.end(), {identify::SlipCover::kBin * static_cast<double>(i), 0.0,
                               identify::SlipCover::kBin, 100.0 * bins[i] / std::max(1.0, all)});
    document.begin_chart(fmt::format("{} axle: share of the samples [%]", name),
                         "slip over the slip at the peak");
    document.add_series("cells", "soft", "", bars);
    document.add_series("mark", "other", "needed at one axle", {identify::kRaceUse});
    document.add_series("mark", "ink", "peak", {1.0});
  }
}

}  // namespace

std::string identify_document(const Identification& found, const IdentifyPageWords& words) {
  ReportDocument document("identify", fmt::format("A car from {}", words.logs));
  document.add_text(fmt::format("{:.0f} s of driving. Left unexplained: {:.3f} m, {:.2f} deg, {:.3f} m/s.",
                                found.driven, found.residual[0], found.residual[1] * 180.0 / kPi,
                                found.residual[2]));
  if (!words.command.empty()) document.add_text(fmt::format("To drive it: `{}`", words.command));
  if (!words.advice.empty()) document.add_text(words.advice);
  add_numbers(document, found);
  add_predictions(document, found);
  add_residuals(document, found);
  add_correlations(document, found);
  add_slip(document, found);
  return document.text();
}

}  // namespace chicane::apps
