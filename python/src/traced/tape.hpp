// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace chicane::python {

/// What a node of a tape does. Columns: enumerator, name in Python, number of operands.
#define CHICANE_TAPE_OPS(ROW)                                                                    \
  ROW(kVariable, "variable", 0)   /* number `index` of (x, u, p where that is differentiated) */ \
  ROW(kParameter, "parameter", 0) /* number `index` of p */                                      \
  ROW(kStage, "stage", 0)         /* the number of the stage */                                  \
  ROW(kConstant, "constant", 0)                                                                  \
  ROW(kAdd, "add", 2)                                                                            \
  ROW(kSubtract, "subtract", 2)                                                                  \
  ROW(kMultiply, "multiply", 2)                                                                  \
  ROW(kDivide, "divide", 2)                                                                      \
  ROW(kNegate, "negate", 1)                                                                      \
  ROW(kSin, "sin", 1)                                                                            \
  ROW(kCos, "cos", 1)                                                                            \
  ROW(kTan, "tan", 1)                                                                            \
  ROW(kAtan, "atan", 1)                                                                          \
  ROW(kAsin, "asin", 1)                                                                          \
  ROW(kAcos, "acos", 1)                                                                          \
  ROW(kExp, "exp", 1)                                                                            \
  ROW(kLog, "log", 1)                                                                            \
  ROW(kTanh, "tanh", 1)                                                                          \
  ROW(kSqrt, "sqrt", 1)                                                                          \
  ROW(kPower, "power", 1) /* to the constant `value` */                                          \
  ROW(kAtan2, "atan2", 2)                                                                        \
  ROW(kLess, "less", 2)                    /* 1 where a < b, else 0 */                           \
  ROW(kSelect, "select", 3)                /* b where a is not 0, else c */                      \
  ROW(kFused, "fused", 3)                  /* a b + c */                                         \
  ROW(kNegativeFused, "negative_fused", 3) /* c − a b */

#define CHICANE_ENUMERATOR(enumerator, name, operands) enumerator,
enum class Op : std::uint8_t { CHICANE_TAPE_OPS(CHICANE_ENUMERATOR) };
#undef CHICANE_ENUMERATOR
#define CHICANE_NAME(enumerator, name, operands) std::string_view{name},
inline constexpr std::array kOpNames{CHICANE_TAPE_OPS(CHICANE_NAME)};
#undef CHICANE_NAME
#define CHICANE_OPERANDS(enumerator, name, operands) operands,
inline constexpr std::array kOpOperands{CHICANE_TAPE_OPS(CHICANE_OPERANDS)};
#undef CHICANE_OPERANDS

/// One value of a graph, made of earlier ones.
struct Node {
  Op op = Op::kConstant;
  std::array<std::int32_t, 3> of{-1, -1, -1};  ///< operands; of[0] of a variable or parameter is its number
  double value = 0.0;                          ///< of a constant, or the exponent of a power
};

/// A graph of scalar operations in which equal ones exist once, with their derivatives as nodes of the same
/// graph: what is zero or one is never computed. Derivatives go forwards, value by value
/// (docs/python_problems.md, eq. 1 and 2).
class Tape {
 public:
  using First = std::vector<std::pair<std::int32_t, std::int32_t>>;   ///< variable, node; ascending
  using Second = std::vector<std::pair<std::int32_t, std::int32_t>>;  ///< pair_of(i, j), node; ascending

  /// Variables `most` and above are not differentiated.
  explicit Tape(int variables) : variables_{variables} {}

  std::int32_t add(const Node& node);
  [[nodiscard]] const Node& at(std::int32_t node) const { return nodes_[static_cast<std::size_t>(node)]; }
  [[nodiscard]] std::size_t size() const { return nodes_.size(); }

  /// Derivatives of everything that `outputs` are made of, up to `order` (1 or 2).
  void differentiate(std::span<const std::int32_t> outputs, int order);
  [[nodiscard]] const First& first(std::int32_t node) const;
  [[nodiscard]] const Second& second(std::int32_t node) const;

  static std::int32_t pair_of(std::int32_t i, std::int32_t j) { return j * (j + 1) / 2 + i; }

 private:
  /// Derivatives of an operation by its (at most two) operands, as nodes; -1 where they are zero.
  struct Partials {
    std::int32_t a = -1, b = -1, aa = -1, ab = -1, bb = -1;
  };
  std::int32_t constant(double value) { return add({.op = Op::kConstant, .value = value}); }
  std::int32_t make(Op op, std::int32_t a, std::int32_t b = -1, std::int32_t c = -1, double value = 0.0) {
    return add({.op = op, .of = {a, b, c}, .value = value});
  }
  [[nodiscard]] bool is_constant(std::int32_t node, double value) const {
    return at(node).op == Op::kConstant && at(node).value == value;
  }
  std::int32_t simplified(const Node& node);
  std::int32_t folded(const Node& node);
  std::int32_t plus(std::int32_t a, std::int32_t b);   ///< -1 is zero
  std::int32_t times(std::int32_t a, std::int32_t b);  ///< likewise
  Partials partials(std::int32_t node, int order);
  Partials unary_partials(std::int32_t node, int order);
  void find_first(std::int32_t node, const Partials& by);
  void find_second(std::int32_t node, const Partials& by);
  void select_derivatives(std::int32_t node, int order);
  [[nodiscard]] bool has_derivatives(std::int32_t node, int order) const;

  int variables_;
  std::vector<Node> nodes_;
  std::vector<std::int32_t> buckets_;  ///< an open hash table of nodes
  std::vector<First> first_;
  std::vector<Second> second_;
  std::vector<std::int8_t> known_;  ///< order up to which a node's derivatives are
  std::size_t used_ = 0;
};

}  // namespace chicane::python
