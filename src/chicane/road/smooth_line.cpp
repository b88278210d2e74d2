// SPDX-License-Identifier: MIT
// Smoothing of noisy points: penalised least squares on even knots; the smoothing length is chosen by the
// noise of the points.
#include "chicane/road/smooth_line.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "chicane/base/math.hpp"
#include "chicane/base/median.hpp"
#include "chicane/road/detail/point_text.hpp"

namespace chicane::road {
namespace {

constexpr double kCurvatureNoise = 0.003;     // [1/m] accepted standard deviation of curvature; chosen
constexpr double kMinSmoothingLength = 0.05;  // [m] keeps the system regular with more knots than points
constexpr int kParameterPasses = 3;  // first by the points' chords, then twice by the line's arc length
// A closed line is unrolled at both ends by at least kOverlapPoints points and kOverlapLengths smoothing
// lengths: points farther away have no influence.
constexpr int kOverlapPoints = 16;
constexpr double kOverlapLengths = 30.0;
constexpr std::size_t kMaxKnots = 200'000;  // limit of a line's knots; chosen: bounds memory
constexpr double kMinLength = 1.0;          // [m] least length of a line
constexpr double kLeastShare = 0.01;   // least plausible length of the line over that of its points' chords
constexpr double kMostShare = 2.0;     // largest such ratio; both chosen
constexpr double kMostUnrolled = 4e6;  // limit of unrolled points; chosen: bounds memory
constexpr double kMaxShareOfLength =
    0.02;  // limit of the smoothing length ℓ as a share of the length of a short line
constexpr double kMostUneven = 4.0;      // limit for even points: ratio of a gap to the median around it
constexpr std::ptrdiff_t kNearGaps = 3;  // gaps on each side of one that the median is taken of
constexpr double kMostNoise = 1.0;       // [m] standard deviation that cross-validation begins with
constexpr double kLeastShareOfGap = 0.1;  // least ℓ over the median gap: a line of a shorter ℓ interpolates
constexpr std::size_t kMostLeftOut = 200;  // points that cross-validation leaves out; chosen: bounds the time

/// Distances between neighbouring points.
struct Gaps {
  double median = 0.0, mean = 0.0;  // [m]
  double unevenness = 0.0;          // largest ratio of a gap to the median of those around it
};

/// Penalty of equation (1), of order 3 for even points and 2 for uneven ones.
struct Penalty {
  int order = 3;                                            // m
  std::array<double, 4> differences{-1.0, 3.0, -3.0, 1.0};  // of the spline's coefficients
  double noise_factor = 0.0556;                             // c of equation (2)
  double step = 0.5;       // ratio of one candidate ℓ to the next larger one
  double usual_gap = 0.0;  // median distance between points [m]

