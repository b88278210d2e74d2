// SPDX-License-Identifier: MIT
#include "traced/tape.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace chicane::python {
namespace {

std::uint64_t hash_of(const Node& node) {
  std::uint64_t hash = static_cast<std::uint64_t>(node.op) + 0x9E3779B97F4A7C15ULL;
  const auto mix = [&](std::uint64_t part) {
    hash = (hash ^ part) * 0xBF58476D1CE4E5B9ULL;
    hash ^= hash >> 29;
  };
  for (const std::int32_t operand : node.of) mix(static_cast<std::uint32_t>(operand));
  mix(std::bit_cast<std::uint64_t>(node.value));
  return hash;
}
bool is_same(const Node& a, const Node& b) {
  return a.op == b.op && a.of == b.of &&
         std::bit_cast<std::uint64_t>(a.value) == std::bit_cast<std::uint64_t>(b.value);
}
bool commutes(Op op) { return op == Op::kAdd || op == Op::kMultiply; }

double result_of(Op op, double a, double b, double exponent) {
  switch (op) {
    case Op::kAdd:
      return a + b;
    case Op::kSubtract:
      return a - b;
    case Op::kMultiply:
      return a * b;
    case Op::kDivide:
      return a / b;
    case Op::kNegate:
      return -a;
    case Op::kSin:
      return std::sin(a);
    case Op::kCos:
      return std::cos(a);
    case Op::kTan:
      return std::tan(a);
    case Op::kAtan:
      return std::atan(a);
    case Op::kAsin:
      return std::asin(a);
    case Op::kAcos:
      return std::acos(a);
    case Op::kExp:
      return std::exp(a);
    case Op::kLog:
      return std::log(a);
    case Op::kTanh:
      return std::tanh(a);
    case Op::kSqrt:
      return std::sqrt(a);
    case Op::kPower:
      return std::pow(a, exponent);
    case Op::kAtan2:
      return std::atan2(a, b);
    case Op::kLess:
      return a < b ? 1.0 : 0.0;
    default:
      return std::nan("");
  }
}

}  // namespace

std::int32_t Tape::add(const Node& given) {
  Node node = given;
  if (commutes(node.op) && node.of[0] > node.of[1]) std::swap(node.of[0], node.of[1]);
  if (const std::int32_t simple = simplified(node); simple >= 0) return simple;
  if (2 * used_ >= buckets_.size()) {
    buckets_.assign(std::max<std::size_t>(1024, 4 * buckets_.size()), -1);
    for (std::size_t n = 0; n < nodes_.size(); ++n) {
      std::size_t at = hash_of(nodes_[n]) & (buckets_.size() - 1);
      while (buckets_[at] >= 0) at = (at + 1) & (buckets_.size() - 1);
      buckets_[at] = static_cast<std::int32_t>(n);
    }
  }
  std::size_t at = hash_of(node) & (buckets_.size() - 1);
  for (; buckets_[at] >= 0; at = (at + 1) & (buckets_.size() - 1)) {
    if (is_same(nodes_[static_cast<std::size_t>(buckets_[at])], node)) return buckets_[at];
  }
  buckets_[at] = static_cast<std::int32_t>(nodes_.size());
  ++used_;
  nodes_.push_back(node);
  return buckets_[at];
}

