/* SPDX-License-Identifier: MIT
 * Swings a pole up by model predictive control, in C: preparation while the cycle runs, feedback when the state is measured.
 *
 *     cc -c cart_pole.c && c++ -std=c++20 -O2 -c cart_pole_problem.cpp && c++ cart_pole.o cart_pole_problem.o -lchicane_base -o cart_pole */
#include <math.h>
#include <stdio.h>

#include "cart_pole_problem.h"

enum { NX = 4, HORIZON = 50, CYCLES = 120 };
static const double pi = 3.14159265358979323846;

/* The cart over one cycle of 40 ms, with a pole that is heavier than the model's. */
static void move(double x[NX], double force) {
  const double h = 0.004, cart = 1.0, tip = 0.22, length = 0.5, g = 9.81;
  for (int n = 0; n < 10; ++n) {
    const double s = sin(x[1]), c = cos(x[1]), inertia = cart + tip * s * s, swing = tip * length * x[3] * x[3];
    x[2] += h * (force + s * (swing + tip * g * c)) / inertia;
    x[3] -= h * (force * c + swing * s * c + (cart + tip) * g * s) / (length * inertia);
    x[0] += h * x[2];
    x[1] += h * x[3];
  }
}

/* Ends the program with a sentence where a function has not done its work. */
#define CHECK(call)                                                  \
  do {                                                               \
    const chicane_error error = (call);                              \
    if (error != CHICANE_DONE) {                                     \
      fprintf(stderr, "%s: %s\n", #call, chicane_error_text(error)); \
      return 1;                                                      \
    }                                                                \
  } while (0)

int main(void) {
  static unsigned char memory[1 << 20]; /* all that there is: nothing is allocated */
  chicane_sizes sizes;
  chicane_solver* solver;
  chicane_report report;
  double x[NX] = {0, 0, 0, 0}, u[HORIZON], wanted[HORIZON + 1];

  CHECK(chicane_sizes_of(cart_pole_problem(), &sizes));
  CHECK(chicane_create(cart_pole_problem(), memory, sizeof memory, &solver));
  for (int k = 0; k <= HORIZON; ++k) wanted[k] = 0.2;
  CHECK(chicane_set(solver, CHICANE_PARAMETERS, wanted, HORIZON + 1));
  CHECK(chicane_solve(solver, x, &report));
  printf("%s: cost %.4f after %d iterations, %zu bytes\n", chicane_status_text(report.status), report.cost, report.iterations, sizes.bytes);
  if (!report.is_usable) return 1;

  for (int cycle = 0; cycle < CYCLES; ++cycle) {
    double expected[(HORIZON + 1) * NX];
    CHECK(chicane_prepare(solver));
    CHECK(chicane_feedback(solver, x, NULL)); /* x: just measured */
    CHECK(chicane_get(solver, CHICANE_INPUTS, u, HORIZON));
    move(x, u[0]);
    CHECK(chicane_shift(solver)); /* while the car moves: solve for where it will be */
    CHECK(chicane_get(solver, CHICANE_STATES, expected, (HORIZON + 1) * NX));
    CHECK(chicane_solve(solver, expected, &report));
    if (cycle % 20 == 19) printf("%4.1f s: cart at %6.3f m, pole at %7.2f deg, %d iterations\n", 0.04 * (cycle + 1), x[0], x[1] * 180 / pi, report.iterations);
  }
  chicane_destroy(solver);
  return fabs(x[1] - pi) < 0.02 && fabs(x[0] - 0.2) < 0.05 ? 0 : 1;
}
