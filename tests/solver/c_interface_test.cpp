// SPDX-License-Identifier: MIT
#include "chicane/solver/c_interface.hpp"

#include "chicane/solver/iteration_log.hpp"
#include "support/alloc_guard.hpp"
#include "support/chicane_test.hpp"

namespace chicane::solver {
namespace {

/// A pendulum that is to hang still, pulled to an angle; its speed is bounded softly.
struct Pendulum {
  static constexpr int kNx = 2, kNu = 1, kNr = 3, kNe = 2, kNc = 1;
  static constexpr const char* kName = "pendulum";
  static constexpr int kHorizon = 20, kParameters = 1;
  static constexpr double kCostOffset = 0.5;
  std::array<StageData<kHorizon + 1>, 1> p{};
  std::array<std::array<double, 1>, kHorizon> lower{}, upper{};

  Pendulum() {
    lower.fill({-1.0});
    upper.fill({1.0});
  }
  template <class K, class X, class U>
  auto dynamics(K k, const X& x, const U& u) const {
    const auto& [angle, speed] = x;
    const auto& [torque] = u;
    return std::make_tuple(angle + 0.1 * speed, speed + 0.1 * (torque - p[0].at(k) * sin(angle)));
  }
  template <class K, class X, class U>
  auto residual(K, const X& x, const U& u) const {
    const auto& [angle, speed] = x;
    const auto& [torque] = u;
    return std::make_tuple(1.4 * angle, 1.4 * speed, 0.4 * torque);
  }
  template <class X>
  auto terminal_residual(const X& x) const {
    const auto& [angle, speed] = x;
    return std::make_tuple(3.0 * angle, 3.0 * speed);
  }
  template <class K, class X, class U>
  auto constraint(K, const X& x, const U&) const {
    const auto& [angle, speed] = x;
    return std::make_tuple(-speed - 0.6);
  }
  SoftPenalty soft_penalty(int) const { return {5.0, 5.0}; }
  std::array<double, 1> input_lower(int k) const { return lower[static_cast<std::size_t>(k)]; }
  std::array<double, 1> input_upper(int k) const { return upper[static_cast<std::size_t>(k)]; }
};

const chicane_problem* pendulum() { return c_problem<Pendulum>(); }

class CInterface : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(chicane_sizes_of(pendulum(), &sizes_), CHICANE_DONE);
    memory_.resize(sizes_.bytes + 3);
    ASSERT_EQ(chicane_create(pendulum(), memory_.data() + 3, sizes_.bytes, &solver_), CHICANE_DONE);
    const std::vector<double> gravity(21, 1.0);
    ASSERT_EQ(chicane_set(solver_, CHICANE_PARAMETERS, gravity.data(), gravity.size()), CHICANE_DONE);
  }
  void TearDown() override { chicane_destroy(solver_); }
  std::vector<double> get(chicane_array array) {
    std::vector<double> numbers(chicane_count(pendulum(), array), 99.0);
    EXPECT_EQ(chicane_get(solver_, array, numbers.data(), numbers.size()), CHICANE_DONE);
    return numbers;
  }

  chicane_sizes sizes_{};
  std::vector<unsigned char> memory_;
  chicane_solver* solver_ = nullptr;
  chicane_report report_{};
  const double x0_[2] = {1.0, 0.3};
};

TEST_F(CInterface, GivesTheAnswerOfTheSolverBitByBit) {
  ASSERT_EQ(chicane_solve(solver_, x0_, &report_), CHICANE_DONE);
  Pendulum problem;
  problem.p[0].values.fill(1.0);
  const auto solver = std::make_unique<OcpSolver<Pendulum, 20>>();
  Trajectory<2, 1, 20> t{.horizon = 20};
  const SolveReport report = solver->solve(problem, {1.0, 0.3}, t);
  EXPECT_EQ(report_.status, static_cast<int>(report.status));
  EXPECT_EQ(report_.is_usable, 1);
  EXPECT_EQ(report_.iterations, report.iterations);
  EXPECT_EQ(report_.cost, report.cost + 0.5);
  EXPECT_GT(report_.seconds, 0.0);
  const auto states = get(CHICANE_STATES), inputs = get(CHICANE_INPUTS);
  const auto multipliers = get(CHICANE_CONSTRAINT_MULTIPLIERS), adjoint = get(CHICANE_DYNAMICS_MULTIPLIERS);
  for (std::size_t k = 0; k < 20; ++k) {
    const int stage = static_cast<int>(k);
    EXPECT_EQ(inputs[k], t.u[k][0]);
    EXPECT_EQ(states[2 * k + 2], t.x[k + 1][0]);
    EXPECT_EQ(multipliers[k], solver->constraint_multiplier(stage, 0));
    EXPECT_EQ(adjoint[2 * k + 1], solver->adjoint(stage, 1));
  }
  std::vector<float> rounded(20);
  ASSERT_EQ(chicane_getf(solver_, CHICANE_INPUTS, rounded.data(), 20), CHICANE_DONE);
  EXPECT_EQ(rounded[3], static_cast<float>(inputs[3]));
}