/// An equal node that is there already or simpler; -1 when there is none.
std::int32_t Tape::simplified(const Node& node) {
  const auto [a, b, c] = node.of;
  switch (node.op) {
    case Op::kAdd:
      if (is_constant(a, 0.0)) return b;
      if (is_constant(b, 0.0)) return a;
      break;
    case Op::kSubtract:
      if (is_constant(b, 0.0)) return a;
      if (a == b) return constant(0.0);
      if (is_constant(a, 0.0)) return make(Op::kNegate, b);
      break;
    case Op::kMultiply:
      if (is_constant(a, 1.0)) return b;
      if (is_constant(b, 1.0)) return a;
      if (is_constant(a, 0.0) || is_constant(b, 0.0)) return constant(0.0);
      if (is_constant(a, -1.0)) return make(Op::kNegate, b);
      if (is_constant(b, -1.0)) return make(Op::kNegate, a);
      break;
    case Op::kDivide:
      if (is_constant(b, 1.0)) return a;
      if (is_constant(a, 0.0)) return a;
      break;
    case Op::kNegate:
      if (at(a).op == Op::kNegate) return at(a).of[0];
      break;
    case Op::kPower:
      if (node.value == 0.0) return constant(1.0);
      if (node.value == 1.0) return a;
      if (node.value == 2.0) return make(Op::kMultiply, a, a);
      break;
    case Op::kSelect:
      if (b == c) return b;
      if (at(a).op == Op::kConstant) return at(a).value != 0.0 ? b : c;
      break;
    default:
      break;
  }
  return folded(node);
}
/// The constant that an operation on constants is; -1 when it is none.
std::int32_t Tape::folded(const Node& node) {
  const int operands = kOpOperands[static_cast<std::size_t>(node.op)];
  if (operands == 0 || operands > 2) return -1;
  double value[2] = {};
  for (int n = 0; n < operands; ++n) {
    const Node& operand = at(node.of[static_cast<std::size_t>(n)]);
    if (operand.op != Op::kConstant) return -1;
    value[n] = operand.value;
  }
  return constant(result_of(node.op, value[0], value[1], node.value));
}

std::int32_t Tape::plus(std::int32_t a, std::int32_t b) {
  if (a < 0) return b;
  if (b < 0) return a;
  if (at(b).op == Op::kNegate) return make(Op::kSubtract, a, at(b).of[0]);
  if (at(a).op == Op::kNegate) return make(Op::kSubtract, b, at(a).of[0]);
  return make(Op::kAdd, a, b);
}
std::int32_t Tape::times(std::int32_t a, std::int32_t b) {
  if (a < 0 || b < 0) return -1;
  if (at(a).op == Op::kNegate) {
    const std::int32_t product = times(at(a).of[0], b);
    return make(Op::kNegate, product);
  }
  if (at(b).op == Op::kNegate) return times(b, a);
  return make(Op::kMultiply, a, b);
}

bool Tape::has_derivatives(std::int32_t node, int order) const {
  const auto n = static_cast<std::size_t>(node);
  return n < known_.size() && known_[n] >= order;
}
const Tape::First& Tape::first(std::int32_t node) const { return first_[static_cast<std::size_t>(node)]; }
const Tape::Second& Tape::second(std::int32_t node) const { return second_[static_cast<std::size_t>(node)]; }

void Tape::differentiate(std::span<const std::int32_t> outputs, int order) {
  const std::size_t count = nodes_.size();  // derivatives come behind
  std::vector<bool> is_needed(count, false);
  for (const std::int32_t output : outputs) is_needed[static_cast<std::size_t>(output)] = true;
  for (std::size_t n = count; n-- > 0;) {
    const int operands = kOpOperands[static_cast<std::size_t>(nodes_[n].op)];
    for (int m = 0; is_needed[n] && m < operands; ++m)
      is_needed[static_cast<std::size_t>(nodes_[n].of[static_cast<std::size_t>(m)])] = true;
  }
  first_.resize(std::max(first_.size(), count));
  second_.resize(std::max(second_.size(), count));
  known_.resize(std::max(known_.size(), count), 0);
  for (std::size_t n = 0; n < count; ++n) {
    const auto node = static_cast<std::int32_t>(n);
    if (!is_needed[n] || has_derivatives(node, order)) continue;
    first_[n].clear();
    second_[n].clear();
    if (nodes_[n].op == Op::kSelect) {
      select_derivatives(node, order);
    } else {
      const Partials by = partials(node, order);
      find_first(node, by);
      if (order == 2) find_second(node, by);
    }
    known_[n] = static_cast<std::int8_t>(order);
  }
}