  explicit Penalty(const Gaps& gaps) noexcept : usual_gap{gaps.median} {
    if (gaps.unevenness <= kMostUneven) return;
    order = 2;
    differences = {1.0, -2.0, 1.0, 0.0};
    noise_factor = 0.0884;
    step = std::sqrt(0.5);
  }
  /// Factor ℓ^2m / h^(2m − 1) of the squared differences.
  [[nodiscard]] double weight(double smoothing, double spacing) const noexcept {
    const double ratio = smoothing / spacing;
    double weight = 1.0;
    for (int i = 0; i < 2 * order - 1; ++i) weight *= ratio;
    return weight * smoothing;
  }
  /// Factor of the penalty in a gap [m]. Uneven points are far apart where the road is straight: the line is
  /// stiffer there.
  [[nodiscard]] double stiffness(double gap) const noexcept {
    const double ratio = order == 3 ? 1.0 : std::max(gap / usual_gap, 1.0);
    return ratio * ratio;
  }
  /// Whether noise of standard deviation σ [m] explains the deviations; 2 and 10 mm more are always accepted.
  /// Uneven points have no near neighbours to average with, hence 2 σ for them.
  [[nodiscard]] bool explains(double sigma, const SmoothLine& line) const noexcept {
    const double most = (order == 3 ? 4.0 : 2.0) * sigma;
    return line.rms_deviation <= sigma + 0.002 && line.max_deviation <= most + 0.01;
  }
};

/// Uniform cubic B-spline with unit distance of knots: weights of the four coefficients that shape the spline
/// at one parameter u. Coefficient i has its peak at u = i − 1.
struct Basis {
  std::size_t first = 0;  // index of the first of the four coefficients
  double t = 0.0;         // u from the knot before, in [0, 1)
  explicit Basis(double u) noexcept {
    const double whole = std::max(std::floor(u), 0.0);
    first = static_cast<std::size_t>(whole);
    t = u - whole;
  }
  [[nodiscard]] std::array<double, 4> value() const noexcept {
    const double r = 1.0 - t;
    return {r * r * r / 6.0, (t * t * (3.0 * t - 6.0) + 4.0) / 6.0,
            (t * (t * (-3.0 * t + 3.0) + 3.0) + 1.0) / 6.0, t * t * t / 6.0};
  }
  [[nodiscard]] std::array<double, 4> slope() const noexcept {
    const double r = 1.0 - t;
    return {-0.5 * r * r, t * (1.5 * t - 2.0), t * (1.0 - 1.5 * t) + 0.5, 0.5 * t * t};
  }
};

Vec2 combine(const std::array<double, 4>& weights, const Vec2* coefficients) noexcept {
  return weights[0] * coefficients[0] + weights[1] * coefficients[1] + weights[2] * coefficients[2] +
         weights[3] * coefficients[3];
}

/// Symmetric positive definite band matrix: row i holds entries (i, i … i + 3).
using Band = std::vector<std::array<double, 4>>;

/// Factorises into L D Lᵀ in place.
void factorise(Band& a) noexcept {
  const std::size_t n = a.size();
  for (std::size_t i = 0; i < n; ++i) {
    const std::array<double, 4> row = a[i];
    for (std::size_t k = 1; k < 4 && i + k < n; ++k) {
      const double factor = row[k] / row[0];
      for (std::size_t m = k; m < 4; ++m) a[i + k][m - k] -= factor * row[m];
    }
  }
}

/// Solves A x = b in place for a factorised A.
void substitute(const Band& a, std::vector<Vec2>& x) noexcept {
  const std::size_t n = a.size();
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 1; k < 4 && i + k < n; ++k) x[i + k] -= a[i][k] / a[i][0] * x[i];
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t k = 1; k < 4 && i + k < n; ++k) x[i] -= a[i][k] * x[i + k];
    x[i] /= a[i][0];
  }
}

/// Points by their arc length, those of a closed line with its overlap, and the grid of knots that they lie
/// on.
struct Unrolled {
  std::vector<double> s;           // arc length of each point [m]
  std::vector<std::size_t> point;  // index of each point
  std::size_t lead = 0;            // knots before s = 0
  std::size_t count = 0;           // coefficients
};

Unrolled unroll(const std::vector<double>& parameter, double length, bool closed, double spacing,
                double smoothing) {
  // Point k of all laps, also before the first: index k modulo n, lap k / n rounded down.
  const auto n = static_cast<std::ptrdiff_t>(parameter.size());
  const auto lap_of = [n](std::ptrdiff_t k) { return k >= 0 ? k / n : -((n - 1 - k) / n); };
  const auto index_of = [&](std::ptrdiff_t k) { return static_cast<std::size_t>(k - lap_of(k) * n); };
  const auto s_of = [&](std::ptrdiff_t k) {
    const std::ptrdiff_t lap = lap_of(k);
    return parameter[index_of(k)] + length * static_cast<double>(lap);
  };
  std::ptrdiff_t first = 0;
  std::ptrdiff_t last = n - 1;
  if (closed) {
    const double reach = kOverlapLengths * smoothing;
    while (first > -kOverlapPoints || s_of(first) > -reach) --first;
    while (last < n - 1 + kOverlapPoints || s_of(last) < length + reach) ++last;
  }
  Unrolled rolled;
  for (std::ptrdiff_t k = first; k <= last; ++k) {
    rolled.s.push_back(s_of(k));
    rolled.point.push_back(index_of(k));
  }
  rolled.lead =
      static_cast<std::size_t>(std::ceil(-std::min(rolled.s.front(), 0.0) / spacing)) + (closed ? 1U : 0U);
  rolled.count = rolled.lead +
                 static_cast<std::size_t>(std::floor(std::max(rolled.s.back(), length) / spacing + 1e-9)) + 4;
  return rolled;
}

