/* Written by chicane (ocp.export_c). nx 4, nu 1, horizon 50, 1 parameters,
 * 0 constraints. Beside cart_pole_problem.cpp, which a C++ compiler compiles; used by chicane/solver.h. */
#ifndef CHICANE_PROBLEM_CART_POLE_PROBLEM_H
#define CHICANE_PROBLEM_CART_POLE_PROBLEM_H

#include "chicane/solver.h"

#ifdef __cplusplus
extern "C"
#endif
const chicane_problem* cart_pole_problem(void);

#endif