TEST_F(CInterface, TakesBoundsGuessesAndFloats) {
  const std::vector<float> upper(20, 0.25F);
  ASSERT_EQ(chicane_setf(solver_, CHICANE_UPPER, upper.data(), 20), CHICANE_DONE);
  const float x0[2] = {-1.0F, -0.5F};
  ASSERT_EQ(chicane_solvef(solver_, x0, &report_), CHICANE_DONE);
  EXPECT_EQ(report_.is_usable, 1);
  EXPECT_EQ(get(CHICANE_INPUTS)[0], 0.25);
  const double cost = report_.cost;
  chicane_options options;
  chicane_default_options(&options);
  options.max_iterations = 1;
  options.start_from_states = 1;
  ASSERT_EQ(chicane_set_options(solver_, &options), CHICANE_DONE);
  ASSERT_EQ(chicane_solvef(solver_, x0, &report_), CHICANE_DONE);  // from its own answer
  EXPECT_EQ(report_.is_usable, 1);
  EXPECT_NEAR(report_.cost, cost, 1e-4);
  std::vector<double> guess(20, 0.0);
  ASSERT_EQ(chicane_set(solver_, CHICANE_INPUTS, guess.data(), 20), CHICANE_DONE);
  EXPECT_EQ(get(CHICANE_INPUTS), guess);
  chicane_default_options(&options);
  guess[3] = std::numeric_limits<double>::quiet_NaN();
  ASSERT_EQ(chicane_set_options(solver_, &options), CHICANE_DONE);
  ASSERT_EQ(chicane_set(solver_, CHICANE_INPUTS, guess.data(), 20), CHICANE_DONE);
  ASSERT_EQ(chicane_solvef(solver_, x0, &report_), CHICANE_DONE);
  EXPECT_NEAR(report_.cost, cost, 1e-6);
  const auto before = get(CHICANE_STATES);
  ASSERT_EQ(chicane_shift(solver_), CHICANE_DONE);
  const auto after = get(CHICANE_STATES);
  EXPECT_EQ(after[0], before[2]);
  EXPECT_EQ(after[40], before[40]);
  EXPECT_EQ(after[38], before[40]);
}

TEST_F(CInterface, AnswersAMeasuredStateFromAPreparation) {
  EXPECT_EQ(chicane_feedback(solver_, x0_, nullptr), CHICANE_NOT_PREPARED);
  EXPECT_EQ(chicane_prepare(solver_), CHICANE_NOT_PREPARED);
  ASSERT_EQ(chicane_solve(solver_, x0_, &report_), CHICANE_DONE);
  const auto solved = get(CHICANE_INPUTS);
  ASSERT_EQ(chicane_prepare(solver_), CHICANE_DONE);
  int is_solved = 0;
  ASSERT_EQ(chicane_feedback(solver_, x0_, &is_solved), CHICANE_DONE);
  EXPECT_EQ(is_solved, 1);
  auto answer = get(CHICANE_INPUTS);
  for (std::size_t k = 0; k < 20; ++k) EXPECT_NEAR(answer[k], solved[k], 1e-6);

  // Of first order: half the distance, a quarter of the error.
  std::array<double, 2> errors{};
  for (std::size_t n = 0; n < 2; ++n) {
    const double x0[2] = {1.0 + 1e-2 / static_cast<double>(n + 1), 0.3};
    ASSERT_EQ(chicane_feedback(solver_, x0, nullptr), CHICANE_DONE);
    EXPECT_NEAR(get(CHICANE_STATES)[0], x0[0], 1e-15);
    answer = get(CHICANE_INPUTS);
    Pendulum problem;
    problem.p[0].values.fill(1.0);
    Trajectory<2, 1, 20> t{.horizon = 20};
    std::make_unique<OcpSolver<Pendulum, 20>>()->solve(problem, {x0[0], x0[1]}, t);
    for (std::size_t k = 0; k < 20; ++k) errors[n] = std::max(errors[n], std::fabs(answer[k] - t.u[k][0]));
  }
  EXPECT_LT(errors[0], 0.02);
  EXPECT_LT(errors[1], 0.5 * errors[0]);

  const double far[2] = {3.0, 0.3};
  ASSERT_EQ(chicane_feedback(solver_, far, nullptr), CHICANE_DONE);
  for (const double input : get(CHICANE_INPUTS)) EXPECT_LE(std::fabs(input), 1.0);
}