/// Fitted spline.
struct Fit {
  std::vector<Vec2> coefficients;
  Band band;                      // factorised matrix of the coefficients
  std::vector<double> weights;    // weights of the points
  std::size_t lead = 0;           // knots before s = 0
  double spacing = 0.0;           // of the knots [m]
  double length = 0.0;            // [m]
  std::vector<double> parameter;  // arc length of each point [m]

  [[nodiscard]] Basis basis(double s) const noexcept {
    return Basis{s / spacing + static_cast<double>(lead)};
  }
};

/// Solves equation (1): its matrix is B' W B + ℓ^2m/h^(2m−1) D' D, with D the m-th differences of the
/// coefficients.
void solve(Fit& fit, std::span<const Vec2> points, bool closed, const Penalty& penalty, double smoothing) {
  const Unrolled rolled = unroll(fit.parameter, fit.length, closed, fit.spacing, smoothing);
  fit.lead = rolled.lead;
  fit.coefficients.assign(rolled.count, Vec2{});
  fit.band.assign(rolled.count, {0.0, 0.0, 0.0, 0.0});
  fit.weights.assign(points.size(), 0.0);
  for (std::size_t i = 0; i < rolled.s.size(); ++i) {
    const double before = i > 0 ? rolled.s[i] - rolled.s[i - 1] : 0.0;
    const double after = i + 1 < rolled.s.size() ? rolled.s[i + 1] - rolled.s[i] : 0.0;
    const double weight = 0.5 * (before + after);
    fit.weights[rolled.point[i]] = std::max(fit.weights[rolled.point[i]], weight);
    const Basis basis = fit.basis(rolled.s[i]);
    const std::array<double, 4> value = basis.value();
    for (std::size_t k = 0; k < 4; ++k) {
      for (std::size_t m = k; m < 4; ++m) fit.band[basis.first + k][m - k] += weight * value[k] * value[m];
      fit.coefficients[basis.first + k] += weight * value[k] * points[rolled.point[i]];
    }
  }
  const double weight = penalty.weight(smoothing, fit.spacing);
  const std::array<double, 4>& differences = penalty.differences;
  const std::size_t members = static_cast<std::size_t>(penalty.order) + 1;
  std::size_t next = 1;
  for (std::size_t i = 0; i + members <= rolled.count; ++i) {
    const double s = fit.spacing * (static_cast<double>(i) - static_cast<double>(rolled.lead));
    while (next + 1 < rolled.s.size() && rolled.s[next] < s) ++next;
    const double factor = weight * penalty.stiffness(rolled.s[next] - rolled.s[next - 1]);
    for (std::size_t k = 0; k < members; ++k) {
      for (std::size_t m = k; m < members; ++m)
        fit.band[i + k][m - k] += factor * differences[k] * differences[m];
    }
  }
  factorise(fit.band);
  substitute(fit.band, fit.coefficients);
}

/// Replaces the parameter of the points by their arc length along the fitted line.
void measure_arc_length(Fit& fit) {
  const std::size_t intervals = fit.coefficients.size() - 3;
  std::vector<double> arc(intervals + 1, 0.0);
  const auto speed = [&](std::size_t i, double t) {
    return combine(Basis{t}.slope(), &fit.coefficients[i]).norm();
  };
  for (std::size_t i = 0; i < intervals; ++i) {  // Simpson's rule
    const double end = (0.5 * (fit.coefficients[i + 3] - fit.coefficients[i + 1])).norm();
    arc[i + 1] = arc[i] + (speed(i, 0.0) + 4.0 * speed(i, 0.5) + end) / 6.0;
  }
  const auto arc_at = [&](double s) {
    const Basis basis = fit.basis(s);
    const std::size_t i = std::min(basis.first, intervals - 1);
    const double t = basis.t + static_cast<double>(basis.first - i);
    return arc[i] + t * (arc[i + 1] - arc[i]);
  };
  const double origin = arc_at(0.0);
  const double length = arc_at(fit.length) - origin;
  for (double& s : fit.parameter) s = arc_at(s) - origin;
  fit.length = length;
}

/// Points with the length of their chords as parameter; no spline yet.
Fit initial_fit(std::span<const Vec2> points, bool closed) {
  Fit fit;
  fit.parameter.resize(points.size());
  for (std::size_t i = 1; i < points.size(); ++i)
    fit.parameter[i] = fit.parameter[i - 1] + (points[i] - points[i - 1]).norm();
  fit.length = fit.parameter.back() + (closed ? (points.front() - points.back()).norm() : 0.0);
  return fit;
}