/// Derivatives of the side that is chosen.
void Tape::select_derivatives(std::int32_t node, int order) {
  const auto [condition, yes, no] = at(node).of;
  const auto choose = [&](const auto& a, const auto& b, auto& to) {
    const std::int32_t zero = constant(0.0);
    std::size_t i = 0;
    std::size_t j = 0;
    while (i < a.size() || j < b.size()) {
      const bool takes_a = j == b.size() || (i < a.size() && a[i].first <= b[j].first);
      const bool takes_b = i == a.size() || (j < b.size() && b[j].first <= a[i].first);
      const std::int32_t variable = takes_a ? a[i].first : b[j].first;
      const std::int32_t then = takes_a ? a[i++].second : zero;
      const std::int32_t otherwise = takes_b ? b[j++].second : zero;
      to.emplace_back(variable, make(Op::kSelect, condition, then, otherwise));
    }
  };
  const auto n = static_cast<std::size_t>(node);
  choose(First(first(yes)), First(first(no)), first_[n]);
  if (order == 2) choose(Second(second(yes)), Second(second(no)), second_[n]);
}

void Tape::find_first(std::int32_t node, const Partials& by) {
  First sum;
  const Node own = at(node);
  if (own.op == Op::kVariable) {
    if (own.of[0] < variables_) sum.emplace_back(own.of[0], constant(1.0));
  } else {
    std::vector<std::int32_t> all(static_cast<std::size_t>(variables_), -1);
    const auto add_share = [&](std::int32_t operand, std::int32_t partial) {
      if (partial < 0) return;
      for (const auto& [i, slope] : First(first(operand))) {
        auto& to = all[static_cast<std::size_t>(i)];
        to = plus(to, times(partial, slope));
      }
    };
    add_share(own.of[0], by.a);
    add_share(own.of[1], by.b);
    for (std::int32_t i = 0; i < variables_; ++i) {
      const std::int32_t slope = all[static_cast<std::size_t>(i)];
      if (slope >= 0 && !is_constant(slope, 0.0)) sum.emplace_back(i, slope);
    }
  }
  first_[static_cast<std::size_t>(node)] = std::move(sum);
}

void Tape::find_second(std::int32_t node, const Partials& by) {
  const Node own = at(node);
  if (own.op == Op::kVariable) return;
  Second shares;  // several of a pair
  const auto add_linear = [&](std::int32_t operand, std::int32_t partial) {
    if (partial < 0) return;
    for (const auto& [pair, curvature] : Second(second(operand)))
      shares.emplace_back(pair, times(partial, curvature));
  };
  const auto add_square = [&](std::int32_t operand, std::int32_t partial) {
    if (partial < 0) return;
    const First slopes = first(operand);
    for (std::size_t j = 0; j < slopes.size(); ++j) {
      const std::int32_t scaled = times(partial, slopes[j].second);
      for (std::size_t i = 0; i <= j; ++i)
        shares.emplace_back(pair_of(slopes[i].first, slopes[j].first), times(scaled, slopes[i].second));
    }
  };
  add_linear(own.of[0], by.a);
  add_linear(own.of[1], by.b);
  add_square(own.of[0], by.aa);
  add_square(own.of[1], by.bb);
  if (by.ab >= 0) {
    const First left = first(own.of[0]);
    const First right = first(own.of[1]);
    for (const auto& [i, a] : left) {
      const std::int32_t scaled = times(by.ab, a);
      for (const auto& [j, b] : right) {
        std::int32_t share = times(scaled, b);
        if (i == j) share = plus(share, share);
        shares.emplace_back(pair_of(std::min(i, j), std::max(i, j)), share);
      }
    }
  }
  std::stable_sort(shares.begin(), shares.end(),
                   [](const auto& l, const auto& r) { return l.first < r.first; });
  Second sum;
  for (const auto& [pair, share] : shares) {
    if (!sum.empty() && sum.back().first == pair) {
      sum.back().second = plus(sum.back().second, share);
    } else {
      sum.emplace_back(pair, share);
    }
  }
  std::erase_if(sum, [&](const auto& entry) { return is_constant(entry.second, 0.0); });
  second_[static_cast<std::size_t>(node)] = std::move(sum);
}

