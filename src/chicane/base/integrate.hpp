// SPDX-License-Identifier: MIT
#pragma once

namespace chicane {

/// One explicit Euler step of x' = f(x): x + dt f(x).
template <class X, class F>
[[nodiscard]] X euler(const F& f, const X& x, double dt) {
  return X(x + dt * f(x));
}

/// One classical Runge–Kutta step of x' = f(x); error O(dt⁵) per step for smooth f.
template <class X, class F>
[[nodiscard]] X rk4(const F& f, const X& x, double dt) {
  const X k1 = f(x);
  const X k2 = f(X(x + (0.5 * dt) * k1));
  const X k3 = f(X(x + (0.5 * dt) * k2));
  const X k4 = f(X(x + dt * k3));
  return X(x + (dt / 6.0) * (k1 + 2.0 * k2 + 2.0 * k3 + k4));
}

}  // namespace chicane
