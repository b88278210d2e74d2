# SPDX-License-Identifier: MIT
"""A cost as a sum of squares as far as it is one (docs/python_problems.md, eq. 3 and 4)."""
from __future__ import annotations

import numpy as np

from ._symbols import Graph, Symbol

Term = tuple[float, tuple[int, ...]]
"""A number times nodes."""


def _terms(graph: Graph, node: int, factor: float, whole: set[int]) -> list[Term]:
    """A node as a sum; what is no sum is one term."""
    op, a, b, _, value = graph.nodes[node]
    if op == "constant":
        return [(factor * value, ())]
    if op in ("add", "subtract"):
        return _terms(graph, a, factor, whole) + _terms(graph, b, factor if op == "add" else -factor, whole)
    if op == "negate":
        return _terms(graph, a, -factor, whole)
    if op == "multiply":
        for number, other in ((a, b), (b, a)):
            known = graph.value_of(number)
            if known is not None:
                return _terms(graph, other, factor * known, whole)
        return _product(graph, a, b, factor, whole)
    if op == "divide" and (known := graph.value_of(b)):
        return _terms(graph, a, factor / known, whole)
    return [(factor, (node,))]


def _right_factors(graph: Graph) -> set[int]:
    """What is multiplied from the right: of x @ Q @ x the entries of x, which stay whole."""
    return {node[2] for node in graph.nodes if node[0] == "multiply" and graph.value_of(node[1]) is None}


def _atoms(graph: Graph, node: int, factor: float, whole: set[int]) -> list[tuple[float, int]]:
    """A linear combination, whose parts stay whole where they are multiplied by a number."""
    op, a, b, _, _ = graph.nodes[node]
    if op in ("add", "subtract") and node not in whole:
        return _atoms(graph, a, factor, whole) + _atoms(graph, b, factor if op == "add" else -factor, whole)
    return _scaled(graph, node, factor)


def _product(graph: Graph, a: int, b: int, factor: float, whole: set[int]) -> list[Term]:
    """A square stays one; else the left factor's parts times the right one, as in x @ Q @ x."""
    if a == b:
        return [(share * other, tuple(sorted((left, right)))) for share, left in _scaled(graph, a, factor) for other, right in
                _scaled(graph, b, 1.0)]
    return [(share * other, tuple(sorted((left, right)))) for share, left in _atoms(graph, a, factor, whole) for other, right in
            _scaled(graph, b, 1.0)]


def _scaled(graph: Graph, node: int, factor: float) -> list[tuple[float, int]]:
    """A node as a number times another."""
    op, a, b, _, _ = graph.nodes[node]
    if op == "multiply":
        for number, other in ((a, b), (b, a)):
            known = graph.value_of(number)
            if known is not None:
                return [(factor * known, other)]
    if op == "negate":
        return [(-factor, a)]
    return [(factor, node)]


def split(cost: Symbol) -> tuple[list[Symbol], Symbol | None, float]:
    """Residuals r, what is left of the cost and a number, with cost = ½ Σ r² + rest + number."""
    graph = cost.graph
    form: dict[tuple[int, ...], float] = {}
    for factor, nodes in _terms(graph, cost.node, 1.0, _right_factors(graph)):
        form[nodes] = form.get(nodes, 0.0) + factor
    number = form.pop((), 0.0)
    pairs = {nodes: factor for nodes, factor in form.items() if len(nodes) == 2 and factor != 0.0}
    rest = {nodes: factor for nodes, factor in form.items() if len(nodes) == 1 and factor != 0.0}
    residuals: list[Symbol] = []
    for group in _groups(pairs):
        atoms = sorted({node for nodes in group for node in nodes})
        matrix = np.zeros((len(atoms), len(atoms)))
        for (left, right), factor in group.items():
            matrix[atoms.index(left), atoms.index(right)] += 0.5 * factor
            matrix[atoms.index(right), atoms.index(left)] += 0.5 * factor
        values, vectors = np.linalg.eigh(matrix)
        if values[0] < -1e-12 * max(1.0, values[-1]):
            rest |= group                                            # not convex: as it is
            continue
        for value, vector in zip(values, vectors.T):
            if value > 1e-14 * max(values[-1], 1e-300):
                residuals.append(_combination(graph, np.sqrt(2.0 * value) * vector, atoms))
    if not rest:
        return residuals, None, number
    left_over = Symbol(graph, graph.constant(0.0))
    for nodes, factor in rest.items():
        term = Symbol(graph, nodes[0])
        for node in nodes[1:]:
            term = term * Symbol(graph, node)
        left_over = left_over + factor * term
    return residuals, left_over, number


def _groups(pairs: dict[tuple[int, ...], float]) -> list[dict[tuple[int, ...], float]]:
    """Those that share a node go together."""
    groups: list[tuple[set[int], dict[tuple[int, ...], float]]] = []
    for nodes, factor in pairs.items():
        members, own = set(nodes), {nodes: factor}
        apart = []
        for others, group in groups:
            if others & members:
                members |= others
                own |= group
            else:
                apart.append((others, group))
        groups = [*apart, (members, own)]
    return [dict(sorted(group.items())) for _, group in groups]


def _combination(graph: Graph, weights: np.ndarray, atoms: list[int]) -> Symbol:  # type: ignore[type-arg]
    total = Symbol(graph, graph.constant(0.0))
    for weight, node in zip(weights, atoms):
        if weight != 0.0:
            total = total + float(weight) * Symbol(graph, node)
    return total
