// SPDX-License-Identifier: MIT
#include "traced/program.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace chicane::python {
namespace {

/// Turns nodes into operations on as few slots as that takes.
class Emitter {
 public:
  explicit Emitter(const Tape& tape) : tape_{tape}, uses_(tape.size(), 0), slot_(tape.size(), kNone) {}

  Program run(std::span<const std::int32_t> outputs, int order) {
    for (const std::int32_t output : outputs) {
      need(output);
      if (order >= 1) need_all(tape_.first(output));
      if (order >= 2) need_all(tape_.second(output));
    }
    for (std::size_t n = uses_.size(); n-- > 0;) {
      if (uses_[n] > 0 && !is_fused_product(n)) choose_operands(n);
    }
    place_inputs();
    for (std::size_t n = 0; n < uses_.size(); ++n) {
      if (uses_[n] > 0 && slot_[n] == kNone && !is_fused_product(n)) emit(n);
    }
    for (const std::int32_t output : outputs) add_row(output, order);
    return std::move(program_);
  }

 private:
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;
  static constexpr int kKept = 1 << 24;  ///< uses of a result, which no use ends

  void need(std::int32_t node) { uses_[static_cast<std::size_t>(node)] += kKept; }
  template <class Entries>
  void need_all(const Entries& entries) {
    for (const auto& entry : entries) need(entry.second);
  }
  [[nodiscard]] const Node& node(std::size_t n) const { return tape_.at(static_cast<std::int32_t>(n)); }

  /// A product that its only use takes up: a b + c is one operation.
  [[nodiscard]] bool is_fused_product(std::size_t n) const { return !is_fused_.empty() && is_fused_[n]; }
  /// Counts what a node that is computed reads, and marks the product that it takes up.
  void choose_operands(std::size_t n) {
    const Node& own = node(n);
    if (is_fused_.empty()) is_fused_.resize(uses_.size(), false);
    for (int m = 0; m < kOpOperands[static_cast<std::size_t>(own.op)]; ++m)
      ++uses_[static_cast<std::size_t>(own.of[static_cast<std::size_t>(m)])];
    if (own.op != Op::kAdd && own.op != Op::kSubtract) return;
    candidates_.push_back(n);
  }
  void place_inputs() {
    mark_fused();
    for (std::size_t n = 0; n < uses_.size(); ++n) {
      if (uses_[n] == 0) continue;
      const Node& own = node(n);
      const auto from = static_cast<std::uint32_t>(own.of[0]);
      if (own.op == Op::kConstant) program_.constants.emplace_back(slot_[n] = program_.slots++, own.value);
      if (own.op == Op::kVariable) program_.variables.push_back({slot_[n] = program_.slots++, from});
      if (own.op == Op::kParameter) program_.parameters.push_back({slot_[n] = program_.slots++, from});
      if (own.op == Op::kStage) program_.stages.push_back(slot_[n] = program_.slots++);
      if (slot_[n] != kNone) uses_[n] = kKept;
    }
  }
  /// After all uses are known: those products that are used once.
  void mark_fused() {
    for (const std::size_t n : candidates_) {
      const Node& own = node(n);
      for (const int m : {1, 0}) {
        if (m == 0 && own.op == Op::kSubtract) break;  // a b − c is two operations
        const auto product = static_cast<std::size_t>(own.of[static_cast<std::size_t>(m)]);
        if (node(product).op != Op::kMultiply || uses_[product] != 1) continue;
        is_fused_[product] = true;
        fused_.resize(uses_.size(), -1);
        fused_[n] = m;
        break;
      }
    }
  }
  std::uint32_t take() {
    if (free_.empty()) return program_.slots++;
    const std::uint32_t slot = free_.back();
    free_.pop_back();
    return slot;
  }
  void use(std::size_t n) {
    if (--uses_[n] == 0) free_.push_back(slot_[n]);
  }
  void emit(std::size_t n) {
    const Node& own = node(n);
    Instruction what{.op = own.op, .value = own.value};
    std::size_t reads[3] = {};
    int count = kOpOperands[static_cast<std::size_t>(own.op)];
    for (int m = 0; m < count; ++m) reads[m] = static_cast<std::size_t>(own.of[static_cast<std::size_t>(m)]);
    if (!fused_.empty() && fused_[n] >= 0) {
      const Node& product = node(reads[fused_[n]]);
      const std::size_t other = reads[1 - fused_[n]];
      reads[0] = static_cast<std::size_t>(product.of[0]);
      reads[1] = static_cast<std::size_t>(product.of[1]);
      reads[2] = other;
      what.op = own.op == Op::kAdd ? Op::kFused : Op::kNegativeFused;
      count = 3;
    }
    std::uint32_t* const to[3] = {&what.a, &what.b, &what.c};
    for (int m = 0; m < count; ++m) *to[m] = slot_[reads[m]];
    for (int m = 0; m < count; ++m) use(reads[m]);
    what.to = slot_[n] = take();
    program_.code.push_back(what);
  }
  void add_row(std::int32_t output, int order) {
    ProgramRow row{.value = slot_[static_cast<std::size_t>(output)],
                   .slopes = static_cast<std::uint32_t>(program_.slopes.size()),
                   .curvatures = static_cast<std::uint32_t>(program_.curvatures.size())};
    if (order >= 1) {
      for (const auto& [i, at] : tape_.first(output)) {
        const auto variable = static_cast<std::uint16_t>(i);
        program_.slopes.push_back({variable, variable, slot_[static_cast<std::size_t>(at)]});
        ++row.slope_count;
      }
    }
    if (order >= 2) {
      for (const auto& [pair, at] : tape_.second(output)) {
        auto j = static_cast<std::int32_t>((std::sqrt(8.0 * pair + 1.0) - 1.0) / 2.0);
        while (Tape::pair_of(0, j + 1) <= pair) ++j;
        while (Tape::pair_of(0, j) > pair) --j;
        program_.curvatures.push_back({static_cast<std::uint16_t>(pair - Tape::pair_of(0, j)),
                                       static_cast<std::uint16_t>(j), slot_[static_cast<std::size_t>(at)]});
        ++row.curvature_count;
      }
    }
    program_.rows.push_back(row);
  }

