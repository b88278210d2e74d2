#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A controller as a layer of PyTorch: the inputs of an optimal control problem as a function that is differentiated by its state and its
parameters. Finds the weights of a driver's cost from what the driver did.

    apt-get install python3-torch
    ./run.sh python examples/python/torch_layer.py"""
from __future__ import annotations

from typing import Any

import numpy as np
import torch

import chicane as ch


class Control(torch.autograd.Function):
    """u of shape (horizon, nu) from x0 (nx,) and p (parameters,). Where the solution has a kink, the gradient is that of one side."""

    @staticmethod
    def forward(ctx: Any, ocp: ch.Problem, x0: torch.Tensor, p: torch.Tensor) -> torch.Tensor:
        ctx.solution = ocp.solve(x0.detach().numpy(), p.detach().numpy(), tolerance=1e-10)
        if not ctx.solution:
            raise ValueError(f"Control: got {ctx.solution!r}, expected a usable solution")
        return torch.from_numpy(ctx.solution.u.copy())

    @staticmethod
    def backward(ctx: Any, *of_u: torch.Tensor) -> tuple[None, torch.Tensor | None, torch.Tensor | None]:
        def pulled(of: str) -> torch.Tensor:
            return torch.einsum("km,kmn->n", of_u[0], torch.from_numpy(ctx.solution.sensitivity(of).u))
        return None, pulled("x0") if ctx.needs_input_grad[1] else None, pulled("p") if ctx.needs_input_grad[2] else None


def driver() -> ch.Problem:
    """Comes to rest at a line. Parameters: what distance and effort cost."""
    ocp = ch.Problem(nx=2, nu=1, horizon=20, parameters=2)
    ocp.dynamics(ch.rk4(lambda x, u: [x[1], u[0] - 0.1 * x[1] * x[1]], 0.1))
    ocp.cost(lambda x, u, p: p[0] * x[0]**2 + 0.1 * x[1]**2 + p[1] * u[0]**2)
    ocp.terminal(lambda x: x @ x)
    ocp.bounds(u=(-4, 4))
    return ocp


def learn(turns: int = 60) -> tuple[np.ndarray, list[float]]:
    """Weights from a driver's inputs, and the loss of each turn."""
    ocp = driver()
    starts = [torch.tensor(start, dtype=torch.float64) for start in ([1.0, 0.0], [-0.5, 1.0], [0.3, -0.8])]
    shown = [torch.from_numpy(ocp.solve(start.numpy(), [2.0, 0.3]).u) for start in starts]
    logarithms = torch.zeros(2, dtype=torch.float64, requires_grad=True)            # of the weights, which stay above 0
    optimizer = torch.optim.Adam([logarithms], lr=0.1)
    losses = []
    for _ in range(turns):
        optimizer.zero_grad()
        loss = sum(((Control.apply(ocp, start, logarithms.exp()) - seen)**2).mean() for start, seen in zip(starts, shown))
        loss.backward()
        optimizer.step()
        losses.append(float(loss))
    return logarithms.exp().detach().numpy(), losses


if __name__ == "__main__":
    weights, losses = learn()
    print(f"loss {losses[0]:.2e}, after {len(losses)} turns {losses[-1]:.2e}; weights {weights.round(3)}, the driver's 2 and 0.3")