std::size_t interval_count(double length, double spacing) noexcept {
  return static_cast<std::size_t>(std::clamp(std::round(length / spacing), 8.0, 1e9));
}

/// Distances between neighbouring points of a line of `length` [m].
Gaps gaps_of(std::span<const Vec2> points, bool closed, double length) {
  std::vector<double> gaps;
  gaps.reserve(points.size());
  for (std::size_t i = 1; i < points.size(); ++i) gaps.push_back((points[i] - points[i - 1]).norm());
  Gaps found{.median = median(gaps), .mean = length / static_cast<double>(points.size())};
  if (closed) gaps.push_back((points.front() - points.back()).norm());
  const auto n = static_cast<std::ptrdiff_t>(gaps.size());
  for (std::ptrdiff_t i = 0; i < n; ++i) {
    std::vector<double> near;
    for (std::ptrdiff_t k = i - kNearGaps; k <= i + kNearGaps; ++k)
      if (closed || (k >= 0 && k < n)) near.push_back(gaps[static_cast<std::size_t>((k % n + n) % n)]);
    const double usual = std::max(median(std::move(near)), 1e-9);
    found.unevenness = std::max(found.unevenness, gaps[static_cast<std::size_t>(i)] / usual);
  }
  return found;
}

/// Distance of point i from the line, across it [m].
double deviation_at(const Fit& fit, std::span<const Vec2> points, std::size_t i) {
  const Basis basis = fit.basis(fit.parameter[i]);
  const Vec2* c = &fit.coefficients[std::min(basis.first, fit.coefficients.size() - 4)];
  const Vec2 gap = points[i] - combine(basis.value(), c);
  const Vec2 tangent = combine(basis.slope(), c);
  return std::fabs(tangent.cross(gap)) / std::max(tangent.norm(), 1e-12);
}

/// Knots of a fitted spline, and the points' distances from it.
SmoothLine finish(Fit&& fit, std::span<const Vec2> points, bool closed) {
  SmoothLine line;
  double sum = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double across = deviation_at(fit, points, i);
    sum += across * across;
    line.max_deviation = std::max(line.max_deviation, across);
  }
  line.rms_deviation = std::sqrt(sum / static_cast<double>(points.size()));
  const std::size_t count = interval_count(fit.length, fit.spacing) + (closed ? 0U : 1U);
  line.knots.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Vec2* c = &fit.coefficients[fit.lead + i];
    line.knots.emplace_back((c[0] + 4.0 * c[1] + c[2]) / 6.0);
  }
  line.length = fit.length;
  line.spacing = fit.spacing;
  line.parameter = std::move(fit.parameter);
  return line;
}

/// Whether a fit has a plausible length. With many knots to each point rounding can give any length, by which
/// memory grows.
bool is_solvable(const Fit& fit, const Fit& raw, std::size_t points, double smoothing) noexcept {
  const bool has_a_length = fit.length >= kLeastShare * raw.length && fit.length <= kMostShare * raw.length;
  return has_a_length &&
         kOverlapLengths * smoothing / fit.length * static_cast<double>(points) <= kMostUnrolled;
}

/// ℓ of equation (2) [m]: white noise of σ every `gap` [m] leaves the accepted noise of the curvature.
double demanded_length(const Penalty& penalty, double sigma, double gap, double length) {
  const double share = penalty.noise_factor * sigma * sigma * gap / (kCurvatureNoise * kCurvatureNoise);
  const double demanded = sigma > 0.0 ? exp(0.2 * log(share)) : 0.0;
  return std::max(std::min(demanded, kMaxShareOfLength * length), kMinSmoothingLength);
}