  const Tape& tape_;
  std::vector<int> uses_;
  std::vector<std::uint32_t> slot_;
  std::vector<bool> is_fused_;
  std::vector<int> fused_;  ///< operand of a sum that is a product and is taken up by it
  std::vector<std::size_t> candidates_;
  std::vector<std::uint32_t> free_;
  Program program_;
};

}  // namespace

Program make_program(const Tape& tape, std::span<const std::int32_t> outputs, int order) {
  return Emitter(tape).run(outputs, order);
}

TracedProblem make_traced_problem(int nx, int nu, int np, std::span<const Node> nodes,
                                  const std::array<std::vector<std::int32_t>, kFunctions>& outputs) {
  TracedProblem problem{.nx = nx, .nu = nu, .np = np, .programs = {}};
  Tape tape(nx + nu);
  std::vector<std::int32_t> number;
  number.reserve(nodes.size());
  for (Node node : nodes) {
    const int operands = kOpOperands[static_cast<std::size_t>(node.op)];
    for (int m = 0; m < operands; ++m) {
      auto& operand = node.of[static_cast<std::size_t>(m)];
      operand = number[static_cast<std::size_t>(operand)];
    }
    number.push_back(tape.add(node));
  }
  for (std::size_t f = 0; f < kFunctions; ++f) {
    std::vector<std::int32_t> rows;
    for (const std::int32_t output : outputs[f]) rows.push_back(number[static_cast<std::size_t>(output)]);
    tape.differentiate(rows, 2);
    for (int order = 0; order < 3; ++order)
      problem.programs[f][static_cast<std::size_t>(order)] = make_program(tape, rows, order);
  }
  return problem;
}

}  // namespace chicane::python
