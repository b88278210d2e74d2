// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "chicane/base/compiler.hpp"
#include "chicane/base/pack.hpp"
#include "traced/program.hpp"

namespace chicane::python {

/// Runs operations on the slots `s`. V is a pack of the instruction set that this is compiled for.
template <class V>
[[gnu::noinline]] void run_code(
    const Instruction* code, std::size_t count,
    V* s) noexcept {  // NOLINT(readability-function-size): one case for each operation
  for (const Instruction* end = code + count; code != end; ++code) {
    const V& a = s[code->a];
    V& to = s[code->to];
    switch (code->op) {
      case Op::kAdd:
        to = a + s[code->b];
        break;
      case Op::kSubtract:
        to = a - s[code->b];
        break;
      case Op::kMultiply:
        to = a * s[code->b];
        break;
      case Op::kFused:
        to = fused_multiply_add(a, s[code->b], s[code->c]);
        break;
      case Op::kNegativeFused:
        to = fused_negative_multiply_add(a, s[code->b], s[code->c]);
        break;
      case Op::kDivide:
        to = a / s[code->b];
        break;
      case Op::kNegate:
        to = -a;
        break;
      case Op::kSin:
        to = sin(a);
        break;
      case Op::kCos:
        to = cos(a);
        break;
      case Op::kTan:
        to = tan(a);
        break;
      case Op::kAtan:
        to = atan(a);
        break;
      case Op::kAsin:
        to = asin(a);
        break;
      case Op::kAcos:
        to = acos(a);
        break;
      case Op::kExp:
        to = exp(a);
        break;
      case Op::kLog:
        to = log(a);
        break;
      case Op::kTanh:
        to = tanh(a);
        break;
      case Op::kSqrt:
        to = sqrt(a);
        break;
      case Op::kPower:
        to = pow(a, code->value);
        break;
      case Op::kAtan2:
        to = atan2(a, s[code->b]);
        break;
      case Op::kLess:
        to = select(a < s[code->b], V(1.0), V(0.0));
        break;
      case Op::kSelect:
        to = select(a == V(0.0), s[code->c], s[code->b]);
        break;
      case Op::kVariable:
      case Op::kParameter:
      case Op::kStage:
      case Op::kConstant:
        break;  // have slots that are filled before
    }
  }
}

}  // namespace chicane::python