Tape::Partials Tape::partials(std::int32_t node, int order) {
  const Node own = at(node);
  const auto [a, b, c] = own.of;
  const std::int32_t one = constant(1.0);
  switch (own.op) {
    case Op::kAdd:
      return {.a = one, .b = one};
    case Op::kSubtract:
      return {.a = one, .b = constant(-1.0)};
    case Op::kNegate:
      return {.a = constant(-1.0)};
    case Op::kMultiply:
      return {.a = b, .b = a, .ab = one};
    case Op::kDivide: {
      const std::int32_t inverse = make(Op::kDivide, one, b);
      const std::int32_t by_b = make(Op::kNegate, make(Op::kMultiply, node, inverse));
      Partials by{.a = inverse, .b = by_b};
      if (order == 2) {
        by.ab = make(Op::kNegate, make(Op::kMultiply, inverse, inverse));
        by.bb = make(Op::kMultiply, constant(-2.0), make(Op::kMultiply, by_b, inverse));
      }
      return by;
    }
    case Op::kAtan2: {  // of y = a and x = b
      const std::int32_t square =
          make(Op::kDivide, one, make(Op::kAdd, make(Op::kMultiply, a, a), make(Op::kMultiply, b, b)));
      const std::int32_t by_a = make(Op::kMultiply, b, square);
      const std::int32_t by_b = make(Op::kNegate, make(Op::kMultiply, a, square));
      Partials by{.a = by_a, .b = by_b};
      if (order == 2) {
        const std::int32_t twice = make(Op::kMultiply, constant(2.0), make(Op::kMultiply, by_a, by_b));
        by.aa = twice;
        by.bb = make(Op::kNegate, twice);
        by.ab = make(Op::kSubtract, make(Op::kMultiply, by_b, by_b), make(Op::kMultiply, by_a, by_a));
      }
      return by;
    }
    default:
      return kOpOperands[static_cast<std::size_t>(own.op)] == 1 ? unary_partials(node, order) : Partials{};
  }
}

Tape::Partials Tape::unary_partials(std::int32_t node, int order) {
  const Node own = at(node);
  const std::int32_t a = own.of[0];
  const std::int32_t one = constant(1.0);
  const auto negative = [&](std::int32_t of) { return make(Op::kNegate, of); };
  const auto product = [&](std::int32_t l, std::int32_t r) { return make(Op::kMultiply, l, r); };
  const auto twice = [&](std::int32_t of) { return product(constant(2.0), of); };
  const auto inverse = [&](std::int32_t of) { return make(Op::kDivide, one, of); };
  const bool wants = order == 2;
  switch (own.op) {
    case Op::kSin:
      return {.a = make(Op::kCos, a), .aa = wants ? negative(node) : -1};
    case Op::kCos:
      return {.a = negative(make(Op::kSin, a)), .aa = wants ? negative(node) : -1};
    case Op::kTan: {
      const std::int32_t slope = make(Op::kAdd, one, product(node, node));
      return {.a = slope, .aa = wants ? twice(product(node, slope)) : -1};
    }
    case Op::kAtan: {
      const std::int32_t slope = inverse(make(Op::kAdd, one, product(a, a)));
      return {.a = slope, .aa = wants ? negative(twice(product(a, product(slope, slope)))) : -1};
    }
    case Op::kAsin:
    case Op::kAcos: {
      const std::int32_t square = inverse(make(Op::kSubtract, one, product(a, a)));
      const std::int32_t root = make(Op::kSqrt, square);
      const std::int32_t slope = own.op == Op::kAsin ? root : negative(root);
      return {.a = slope, .aa = wants ? product(a, product(slope, square)) : -1};
    }
    case Op::kExp:
      return {.a = node, .aa = wants ? node : -1};
    case Op::kLog: {
      const std::int32_t slope = inverse(a);
      return {.a = slope, .aa = wants ? negative(product(slope, slope)) : -1};
    }
    case Op::kTanh: {
      const std::int32_t slope = make(Op::kSubtract, one, product(node, node));
      return {.a = slope, .aa = wants ? negative(twice(product(node, slope))) : -1};
    }
    case Op::kSqrt: {
      const std::int32_t slope = make(Op::kDivide, constant(0.5), node);
      return {.a = slope, .aa = wants ? negative(product(constant(0.5), make(Op::kDivide, slope, a))) : -1};
    }
    case Op::kPower: {
      const double n = own.value;
      const auto power = [&](double factor, double exponent) {
        return product(constant(factor), make(Op::kPower, a, -1, -1, exponent));
      };
      return {.a = power(n, n - 1.0), .aa = wants ? power(n * (n - 1.0), n - 2.0) : -1};
    }
    default:
      return {};
  }
}

}  // namespace chicane::python
