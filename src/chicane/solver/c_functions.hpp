// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <memory>

#include "chicane/solver.h"
#include "chicane/solver/solution.hpp"

// Functions of chicane/solver.h, the solver's interface for C: they check their arguments and call the
// functions of a problem's solver. Every source with a problem for C includes this file.

/// A problem behind its handle: its sizes, and the functions of its solver (c_interface.hpp).
struct chicane_problem {
  chicane_sizes sizes;
  const char* name;
  std::size_t alignment;
  chicane_solver* (*create)(const chicane_problem*, void*);
  void (*destroy)(chicane_solver*);
  void (*set_options)(chicane_solver*, const chicane_options*);
  void (*set)(chicane_solver*, chicane_array, const double*);
  void (*setf)(chicane_solver*, chicane_array, const float*);
  void (*get)(const chicane_solver*, chicane_array, double*);
  void (*getf)(const chicane_solver*, chicane_array, float*);
  void (*solve)(chicane_solver*, const double*, chicane_report*);
  void (*solvef)(chicane_solver*, const float*, chicane_report*);
  void (*shift)(chicane_solver*);
  bool (*prepare)(chicane_solver*);
  bool (*feedback)(chicane_solver*, const double*);
  bool (*feedbackf)(chicane_solver*, const float*);
};
/// A solver behind its handle.
struct chicane_solver {
  const chicane_problem* problem;
  int is_ready;         ///< whether the last solve has a finite answer
  int is_prepared = 0;  ///< whether chicane_prepare() has succeeded since
};

namespace chicane::solver::c {

/// Checks pointers and the length of an array.
template <class T>
chicane_error check(const chicane_solver* solver, chicane_array array, const T* numbers, std::size_t count) {
  if (solver == nullptr || numbers == nullptr) return CHICANE_NULL;
  return count == chicane_count(solver->problem, array) ? CHICANE_DONE : CHICANE_COUNT;
}
template <class T>
bool are_finite(const T* numbers, std::size_t count, bool may_be_infinite) {
  for (std::size_t n = 0; n < count; ++n) {
    if (std::isnan(numbers[n]) || (!may_be_infinite && std::isinf(numbers[n]))) return false;
  }
  return true;
}
/// Checks an array that is to be set.
template <class T>
chicane_error check_to_set(const chicane_solver* solver, chicane_array array, const T* from,
                           std::size_t count) {
  if (const chicane_error error = check(solver, array, from, count); error != CHICANE_DONE) return error;
  if (array > CHICANE_INPUTS) return CHICANE_READ_ONLY;
  const bool is_guess =
      array == CHICANE_STATES || array == CHICANE_INPUTS;  // arrays in which not-a-number is replaced
  return is_guess || are_finite(from, count, array != CHICANE_PARAMETERS) ? CHICANE_DONE : CHICANE_NOT_FINITE;
}
/// Checks pointers and the first state.
template <class T>
chicane_error check_state(const chicane_solver* solver, const T* x0) {
  if (solver == nullptr || x0 == nullptr) return CHICANE_NULL;
  return are_finite(x0, static_cast<std::size_t>(solver->problem->sizes.nx), false) ? CHICANE_DONE
                                                                                    : CHICANE_NOT_FINITE;
}
/// Checks the first state and that the solver is prepared.
template <class T>
chicane_error check_feedback(const chicane_solver* solver, const T* x0) {
  const chicane_error error = check_state(solver, x0);
  return error != CHICANE_DONE || solver->is_prepared != 0 ? error : CHICANE_NOT_PREPARED;
}

}  // namespace chicane::solver::c

#define CHICANE_C extern "C" [[gnu::used, gnu::visibility("default")]] inline

CHICANE_C chicane_error chicane_sizes_of(const chicane_problem* problem, chicane_sizes* sizes) {
  if (problem == nullptr || sizes == nullptr) return CHICANE_NULL;
  *sizes = problem->sizes;
  return problem->sizes.version == CHICANE_SOLVER_VERSION ? CHICANE_DONE : CHICANE_VERSION;
}
CHICANE_C const char* chicane_problem_name(const chicane_problem* problem) {
  return problem != nullptr ? problem->name : "";
}
CHICANE_C size_t chicane_count(const chicane_problem* problem, chicane_array array) {
  if (problem == nullptr) return 0;
  const chicane_sizes& s = problem->sizes;
  const int counts[] = {(s.horizon + 1) * s.parameters,
                        s.horizon * s.nu,
                        s.horizon * s.nu,
                        (s.horizon + 1) * s.nx,
                        s.horizon * s.nu,
                        s.horizon * s.nx,
                        s.horizon * s.nu,
                        s.horizon * s.constraints,
                        s.horizon * s.equalities,
                        s.terminal_equalities + s.terminal_constraints};
  const auto n = static_cast<std::size_t>(array);
  return n < sizeof(counts) / sizeof(*counts) ? static_cast<std::size_t>(counts[n]) : 0;
}

CHICANE_C chicane_error chicane_create(const chicane_problem* problem, void* memory, size_t bytes,
                                       chicane_solver** solver) {
  if (problem == nullptr || memory == nullptr || solver == nullptr) return CHICANE_NULL;
  *solver = nullptr;
  if (problem->sizes.version != CHICANE_SOLVER_VERSION) return CHICANE_VERSION;
  if (bytes < problem->sizes.bytes) return CHICANE_MEMORY;
  void* aligned = memory;
  std::size_t space = bytes;
  if (std::align(problem->alignment, problem->sizes.bytes - problem->alignment, aligned, space) == nullptr)
    return CHICANE_MEMORY;
  *solver = problem->create(problem, aligned);
  return CHICANE_DONE;
}
CHICANE_C void chicane_destroy(chicane_solver* solver) {
  if (solver != nullptr) solver->problem->destroy(solver);
}

