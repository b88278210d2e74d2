// SPDX-License-Identifier: MIT
#include "chicane/road/line_smoother.hpp"

#include <algorithm>
#include <cmath>

namespace chicane::road {
namespace {

constexpr int kPasses = 10;            // over the weights
constexpr double kLeastWeight = 1e-3;  // √w where there is room [1/m²]
constexpr double kFirstWeight = 2e-3;  // √w of the first pass
constexpr double kEndWeight = 5e-2;    // √w added at the ends of the line

}  // namespace

LineSmoother::LineSmoother(int capacity) {
  curvature_.resize(static_cast<std::size_t>(capacity));
  offset_.resize(static_cast<std::size_t>(capacity + kMargin));
  rows_.resize(static_cast<std::size_t>(capacity + 2 * kMargin));
}

void LineSmoother::configure(double width, double slope_length) noexcept {
  width_ = width;
  slope_length_ = slope_length;
}

void LineSmoother::begin(int knots, double spacing, int period) noexcept {
  knots_ = knots;
  spacing_ = spacing;
  period_ = period;
  instalments_.restart();
}

bool LineSmoother::advance(int& work) noexcept {
  constexpr int kLastPhase = 2 + 3 * kPasses;
  if (instalments_.phase() == 0 && !(width_ > 0.0)) {
    std::fill(offset_.begin(), offset_.begin() + knots_, 0.0);
    instalments_.enter(kLastPhase);
  }
  while (work > 0 && instalments_.phase() < kLastPhase) {
    const int phase = instalments_.phase();
    if (phase == 0) {
      for (int k = 0; k < kMargin; ++k) {
        row(k - kMargin) = row(knots_ + k) = {};
        offset_[static_cast<std::size_t>(knots_ + k)] = 0.0;
      }
      instalments_.loop(knots_, 1, work, [&](int k) {
        row(k) = {};
        row(k).root_weight = kFirstWeight;
      });
    } else if (phase == 1) {
      instalments_.loop(knots_ - 2, 2, work, [&](int k) { assemble(k + 1); });
    } else if ((phase - 2) % 3 == 0) {
      instalments_.loop(knots_, 1, work, [&](int k) { eliminate(k); });
    } else if ((phase - 2) % 3 == 1) {
      instalments_.loop(knots_, 1, work, [&](int k) { substitute(knots_ - 1 - k); });
    } else {
      instalments_.loop(knots_, 1, work, [&](int k) { raise_weight(k); });
    }
  }
  return instalments_.phase() == kLastPhase;
}

/// Bending at inner knot k, and its change to the next one.
void LineSmoother::assemble(int k) noexcept {
  add_bending(k);
  if (k + 2 < knots_) add_slope(k);
  if (k > 1 && k + 2 < knots_) return;
  // The ends of the line are held a little, and come in along it.
  const int end = k == 1 ? 0 : knots_ - 1;
  const double lean = 0.1 / spacing_;
  row(end).band[0] += kEndWeight * kEndWeight + lean * lean;
  row(k).band[0] += lean * lean;
  row(std::max(end, k)).band[1] -= lean * lean;
}

void LineSmoother::add_bending(int k) noexcept {
  const double q = 1.0 / (spacing_ * spacing_);
  const double kappa = curvature_[static_cast<std::size_t>(k)];
  const std::array<double, 3> c{q, kappa * kappa - 2.0 * q, q};
  for (int i = 0; i < 3; ++i) {
    Row& to = row(k - 1 + i);
    const double own = c[static_cast<std::size_t>(i)];
    for (int j = 0; j <= i; ++j)
      to.band[static_cast<std::size_t>(i - j)] += own * c[static_cast<std::size_t>(j)];
    to.right -= own * kappa;
  }
}

void LineSmoother::add_slope(int k) noexcept {
  const double q = 1.0 / (spacing_ * spacing_);
  const double per_meter = slope_length_ / spacing_;
  const double here = curvature_[static_cast<std::size_t>(k)];
  const double next = curvature_[static_cast<std::size_t>(k + 1)];
  const std::array<double, 4> c{-q * per_meter, (3.0 * q - here * here) * per_meter,
                                (next * next - 3.0 * q) * per_meter, q * per_meter};
  for (int i = 0; i < 4; ++i) {
    Row& to = row(k - 1 + i);
    const double own = c[static_cast<std::size_t>(i)];
    for (int j = 0; j <= i; ++j)
      to.band[static_cast<std::size_t>(i - j)] += own * c[static_cast<std::size_t>(j)];
    to.right -= own * per_meter * (next - here);
  }
}

/// One row of A + w = L D Lᵀ, and of L y = right.
void LineSmoother::eliminate(int k) noexcept {
  Row& now = row(k);
  const Row& one = row(k - 1);
  const Row& two = row(k - 2);
  const Row& three = row(k - 3);
  const double u3 = now.band[3];
  const double u2 = now.band[2] - u3 * two.factor[1];
  const double u1 = now.band[1] - u3 * one.factor[2] - u2 * one.factor[1];
  const double l3 = u3 * three.factor[0];
  const double l2 = u2 * two.factor[0];
  const double l1 = u1 * one.factor[0];
  const double pivot = now.band[0] + now.root_weight * now.root_weight - u3 * l3 - u2 * l2 - u1 * l1;
  now.factor = {1.0 / pivot, l1, l2, l3};
  now.forward = now.right - u3 * three.forward - u2 * two.forward - u1 * one.forward;
  now.forward *= now.factor[0];
}

void LineSmoother::substitute(int k) noexcept {
  const auto i = static_cast<std::size_t>(k);
  offset_[i] = row(k).forward - row(k + 1).factor[1] * offset_[i + 1] -
               row(k + 2).factor[2] * offset_[i + 2] - row(k + 3).factor[3] * offset_[i + 3];
}

void LineSmoother::raise_weight(int k) noexcept {
  // By place, not by knot: both ends of a closed line pay what the same places in the middle pay.
  const int extra = (knots_ - period_) / 2;
  int twin = k;
  if (period_ > 0 && k < extra) twin = k + period_;
  if (period_ > 0 && k >= extra + period_) twin = k - period_;
  const double ratio = std::fabs(offset_[static_cast<std::size_t>(twin)]) / width_;
  Row& now = row(k);
  now.root_weight = std::max(kLeastWeight, now.root_weight * std::clamp(ratio, 0.4, 2.5));
}

}  // namespace chicane::road