TEST_F(CInterface, AllocatesNothing) {
  std::vector<double> inputs(20);
  const test::AllocationGuard guard;
  chicane_solver* solver = nullptr;
  ASSERT_EQ(chicane_create(pendulum(), memory_.data(), memory_.size(), &solver), CHICANE_DONE);
  ASSERT_EQ(chicane_solve(solver, x0_, &report_), CHICANE_DONE);
  ASSERT_EQ(chicane_prepare(solver), CHICANE_DONE);
  ASSERT_EQ(chicane_feedback(solver, x0_, nullptr), CHICANE_DONE);
  ASSERT_EQ(chicane_get(solver, CHICANE_INPUTS, inputs.data(), 20), CHICANE_DONE);
  chicane_destroy(solver);
  EXPECT_EQ(guard.count(), 0);
  solver_ = nullptr;  // its memory has been used again
}

TEST_F(CInterface, RefusesWhatItCannotDoAndSaysWhy) {
  EXPECT_EQ(std::string(chicane_problem_name(pendulum())), "pendulum");
  chicane_solver* none = nullptr;
  double number = 0.0;
  EXPECT_EQ(chicane_create(nullptr, memory_.data(), memory_.size(), &none), CHICANE_NULL);
  EXPECT_EQ(chicane_create(pendulum(), memory_.data(), sizes_.bytes - 1, &none), CHICANE_MEMORY);
  EXPECT_EQ(chicane_solve(nullptr, x0_, &report_), CHICANE_NULL);
  EXPECT_EQ(chicane_solve(solver_, x0_, nullptr), CHICANE_NULL);
  EXPECT_EQ(chicane_get(solver_, CHICANE_INPUTS, &number, 1), CHICANE_COUNT);
  const double bad[2] = {1.0, std::numeric_limits<double>::quiet_NaN()};
  EXPECT_EQ(chicane_solve(solver_, bad, &report_), CHICANE_NOT_FINITE);
  std::vector<double> numbers(21, std::numeric_limits<double>::infinity());
  EXPECT_EQ(chicane_set(solver_, CHICANE_PARAMETERS, numbers.data(), 21), CHICANE_NOT_FINITE);
  EXPECT_EQ(chicane_set(solver_, CHICANE_UPPER, numbers.data(), 20), CHICANE_DONE);
  EXPECT_EQ(chicane_set(solver_, CHICANE_BOUND_MULTIPLIERS, numbers.data(), 20), CHICANE_READ_ONLY);
  chicane_options options;
  chicane_default_options(&options);
  EXPECT_EQ(chicane_set_options(solver_, &options), CHICANE_DONE);
  options.tolerance = 0.0;
  EXPECT_EQ(chicane_set_options(solver_, &options), CHICANE_RANGE);
  chicane_problem other = *pendulum();
  other.sizes.version = CHICANE_SOLVER_VERSION + 1;
  EXPECT_EQ(chicane_create(&other, memory_.data(), memory_.size(), &none), CHICANE_VERSION);
  for (int error = CHICANE_DONE; error <= CHICANE_VERSION; ++error)
    EXPECT_NE(std::string(chicane_error_text(static_cast<chicane_error>(error))), "unknown error");
  EXPECT_EQ(std::string(chicane_status_text(-2)), "the constraints cannot all hold");
  EXPECT_EQ(std::string(chicane_status_text(77)), "unknown status");
}

TEST(IterationLog, HasEachTurnWithItsStepAndCountsWhatDoesNotFit) {
  Pendulum problem;
  const auto solver = std::make_unique<OcpSolver<Pendulum, 20>>();
  Trajectory<2, 1, 20> t{.horizon = 20};
  std::array<Iteration, 50> memory;
  IterationLog log(memory);
  solver->record_iterations(&log);
  const SolveReport report = solver->solve(problem, {1.0, 0.3}, t);
  ASSERT_EQ(log.count(), static_cast<std::size_t>(report.iterations) + 1);
  const auto iterations = log.iterations();
  EXPECT_EQ(iterations.back().cost, report.cost);
  EXPECT_EQ(iterations.back().stationarity, report.stationarity);
  EXPECT_EQ(iterations.back().step, 0.0);
  EXPECT_GT(iterations.front().barrier, iterations.back().barrier);
  for (const Iteration& iteration : iterations.first(iterations.size() - 1)) EXPECT_GT(iteration.step, 0.0);

  IterationLog small(std::span<Iteration>(memory).first(2));
  solver->record_iterations(&small);
  t = {.horizon = 20};
  solver->solve(problem, {1.0, 0.3}, t);
  EXPECT_EQ(small.count(), log.count());
  EXPECT_EQ(small.iterations().size(), 2U);
  EXPECT_EQ(small.iterations()[1].cost, iterations[1].cost);
}

}  // namespace
}  // namespace chicane::solver
