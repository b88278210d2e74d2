/* SPDX-License-Identifier: MIT */
#ifndef CHICANE_SOLVER_H
#define CHICANE_SOLVER_H

#include <stddef.h>

/* Optimal control problems from C, and from everything that calls C: MATLAB, Julia, Rust, embedded targets.
 *
 * A problem is exported from Python by `ocp.export_c("cart_pole")` (docs/python_problems.md), or made of a C++ type by
 * chicane/solver/c_interface.hpp. Either is one C++ source, compiled once, and one function, here cart_pole():
 *
 *     chicane_sizes sizes;
 *     chicane_solver* solver;
 *     chicane_sizes_of(cart_pole(), &sizes);
 *     if (chicane_create(cart_pole(), malloc(sizes.bytes), sizes.bytes, &solver) != CHICANE_DONE) ...
 *     chicane_report report;
 *     const double x0[4] = {0, 0, 0, 0};
 *     chicane_solve(solver, x0, &report);
 *     chicane_get(solver, CHICANE_INPUTS, inputs, 50);
 *
 * Functions return a chicane_error; that a problem has no usable answer is no error but a status of the report. Nothing is
 * allocated, locked, thrown or printed, and no clock is read but for a budget and `seconds`. A solver belongs to one thread at
 * a time; solvers share nothing. Arrays are row by row. Functions that end with f take and give float; numbers in between are
 * double. */

#ifdef __cplusplus
extern "C" {
#endif

#define CHICANE_SOLVER_VERSION 1

typedef struct chicane_problem chicane_problem;
typedef struct chicane_solver chicane_solver;

typedef enum chicane_error {
  CHICANE_DONE = 0,
  CHICANE_NULL = 1,         /* a handle or an array is a null pointer */
  CHICANE_MEMORY = 2,       /* less memory than chicane_sizes.bytes */
  CHICANE_COUNT = 3,        /* an array of another length than chicane_count() */
  CHICANE_NOT_FINITE = 4,   /* a number that is not finite */
  CHICANE_RANGE = 5,        /* an option outside of its range */
  CHICANE_READ_ONLY = 6,    /* an array that only a solve writes */
  CHICANE_NOT_PREPARED = 7, /* feedback without a preparation, or preparation without a finite answer */
  CHICANE_VERSION = 8       /* a problem that was compiled with another version of this header */
} chicane_error;

typedef struct chicane_sizes {
  int version; /* CHICANE_SOLVER_VERSION of the problem */
  int nx, nu, horizon, parameters;
  int constraints, equalities, terminal_equalities, terminal_constraints;
  size_t bytes; /* of memory that chicane_create() takes, of any alignment */
} chicane_sizes;

/* What can be set and read, with its shape. */
typedef enum chicane_array {
  CHICANE_PARAMETERS = 0,             /* (horizon + 1, parameters); 0 at first */
  CHICANE_LOWER = 1,                  /* (horizon, nu): bounds of inputs; as exported at first. -INFINITY: none */
  CHICANE_UPPER = 2,                  /* (horizon, nu) */
  CHICANE_STATES = 3,                 /* (horizon + 1, nx): the guess, then the answer */
  CHICANE_INPUTS = 4,                 /* (horizon, nu): likewise; 0 at first */
  CHICANE_DYNAMICS_MULTIPLIERS = 5,   /* (horizon, nx): of x_{k+1}; these and those below are read-only */
  CHICANE_BOUND_MULTIPLIERS = 6,      /* (horizon, nu) */
  CHICANE_CONSTRAINT_MULTIPLIERS = 7, /* (horizon, constraints) */
  CHICANE_EQUALITY_MULTIPLIERS = 8,   /* (horizon, equalities) */
  CHICANE_TERMINAL_MULTIPLIERS = 9    /* equalities at the end, then constraints at the end */
} chicane_array;

typedef struct chicane_options {
  double tolerance;      /* of the conditions of optimality, (0, 1e-2]; 1e-6 */
  double budget_s;       /* a solve ends after that time with its best answer [s]; 0: never */
  int max_iterations;    /* [1, 10000]; 1000 */
  int second_order;      /* exact Hessians near the solution; 1 */
  int start_from_states; /* the guess's states count, not only its inputs; 0 */
} chicane_options;

typedef struct chicane_report {
  int status;     /* of chicane_status_text(); 0 is optimal */
  int is_usable;  /* whether the answer may be used */
  int iterations;
  double cost;
  double stationarity, defect, complementarity; /* how far from optimal */
  double violation;                             /* the largest of a soft constraint, in its own unit */
  int violated_stage, violated_constraint;      /* where that is; -1: nowhere */
  double miss;                                  /* the largest of what must hold, in its own unit */
  int miss_kind;                                /* 0 none, 1 equality, 2 terminal equality, 3 terminal constraint, 4 constraint */
  int miss_stage, miss_row;                     /* where that is; -1: nowhere */
  double seconds;
  double gap;                                   /* complementarity gap: what the barrier of constraints costs, at most if convex */
} chicane_report;

chicane_error chicane_sizes_of(const chicane_problem* problem, chicane_sizes* sizes);
const char* chicane_problem_name(const chicane_problem* problem);
/* Numbers in an array; 0 for what is no array. */
size_t chicane_count(const chicane_problem* problem, chicane_array array);

/* A solver in memory of the caller, which may be freed after chicane_destroy(). */
chicane_error chicane_create(const chicane_problem* problem, void* memory, size_t bytes, chicane_solver** solver);
void chicane_destroy(chicane_solver* solver);

void chicane_default_options(chicane_options* options);
/* From the next solve on. */
chicane_error chicane_set_options(chicane_solver* solver, const chicane_options* options);

chicane_error chicane_set(chicane_solver* solver, chicane_array array, const double* from, size_t count);
chicane_error chicane_setf(chicane_solver* solver, chicane_array array, const float* from, size_t count);
chicane_error chicane_get(const chicane_solver* solver, chicane_array array, double* to, size_t count);
chicane_error chicane_getf(const chicane_solver* solver, chicane_array array, float* to, size_t count);

/* Solves from x0, nx numbers, and from the inputs (and states) that are there: those set, or of the solve before. */
chicane_error chicane_solve(chicane_solver* solver, const double* x0, chicane_report* report);
chicane_error chicane_solvef(chicane_solver* solver, const float* x0, chicane_report* report);

/* Moves states and inputs one stage ahead, the last ones repeated: the guess for the next control cycle. */
chicane_error chicane_shift(chicane_solver* solver);
/* After a solve: linearises and factorises at its answer. Then chicane_feedback() gives inputs and states from a measured x0 in a
 * fraction of the time, again and again: of first order in the distance from the prepared x0. Its answer is in CHICANE_STATES and
 * CHICANE_INPUTS. is_solved, which may be null: whether its quadratic program is, or inputs were cut to their bounds. */
chicane_error chicane_prepare(chicane_solver* solver);
chicane_error chicane_feedback(chicane_solver* solver, const double* x0, int* is_solved);
chicane_error chicane_feedbackf(chicane_solver* solver, const float* x0, int* is_solved);

/* Sentences; never null. */
const char* chicane_error_text(chicane_error error);
const char* chicane_status_text(int status);

#ifdef __cplusplus
}
#endif

#endif
