# SPDX-License-Identifier: MIT
"""A recorded problem as C++: a structured problem of the library (docs/solver_guide.md)."""
from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from ._problem import Problem
    from ._symbols import Symbol

_IDENTIFIER = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
_CALLS = {"sin": "sin", "cos": "cos", "tan": "tan", "atan": "atan", "asin": "asin", "acos": "acos", "exp": "exp", "log": "log", "tanh": "tanh",
          "sqrt": "sqrt"}
_MOST_INLINED = 150
"""Operations of a function up to which the compiler inlines it: beyond, it would take minutes and gigabytes."""
_SIGNS = {"add": "+", "subtract": "-", "multiply": "*", "divide": "/"}
_USING = "    using chicane::sin, chicane::cos, chicane::tan, chicane::atan, chicane::asin, chicane::acos, chicane::exp, chicane::log;\n" \
         "    using chicane::tanh, chicane::sqrt, chicane::pow, chicane::atan2, chicane::select;\n"


def number(value: float) -> str:
    """As C++ reads it, to the last bit."""
    if np.isinf(value):
        return "kInfinity" if value > 0 else "-kInfinity"
    text = repr(float(value))
    return f"({text})" if value < 0 else text


class _Writer:
    """The body of one function."""

    def __init__(self, problem: Problem, is_end: bool) -> None:
        self.nodes = problem.graph.nodes
        self.nx = problem.nx
        self.is_end = is_end
        self.names: dict[int, str] = {}
        self.is_data: dict[int, bool] = {}
        self.lines: list[str] = []

    def write(self, outputs: list[Symbol]) -> str:
        needed, stack = set(), [symbol.node for symbol in outputs]
        while stack:
            node = stack.pop()
            if node in needed:
                continue
            needed.add(node)
            stack += self.operands(node)
        for node in sorted(needed):
            self.name(node)
        values = ", ".join(self.names[symbol.node] for symbol in outputs)
        return _USING + "\n".join(self.lines) + f"\n    return std::make_tuple({values});\n"

    def operands(self, node: int) -> list[int]:
        op, *of, _ = self.nodes[node]
        return [] if op in ("variable", "parameter", "stage", "constant") else [each for each in of if each >= 0]

    def name(self, node: int) -> None:
        op, a, _, _, value = self.nodes[node]
        self.is_data[node] = op != "variable" and all(self.is_data[each] for each in self.operands(node))
        if op == "constant":
            self.names[node] = number(value)
        elif op == "variable":
            self.names[node] = f"std::get<{a}>(x)" if a < self.nx else f"std::get<{a - self.nx}>(u)"
        elif op == "parameter":
            self.names[node] = f"p[{a}].at({'kHorizon' if self.is_end else 'k'})"
        elif op == "stage":
            self.names[node] = "static_cast<double>(kHorizon)" if self.is_end else "chicane::solver::stage_number(k)"
        else:
            self.names[node] = f"t{node}"
            self.lines.append(f"    const auto t{node} = {self.expression(node)};")

    def expression(self, node: int) -> str:
        op, _, _, _, value = self.nodes[node]
        of = [self.names[each] for each in self.operands(node)]
        if op in _SIGNS:
            return f"{of[0]} {_SIGNS[op]} {of[1]}"
        if op == "negate":
            return f"-{of[0]}"
        if op == "power":
            return f"pow({of[0]}, {number(value)})"
        if op == "less":
            return f"select({of[0]} < {of[1]}, 1.0, 0.0)" if self.is_data[node] else f"select({of[0]} < {of[1]}, 1.0 + 0.0 * {self.of_variables(node)}, 0.0)"
        if op == "select":
            if self.is_data[self.operands(node)[0]]:             # the same type whatever the data
                return f"{of[0]} * {of[1]} + (1.0 - {of[0]}) * {of[2]}"
            return f"select({of[0]} > 0.5, {of[1]}, {of[2]})"
        return f"{_CALLS.get(op, op)}({', '.join(of)})" if op != "atan2" else f"atan2({of[0]}, {of[1]})"

    def of_variables(self, node: int) -> str:
        return next(self.names[each] for each in self.operands(node) if not self.is_data[each])


def _function(problem: Problem, name: str, rows: list[Symbol]) -> str:
    is_end = name.startswith("terminal")
    body = _Writer(problem, is_end).write(rows)
    head = "template <class X>" if is_end else "template <class K, class X, class U>"
    given = "[[maybe_unused]] const X& x" if is_end else "[[maybe_unused]] K k, [[maybe_unused]] const X& x, [[maybe_unused]] const U& u"
    inline = "CHICANE_INLINE " if body.count("\n") <= _MOST_INLINED else ""
    return f"  {head}\n  {inline}auto {name}({given}) const {{\n{body}  }}\n"