/// Fit for one ℓ, with its points by their arc length on it.
Result<Fit> fitted(const Fit& raw, std::span<const Vec2> points, bool closed, double spacing,
                   const Penalty& penalty, double smoothing) {
  const double longest = spacing * static_cast<double>(kMaxKnots);
  if (!(raw.length >= kMinLength && raw.length <= longest)) {
    return fail(ErrorCode::kInvalidArgument, "points: got a line of " + number_text(raw.length) +
                                                 " m, expected " + number_text(kMinLength) + " to " +
                                                 number_text(longest) + " m");
  }
  Fit fit = raw;
  for (int pass = 0; pass < kParameterPasses; ++pass) {
    if (pass > 0) measure_arc_length(fit);
    if (!is_solvable(fit, raw, points.size(), smoothing)) {
      return fail(ErrorCode::kInvalidArgument,
                  "points: got points that no smooth line follows, expected more of them, or a wider "
                  "spacing than " +
                      number_text(spacing) + " m");
    }
    fit.spacing = fit.length / static_cast<double>(interval_count(fit.length, spacing));
    solve(fit, points, closed, penalty, smoothing);
  }
  return fit;
}

/// Errors of predicting each point from all others, equation (3).
struct Validation {
  double error = 0.0;      // mean square [m²]
  double tolerance = 0.0;  // standard error of it [m²]
  double variance = 0.0;   // variance of the noise across the line [m²]
};

/// Cross-validates a fit by at most kMostLeftOut of its points.
Validation validate(const Fit& fit, std::span<const Vec2> points) {
  const std::size_t stride = (points.size() + kMostLeftOut - 1) / kMostLeftOut;
  double count = 0.0, sum = 0.0, squares = 0.0, residual = 0.0, freedom = 0.0;
  std::vector<Vec2> influence;
  for (std::size_t i = 0; i < points.size(); i += stride) {
    const Basis basis = fit.basis(fit.parameter[i]);
    const std::size_t first = std::min(basis.first, fit.coefficients.size() - 4);
    const std::array<double, 4> value = basis.value();
    influence.assign(fit.coefficients.size(), Vec2{});
    for (std::size_t k = 0; k < 4; ++k) influence[first + k] = {fit.weights[i] * value[k], 0.0};
    substitute(fit.band, influence);
    const double own = std::max(1.0 - combine(value, &influence[first]).x(), 1e-9);
    const double across = deviation_at(fit, points, i);
    const double square = across * across;
    const double error = square / (own * own);
    count += 1.0;
    sum += error;
    squares += error * error;
    residual += square;
    freedom += own;
  }
  const double mean = sum / count;
  return {mean, std::sqrt(std::max(squares / count - mean * mean, 0.0) / count), residual / freedom};
}

}  // namespace

double estimate_noise(std::span<const Vec2> points, bool closed, double spacing) {
  const Fit raw = initial_fit(points, closed);
  const Gaps gaps = gaps_of(points, closed, raw.length);
  const Penalty penalty{gaps};
  std::vector<Validation> candidates;  // of falling ℓ
  double smoothing = demanded_length(penalty, kMostNoise, gaps.mean, raw.length);
  const double least = std::max(kLeastShareOfGap * gaps.median, kMinSmoothingLength);
  for (; smoothing >= least; smoothing *= std::sqrt(0.5)) {
    const Result<Fit> fit = fitted(raw, points, closed, spacing, penalty, smoothing);
    if (fit) candidates.push_back(validate(*fit, points));
  }
  if (candidates.empty()) return kMostNoise;
  const Validation& best =
      *std::min_element(candidates.begin(), candidates.end(),
                        [](const Validation& a, const Validation& b) { return a.error < b.error; });
  const auto smoothest = std::find_if(candidates.begin(), candidates.end(), [&](const Validation& each) {
    return each.error <= best.error + best.tolerance;
  });
  return std::min(std::sqrt(smoothest->variance), kMostNoise);
}

Result<SmoothLine> smooth_line(std::span<const Vec2> points, bool closed, double spacing, double sigma) {
  const Fit raw = initial_fit(points, closed);
  const Gaps gaps = gaps_of(points, closed, raw.length);
  const Penalty penalty{gaps};
  double smoothing = demanded_length(penalty, sigma, gaps.mean, raw.length);
  while (true) {
    Result<Fit> fit = fitted(raw, points, closed, spacing, penalty, smoothing);
    if (!fit) return fail(fit.error());
    SmoothLine line = finish(std::move(*fit), points, closed);
    line.smoothing_length = smoothing;
    if (penalty.explains(sigma, line) || smoothing <= kMinSmoothingLength) return line;
    smoothing = std::max(penalty.step * smoothing, kMinSmoothingLength);
    spacing = std::min(spacing, std::max(2.0 * smoothing, 0.25 * gaps.median));
  }
}

}  // namespace chicane::road