CHICANE_C void chicane_default_options(chicane_options* options) {
  if (options != nullptr) *options = {1e-6, 0.0, 1000, 1, 0};
}
CHICANE_C chicane_error chicane_set_options(chicane_solver* solver, const chicane_options* options) {
  if (solver == nullptr || options == nullptr) return CHICANE_NULL;
  const bool is_good = options->tolerance > 0.0 && options->tolerance <= 1e-2 && options->budget_s >= 0.0 &&
                       options->budget_s <= 1e6 && options->max_iterations >= 1 &&
                       options->max_iterations <= 10000;
  if (!is_good) return CHICANE_RANGE;
  solver->problem->set_options(solver, options);
  return CHICANE_DONE;
}

CHICANE_C chicane_error chicane_set(chicane_solver* solver, chicane_array array, const double* from,
                                    size_t count) {
  const chicane_error error = chicane::solver::c::check_to_set(solver, array, from, count);
  if (error == CHICANE_DONE) solver->problem->set(solver, array, from);
  return error;
}
CHICANE_C chicane_error chicane_setf(chicane_solver* solver, chicane_array array, const float* from,
                                     size_t count) {
  const chicane_error error = chicane::solver::c::check_to_set(solver, array, from, count);
  if (error == CHICANE_DONE) solver->problem->setf(solver, array, from);
  return error;
}
CHICANE_C chicane_error chicane_get(const chicane_solver* solver, chicane_array array, double* to,
                                    size_t count) {
  const chicane_error error = chicane::solver::c::check(solver, array, to, count);
  if (error == CHICANE_DONE) solver->problem->get(solver, array, to);
  return error;
}
CHICANE_C chicane_error chicane_getf(const chicane_solver* solver, chicane_array array, float* to,
                                     size_t count) {
  const chicane_error error = chicane::solver::c::check(solver, array, to, count);
  if (error == CHICANE_DONE) solver->problem->getf(solver, array, to);
  return error;
}

CHICANE_C chicane_error chicane_solve(chicane_solver* solver, const double* x0, chicane_report* report) {
  if (report == nullptr) return CHICANE_NULL;
  const chicane_error error = chicane::solver::c::check_state(solver, x0);
  if (error == CHICANE_DONE) solver->problem->solve(solver, x0, report);
  return error;
}
CHICANE_C chicane_error chicane_solvef(chicane_solver* solver, const float* x0, chicane_report* report) {
  if (report == nullptr) return CHICANE_NULL;
  const chicane_error error = chicane::solver::c::check_state(solver, x0);
  if (error == CHICANE_DONE) solver->problem->solvef(solver, x0, report);
  return error;
}

CHICANE_C chicane_error chicane_shift(chicane_solver* solver) {
  if (solver == nullptr) return CHICANE_NULL;
  solver->problem->shift(solver);
  return CHICANE_DONE;
}
CHICANE_C chicane_error chicane_prepare(chicane_solver* solver) {
  if (solver == nullptr) return CHICANE_NULL;
  solver->is_prepared = solver->is_ready != 0 && solver->problem->prepare(solver) ? 1 : 0;
  return solver->is_prepared != 0 ? CHICANE_DONE : CHICANE_NOT_PREPARED;
}
CHICANE_C chicane_error chicane_feedback(chicane_solver* solver, const double* x0, int* is_solved) {
  const chicane_error error = chicane::solver::c::check_feedback(solver, x0);
  if (error != CHICANE_DONE) return error;
  const bool solved = solver->problem->feedback(solver, x0);
  if (is_solved != nullptr) *is_solved = solved ? 1 : 0;
  return error;
}
CHICANE_C chicane_error chicane_feedbackf(chicane_solver* solver, const float* x0, int* is_solved) {
  const chicane_error error = chicane::solver::c::check_feedback(solver, x0);
  if (error != CHICANE_DONE) return error;
  const bool solved = solver->problem->feedbackf(solver, x0);
  if (is_solved != nullptr) *is_solved = solved ? 1 : 0;
  return error;
}

CHICANE_C const char* chicane_error_text(chicane_error error) {
  static constexpr const char* kTexts[] = {
      "done",
      "got a null pointer, expected a handle or an array",
      "got less memory than chicane_sizes.bytes",
      "got an array of another length, expected chicane_count() numbers",
      "got a number that is not finite",
      "got an option outside of its range",
      "got an array to write that only a solve writes",
      "got no preparation, expected chicane_solve() with a finite answer, then chicane_prepare()",
      "got a problem compiled with another version of chicane/solver.h"};
  static_assert(sizeof kTexts / sizeof *kTexts == CHICANE_VERSION + 1);
  return error >= CHICANE_DONE && error <= CHICANE_VERSION ? kTexts[error] : "unknown error";
}
CHICANE_C const char* chicane_status_text(int status) {
  for (const auto& word : chicane::solver::kSolveStatusWords) {
    if (static_cast<int>(word.value) == status) return word.sentence.data();
  }
  return "unknown status";
}

#undef CHICANE_C
