// SPDX-License-Identifier: MIT
#include "identify_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "chicane/base/angle.hpp"
#include "chicane/base/math.hpp"
#include "chicane/base/text.hpp"
#include "chicane/sweep/page_text.hpp"

namespace chicane::apps {
namespace {

using identify::Compared;
using identify::Estimate;
using identify::Identification;
using sweep::escaped;

constexpr const char* kMeasured = "#1c2430";
constexpr const char* kModel = "#c2571a";
constexpr const char* kFront = "#3b6ea5";
constexpr std::size_t kMostStretches = 6;
constexpr std::size_t kMostDots = 1500;  // dots in one plot

/// A range that has some room about its values.
struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  void add(double value) {
    if (!std::isfinite(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  void widen_to(double least) {
    if (!(high > low)) low = high = std::isfinite(low) ? low : 0.0;
    const double more = std::max(0.04 * (high - low), 0.5 * (least - (high - low)));
    low -= more;
    high += more;
  }
  [[nodiscard]] double width() const { return high - low; }
};

double tick_of(double width) {
  const double raw = width / 4.0, power = std::pow(10.0, std::floor(std::log10(raw)));
  for (const double step : {1.0, 2.0, 5.0})
    if (raw <= step * power) return step * power;
  return 10.0 * power;
}

/// A plot with axes. Ranges are set before anything is drawn.
class Plot {
 public:
  Plot(std::string title, std::string x_name, Range x, Range y, double height = 170.0)
      : title_{std::move(title)}, x_{x}, y_{y}, height_{height} {
    frame(std::move(x_name));
  }
  void line(const std::vector<std::pair<double, double>>& points, const char* colour, double opacity = 1.0) {
    std::string text;
    for (const auto& [x, y] : points) text += fmt::format("{:.1f},{:.1f} ", at_x(x), at_y(y));
    body_ += fmt::format("<polyline points='{}' fill=none stroke='{}' stroke-width=1.5 opacity={:.2g} />",
                         text, colour, opacity);
  }
  void dot(double x, double y, const char* colour, double radius) {
    body_ +=
        fmt::format("<circle cx={:.1f} cy={:.1f} r={:.1f} fill='{}' />", at_x(x), at_y(y), radius, colour);
  }
  void bar(double x, double width, double y, const char* colour) {
    body_ += fmt::format("<rect x={:.1f} y={:.1f} width={:.1f} height={:.1f} fill='{}' />", at_x(x), at_y(y),
                         at_x(x + width) - at_x(x), std::max(0.0, at_y(0.0) - at_y(y)), colour);
  }
  void mark(double x, const char* colour) {
    body_ +=
        fmt::format("<line x1={0:.1f} x2={0:.1f} y1={1} y2={2:.1f} stroke='{3}' stroke-dasharray='4 3' />",
                    at_x(x), kTop, kTop + height_, colour);
  }
  [[nodiscard]] std::string text() const {
    return fmt::format(
        "<figure><svg width={0} height={1:.0f} viewBox='0 0 {0} {1:.0f}' role=img aria-label='{2}' "
        "font-size=11 font-family='system-ui,sans-serif'>{3}</svg><figcaption>{2}</figcaption></figure> ",
        kWidth + kLeft + 12, height_ + kTop + 34, escaped(title_), body_);
  }

 private:
  static constexpr double kWidth = 400.0, kLeft = 46.0, kTop = 8.0;
  [[nodiscard]] double at_x(double x) const { return kLeft + kWidth * (x - x_.low) / x_.width(); }
  [[nodiscard]] double at_y(double y) const { return kTop + height_ * (y_.high - y) / y_.width(); }
  void frame(const std::string& x_name) {
    const double bottom = kTop + height_;
    body_ +=
        fmt::format("<rect x={} y={} width={} height={:.0f} fill='#f6f8fa' />", kLeft, kTop, kWidth, height_);
    const double x_step = tick_of(x_.width()), y_step = tick_of(y_.width() * 110.0 / height_);
    for (double x = std::ceil(x_.low / x_step) * x_step; x <= x_.high; x += x_step)
      body_ += fmt::format(
          "<line x1={0:.1f} x2={0:.1f} y1={1} y2={2:.1f} stroke='#dde3ea' /><text x={0:.1f} y={3:.1f} "
          "text-anchor=middle>{4}</text>",
          at_x(x), kTop, bottom, bottom + 14.0, label(x, x_step));
    for (double y = std::ceil(y_.low / y_step) * y_step; y <= y_.high; y += y_step)
      body_ += fmt::format(
          "<line x1={0} x2={1} y1={2:.1f} y2={2:.1f} stroke='#dde3ea' /><text x={3} y={4:.1f} "
          "text-anchor=end>{5}</text>",
          kLeft, kLeft + kWidth, at_y(y), kLeft - 5.0, at_y(y) + 4.0, label(y, y_step));
    body_ += fmt::format("<text x={:.0f} y={:.0f} text-anchor=middle>{}</text>", kLeft + 0.5 * kWidth,
                         bottom + 29.0, escaped(x_name));
  }
  static std::string label(double value, double step) {
    return number_text(std::fabs(value) < 1e-9 * step ? 0.0 : value, 4);
  }

  std::string title_;
  Range x_, y_;
  double height_;
  std::string body_;
};

/// Drawing of an interval beside the value that the search began with.
std::string interval_bar(const Estimate& each) {
  Range range;
  for (const double value : {each.low, each.high, each.assumed, each.value}) range.add(value);
  range.widen_to(1e-9 + 1e-6 * std::fabs(each.value));
  const auto at = [&](double value) { return 2.0 + 156.0 * (value - range.low) / range.width(); };
  return fmt::format(
      "<svg width=160 height=14 role=img aria-label='interval'><line x1={:.1f} x2={:.1f} y1=7 y2=7 "
      "stroke='{}' "
      "stroke-width=4 opacity=.35 /><circle cx={:.1f} cy=7 r=3.5 fill='{}' /><line x1={:.1f} x2={:.1f} y1=1 "
      "y2=13 "
      "stroke='{}' stroke-width=1.5 /></svg>",
      at(each.low), at(each.high), kFront, at(each.value), kFront, at(each.assumed), at(each.assumed),
      kModel);
}

std::string numbers_of(const Identification& found) {
  std::string text =
      "<h2>Numbers</h2><p>Dot: found. Bar: 95 % interval. Orange stroke: what the search began with. "
      "<i>Not excited</i>: the log hardly narrows what was assumed.<div "
      "class=scroll><table><tr><th>number<th>found"
      "<th>95 % interval<th>assumed<th>unit<th><th></tr>";
  for (const Estimate& each : found.estimates)
    text += fmt::format("<tr><td><code>{}</code><td>{}<td>{} to {}<td>{}<td>{}<td>{}<td>{}",
                        escaped(each.key), number_text(each.value, 4), number_text(each.low, 3),
                        number_text(each.high, 3), number_text(each.assumed, 4), escaped(each.unit),
                        interval_bar(each), each.is_excited ? "" : "not excited");
  return text + "</table></div>";
}

/// Plot of one stretch: measured, and predicted from where the samples end.
std::string path_plot(const identify::PredictedStretch& stretch) {
  Range x, y;
  for (const Compared& each : stretch.samples) {
    for (const double value : {each.x, each.model_x}) x.add(value);
    for (const double value : {each.y, each.model_y}) y.add(value);
  }
  // Both axes to the same scale.
  x.widen_to(std::max(1.05 * x.width(), 400.0 / 230.0 * 1.05 * y.width()));
  y.widen_to(230.0 / 400.0 * x.width());
  Plot plot(fmt::format("from {} s: black measured, orange predicted, dots a second apart [m]",
                        number_text(stretch.known, 4)),
            "x [m]", x, y, 230.0);
  std::vector<std::pair<double, double>> measured, model;
  for (const Compared& each : stretch.samples) {
    measured.emplace_back(each.x, each.y);
    if (each.time >= stretch.known) model.emplace_back(each.model_x, each.model_y);
  }
  plot.line(measured, kMeasured);
  plot.line(model, kModel);
  double next = stretch.known;
  for (const Compared& each : stretch.samples) {
    if (each.time < next) continue;
    plot.dot(each.x, each.y, kMeasured, 3.0);
    plot.dot(each.model_x, each.model_y, kModel, 3.0);
    next += 1.0;
  }
  return plot.text();
}

std::string predictions_of(const Identification& found) {
  std::string text = "<h2>Predicted against measured</h2>";
  if (found.stretches.empty())
    return text + "<p>No end of a log was held out (<code>--hold-out</code>), or none was long enough.";
  text +=
      "<p>The end of each log was not fitted. The model knows half a second of samples, and goes on from "
      "there by "
      "the commands alone. Root mean square:<table><tr><th>ahead [s]<th>place [m]<th>yaw [deg]<th>speed "
      "[m/s]</tr>";
  for (const identify::PredictionError& error : found.held_out)
    text += fmt::format("<tr><td>{}<td>{:.3f}<td>{:.2f}<td>{:.3f}", number_text(error.ahead, 3),
                        error.position, error.yaw * 180.0 / kPi, error.speed);
  text += "</table>";
  Range ahead, off;
  off.add(0.0);
  for (const identify::PredictedStretch& stretch : found.stretches) {
    for (const Compared& each : stretch.samples) {
      ahead.add(each.time - stretch.known);
      off.add(hypot(each.model_x - each.x, each.model_y - each.y));
    }
  }
  ahead.widen_to(0.1);
  off.widen_to(0.01);
  Plot plot("distance of predicted from measured place, a line for each stretch [m]", "time ahead [s]", ahead,
            off);
  for (const identify::PredictedStretch& stretch : found.stretches) {
    std::vector<std::pair<double, double>> line;
    for (const Compared& each : stretch.samples)
      line.emplace_back(each.time - stretch.known, hypot(each.model_x - each.x, each.model_y - each.y));
    plot.line(line, kFront, 0.5);
  }
  text += plot.text();
  const std::size_t step = std::max<std::size_t>(1, found.stretches.size() / kMostStretches);
  for (std::size_t i = 0, shown = 0; i < found.stretches.size() && shown < kMostStretches; i += step, ++shown)
    text += path_plot(found.stretches[i]);
  return text;
}

struct ResidualKind {
  const char* name;
  double (*of)(const Compared&);
};

/// How much a residual says of the next one.
double next_correlation(const std::vector<double>& values) {
  double product = 0.0, square = 0.0;
  for (std::size_t i = 0; i + 1 < values.size(); ++i) {
    product += values[i] * values[i + 1];
    square += values[i] * values[i];
  }
  return square > 0.0 ? product / square : 0.0;
}

std::string residuals_of(const Identification& found) {
  static constexpr ResidualKind kKinds[] = {
      {"along the car [m]",
       [](const Compared& c) { return cos(c.psi) * (c.model_x - c.x) + sin(c.psi) * (c.model_y - c.y); }},
      {"across the car [m]",
       [](const Compared& c) { return cos(c.psi) * (c.model_y - c.y) - sin(c.psi) * (c.model_x - c.x); }},
      {"yaw [deg]", [](const Compared& c) { return (c.model_psi - c.psi) * 180.0 / kPi; }},
      {"speed [m/s]", [](const Compared& c) { return c.model_speed - c.speed; }}};
  std::string text =
      "<h2>Residuals</h2><p>Model less measurement at the fitted samples. Noise of sensors has no pattern; "
      "what "
      "repeats in every bend is what the model lacks. The last figure is the correlation of a residual with "
      "the "
      "next one: 0 for noise alone.<br>";
  for (const ResidualKind& kind : kKinds) {
    std::vector<double> values;
    Range time, size;
    double squares = 0.0;
    for (const Compared& each : found.fitted) {
      values.push_back(kind.of(each));
      time.add(each.time);
      size.add(values.back());
      squares += values.back() * values.back();
    }
    if (values.empty()) continue;
    time.widen_to(0.1);
    size.widen_to(1e-6);
    Plot plot(fmt::format("{}: rms {}, correlation {:.2f}", kind.name,
                          number_text(std::sqrt(squares / static_cast<double>(values.size())), 3),
                          next_correlation(values)),
              "time [s]", time, size, 120.0);
    const std::size_t step = std::max<std::size_t>(1, values.size() / kMostDots);
    for (std::size_t i = 0; i < values.size(); i += step)
      plot.dot(found.fitted[i].time, values[i], kFront, 1.2);
    text += plot.text();
  }
  return text;
}

std::string correlations_of(const Identification& found) {
  std::string text =
      "<h2>Correlations</h2><p>Of the errors of two numbers. Near 1 or −1 the log tells only their "
      "difference, or "
      "their sum.<div class=scroll><table class=map><tr><th>";
  for (std::size_t i = 0; i < found.correlations.size(); ++i) text += fmt::format("<th>{}", i + 1);
  text += "</tr>";
  for (std::size_t i = 0; i < found.correlations.size(); ++i) {
    text += fmt::format("<tr><td style='text-align:left'>{} <code>{}</code>", i + 1,
                        escaped(found.estimates[i].key));
    for (std::size_t j = 0; j < found.correlations[i].size(); ++j) {
      const double value = found.correlations[i][j];
      const char* colour = value > 0.0 ? "194,87,26" : "59,110,165";
      text += i == j ? std::string("<td>")
                     : fmt::format("<td style='background:rgba({},{:.2f})'>{:.2f}", colour,
                                   0.8 * std::min(1.0, std::fabs(value)), value);
    }
  }
  return text + "</table></div>";
}

std::string slip_of(const Identification& found) {
  std::string text = fmt::format(
      "<h2>Slip covered</h2><p>Fitted samples by the slip of an axle, over the slip at its peak force. Grip "
      "counts as "
      "known where 1 % of the samples lie beyond {:.0f} % (orange stroke) at one axle and {:.0f} % at the "
      "other; the black "
      "stroke is the peak. The log reached {:.0f} % at the front and {:.0f} % at the rear.<br>",
      100.0 * identify::kRaceUse, 100.0 * identify::kLeastRaceUse, 100.0 * found.use_front,
      100.0 * found.use_rear);
  for (const auto& [name, bins] :
       {std::pair{"front", found.slip.front}, std::pair{"rear", found.slip.rear}}) {
    Range slip{0.0, identify::SlipCover::kBin * static_cast<double>(bins.size())}, share;
    share.add(0.0);
    double all = 0.0;
    for (const int count : bins) all += count;
    for (const int count : bins) share.add(100.0 * count / std::max(1.0, all));
    share.high *= 1.05;
    if (!(share.high > 0.0)) share.high = 1.0;
    Plot plot(fmt::format("{} axle: share of the samples [%]", name), "slip over that of the peak", slip,
              share, 120.0);
    for (std::size_t i = 0; i < bins.size(); ++i)
      if (bins[i] > 0)
        plot.bar(identify::SlipCover::kBin * static_cast<double>(i), identify::SlipCover::kBin,
                 100.0 * bins[i] / std::max(1.0, all), kFront);
    plot.mark(identify::kRaceUse, kModel);
    plot.mark(1.0, kMeasured);
    text += plot.text();
  }
  return text;
}

}  // namespace

std::string identify_page(const Identification& found, const IdentifyPageWords& words) {
  std::string text = sweep::page_head(fmt::format("A car from {}", words.logs));
  std::string advice = escaped(words.advice);
  for (std::size_t at = 0; (at = advice.find('\n', at)) != std::string::npos;) advice.replace(at, 1, "<br>");
  text += fmt::format("<p>{:.0f} s of driving. Left unexplained: {:.3f} m, {:.2f} deg, {:.3f} m/s.",
                      found.driven, found.residual[0], found.residual[1] * 180.0 / kPi, found.residual[2]);
  if (!words.command.empty()) text += fmt::format("<p>To drive it: <code>{}</code>", escaped(words.command));
  if (!advice.empty()) text += "<p>" + advice;
  return text + numbers_of(found) + predictions_of(found) + residuals_of(found) + correlations_of(found) +
         slip_of(found) + "</html>\n";
}

}  // namespace chicane::apps
