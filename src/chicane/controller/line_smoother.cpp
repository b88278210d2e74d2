// SPDX-License-Identifier: MIT
#include "chicane/controller/line_smoother.hpp"

#include <algorithm>
#include <cmath>

namespace chicane::controller {
namespace {

constexpr double kSpacing = 3.0;      // [m] wanted between knots
constexpr int kPasses = 10;           // over the prices
constexpr double kLeastPrice = 1e-3;  // √w where there is room [1/m²]
constexpr double kFirstPrice = 2e-3;  // √w of the first pass

}  // namespace

LineSmoother::LineSmoother(double width, double slope_length)
    : width_{width}, workspace_{std::make_unique<Workspace>()} {
  workspace_->problem.slope_length = slope_length;
}

void LineSmoother::configure(double width, double slope_length) noexcept {
  width_ = width;
  workspace_->problem.slope_length = slope_length;
}

int LineSmoother::knots_for(double length, bool closed) noexcept {
  const double whole = closed ? length + 2.0 * kOverlap : length;
  const double spacing = std::max(kSpacing, whole / (kMaxKnots - 4));
  return std::max(4, static_cast<int>(std::ceil(length / spacing)));
}

bool LineSmoother::smooth(const path::Path& line, double spacing, int count) noexcept {
  is_valid_ = false;
  if (!(width_ > 0.0)) return false;
  count_ = count;
  extra_ = line.is_closed() ? static_cast<int>(kOverlap / spacing) : 0;
  const int total = std::min(count + 2 * extra_, kMaxKnots);
  Problem& problem = workspace_->problem;
  auto& trajectory = workspace_->trajectory;
  problem.h = spacing;
  for (int k = 0; k <= total; ++k) {
    problem.curvature[static_cast<std::size_t>(k)] = line.at((k - extra_) * spacing).curvature;
    problem.root_price[static_cast<std::size_t>(k)] = kFirstPrice;
  }
  trajectory.horizon = total;
  trajectory.u.fill({0.0});
  for (int pass = 0; pass < kPasses; ++pass) {
    const solver::SolveReport report =
        workspace_->solver.solve(problem, {0.0, 0.0, 0.0}, trajectory, Deadline::never());
    if (!usable(report.status)) return false;
    // Prices by place, not by knot: both ends of a closed line pay what the same places in the middle pay.
    for (int k = extra_; k <= total - extra_; ++k) {
      const auto i = static_cast<std::size_t>(k);
      const double ratio = std::fabs(trajectory.x[i][0]) / width_;
      problem.root_price[i] = std::max(kLeastPrice, problem.root_price[i] * std::clamp(ratio, 0.4, 2.5));
    }
    for (int k = 0; k < extra_; ++k) {
      problem.root_price[static_cast<std::size_t>(k)] =
          problem.root_price[static_cast<std::size_t>(k + count)];
      problem.root_price[static_cast<std::size_t>(total - k)] =
          problem.root_price[static_cast<std::size_t>(total - k - count)];
    }
  }
  is_valid_ = true;
  return true;
}

double LineSmoother::offset(int k) const noexcept {
  if (!is_valid_) return 0.0;
  const auto& x = workspace_->trajectory.x;
  const double n = x[static_cast<std::size_t>(k + extra_)][0];
  if (k >= extra_) return n;
  // Behind the seam the line has been computed twice, once as the continuation of its own end: fade from one
  // to the other.
  const double share = static_cast<double>(k) / extra_;
  const double continued = x[static_cast<std::size_t>(k + extra_ + count_)][0];
  return share * n + (1.0 - share) * continued;
}

}  // namespace chicane::controller