def _penalties(problem: Problem) -> str:
    count = len(problem.penalties)
    if count == 0:
        return ""
    rows = ", ".join(f"chicane::solver::SoftPenalty{{{number(linear)}, {number(square)}, {number(cap)}}}" for linear, square, cap in problem.penalties)
    names = ", ".join('"' + name.replace("\\", "\\\\").replace('"', '\\"') + '"' for name in problem.names["constraint"])
    text = (f"  [[nodiscard]] chicane::solver::SoftPenalty soft_penalty(int c) const {{\n    static constexpr std::array<chicane::solver::SoftPenalty, {count}> "
            f"kPenalties{{{rows}}};\n    return kPenalties[static_cast<std::size_t>(c)];\n  }}\n"
            f"  [[nodiscard]] std::string_view constraint_name(int c) const {{\n    static constexpr std::array<std::string_view, {count}> kNames{{{names}}};\n"
            "    return kNames[static_cast<std::size_t>(c)];\n  }\n")
    if any(problem.is_hard):
        flags = ", ".join("true" if hard else "false" for hard in problem.is_hard)
        text += (f"  [[nodiscard]] bool is_hard(int c) const {{\n    static constexpr std::array<bool, {count}> kIsHard{{{flags}}};\n"
                 "    return kIsHard[static_cast<std::size_t>(c)];\n  }\n")
    return text


def _bounds(problem: Problem) -> str:
    lower, upper = problem.input_bounds
    text = ""
    for name, values in (("lower", lower), ("upper", upper)):
        rows = [", ".join(number(value) for value in row) for row in values]
        is_same = len(set(rows)) == 1
        fill = f"{name}.fill({{{rows[0]}}});" if is_same else f"{name} = {{{{{', '.join('{' + row + '}' for row in rows)}}}}};"
        text += "    " + fill + "\n"
    return text


def header(problem: Problem, name: str) -> str:
    """The header's text."""
    if not _IDENTIFIER.fullmatch(name):
        raise ValueError(f"export: got the name {name!r}, expected a C++ identifier")
    rows = problem.all_rows()
    count = problem.full_count
    sizes = [f"kNx = {problem.nx}, kNu = {problem.all_inputs}, kNr = {len(rows['residual'])}, kNe = {len(rows['terminal_residual'])}, "
             f"kNc = {len(rows['constraint'])}"]
    for kind, size in (("equality", "kNh"), ("terminal_equality", "kNeh"), ("terminal_constraint", "kNec")):
        if rows[kind]:
            sizes.append(f"{size} = {len(rows[kind])}")
    functions = "".join(_function(problem, kind, rows[kind]) for kind in rows if rows[kind] or kind in ("residual", "terminal_residual"))
    hidden = "".join(f"    for (double& value : p[{problem.parameters + n}].values) value = {number(value)};\n"
                     for n, value in enumerate(problem.hidden_parameters()))
    n = problem.horizon
    return f"""// Written by chicane (ocp.export). An optimal control problem for chicane::solver::OcpSolver<{name}, {name}::kHorizon>.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <string_view>
#include <tuple>

#include "chicane/base/compiler.hpp"
#include "chicane/base/math.hpp"
#include "chicane/solver/ocp_solver.hpp"

struct {name} {{
  static constexpr int {", ".join(sizes)};
  static constexpr const char* kName = "{name}";
  static constexpr int kHorizon = {n}, kParameters = {problem.parameters};
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  static constexpr double kCostOffset = {number(problem.cost_offset())};  ///< the solver's cost lacks this

  std::array<chicane::solver::StageData<kHorizon + 1>, {max(count, 1)}> p{{}};  ///< p[i][k]: parameter i of stage k
  std::array<std::array<double, kNu>, kHorizon> lower{{}}, upper{{}};

  {name}() {{
{_bounds(problem)}{hidden}  }}
{functions}{_penalties(problem)}  [[nodiscard]] std::array<double, kNu> input_lower(int k) const {{ return lower[static_cast<std::size_t>(k)]; }}
  [[nodiscard]] std::array<double, kNu> input_upper(int k) const {{ return upper[static_cast<std::size_t>(k)]; }}
}};
"""


def c_source(problem: Problem, name: str) -> str:
    """A C++ source with the problem behind the C function `name`."""
    return "// clang-format off\n" + header(problem, f"Exported_{name}").replace("#pragma once\n", "", 1) + f"""
#include "chicane/solver/c_interface.hpp"

extern "C" [[gnu::visibility("default")]] const chicane_problem* {name}(void) {{ return chicane::solver::c_problem<Exported_{name}>(); }}
"""


def c_header(problem: Problem, name: str) -> str:
    """Declares that function."""
    rows = {kind: len(own) for kind, own in problem.all_rows().items()}
    return f"""/* Written by chicane (ocp.export_c). nx {problem.nx}, nu {problem.all_inputs}, horizon {problem.horizon}, {problem.parameters} parameters,
 * {rows["constraint"]} constraints. Beside {name}.cpp, which a C++ compiler compiles; used by chicane/solver.h. */
#ifndef CHICANE_PROBLEM_{name.upper()}_H
#define CHICANE_PROBLEM_{name.upper()}_H

#include "chicane/solver.h"

#ifdef __cplusplus
extern "C"
#endif
const chicane_problem* {name}(void);

#endif
"""


def write_c(problem: Problem, path: Path) -> None:
    """path.h and path.cpp."""
    if not _IDENTIFIER.fullmatch(path.name):
        raise ValueError(f"export_c: got the name {path.name!r}, expected a C identifier, with no ending: {path.name!r}.h and .cpp are written")
    path.with_name(path.name + ".cpp").write_text(c_source(problem, path.name), encoding="utf-8")
    path.with_name(path.name + ".h").write_text(c_header(problem, path.name), encoding="utf-8")
