// SPDX-License-Identifier: MIT
#include "chicane/controller/cubic_problem.hpp"

#include <Eigen/QR>

#include "chicane/base/instruction_set.hpp"
#include "chicane/base/math.hpp"
#include "chicane/base/random.hpp"
#include "chicane/controller/cubic_solver.hpp"
#include "chicane/solver/ocp_solver.hpp"
#include "support/chicane_test.hpp"

namespace chicane::controller {
namespace {

using State = CubicProblem::State;
using Input = CubicProblem::Input;

const State kState{2.0, 0.3, 0.1, 12.0, -0.04, 0.2, -0.5};

CubicProblem sample_problem(LatencyHandling handling = LatencyHandling::kNone) {
  CubicMpcOptions options;
  options.latency_handling = handling;
  options.weight_speed_steer = 0.3;
  CubicProblem problem{options, model::VehicleParams{}};
  problem.line = {{0.4, -0.05, 0.004, -3e-5}};
  return problem;
}

double half_square(const auto& residual) {
  double sum = 0.0;
  for (const double r : solver::to_array<double>(residual)) sum += 0.5 * r * r;
  return sum;
}

TEST(CubicProblem, PaysTheDescribedSum) {
  CubicProblem p = sample_problem();
  p.first_lateral_error = 0.7;
  const Input u{0.05, 0.8};
  const auto square = [](double v) { return v * v; };
  const double errors = 200.0 * square(-0.04) + 0.1 * square(12.0 - 17.9);
  const double stage = 200.0 * square(p.next_lateral_error(kState)) + errors + square(0.05) + square(0.8) +
                       0.3 * square(12.0 * 0.05);
  EXPECT_NEAR(half_square(p.residual(1, kState, u)), stage + 10.0 * square(0.05 - 0.2) + square(0.8 + 0.5),
              1e-10);
  EXPECT_NEAR(half_square(p.residual(0, kState, u)), stage, 1e-10);  // no change to pay for in the first
  EXPECT_NEAR(half_square(p.terminal_residual(kState)), 200.0 * square(0.7) + errors, 1e-10);
}

/// Every handling that changes the model, both signs, metres and miles, the errors of `measured-latency` and
/// of the others.
std::vector<CubicProblem> all_variants(Random& random) {
  std::vector<CubicProblem> problems;
  for (const unsigned variant : {0U,  1U,  2U,  3U,  4U,  5U,  6U,  7U,  8U,  9U,  10U, 11U,
                                 12U, 13U, 14U, 15U, 24U, 25U, 26U, 27U, 28U, 29U, 30U, 31U}) {
    CubicMpcOptions options;
    options.latency_handling = (variant & 4U) != 0 ? LatencyHandling::kInsideModel : LatencyHandling::kNone;
    options.steering_right_positive = (variant & 2U) != 0;
    options.speed_in_mph = (variant & 1U) != 0;
    options.lateral_error_to_left = options.heading_error_integrated = (variant & 8U) != 0;
    options.lateral_error_integrated = (variant & 16U) != 0;
    options.speed_reference = random.uniform(5.0, 25.0);
    options.weight_speed_steer = random.uniform(0.0, 1.0);
    options.weight_steer_change = random.uniform(0.0, 100.0);
    options.weight_throttle = random.uniform(0.1, 50.0);
    CubicProblem problem{options, model::VehicleParams{}};
    problem.follow({{random.uniform(-1.5, 1.5), random.uniform(-0.3, 0.3), random.uniform(-4e-3, 4e-3),
                     random.uniform(-3e-5, 3e-5)}});
    problems.push_back(problem);
  }
  return problems;
}

/// CubicProblem as it is written down, cte among the states and derivatives dense: what the structured form
/// must agree with. State x, y, ψ, v, cte, eψ, δ⁻, a⁻.
struct DenseCubicProblem {
  static constexpr int kNx = 8;
  static constexpr int kNu = 2;
  static constexpr int kNr = 8;
  static constexpr int kNe = 3;
  static constexpr int kNc = 0;
  static constexpr bool kRealTime = true;
  enum StateIndex : std::size_t { kX, kY, kPsi, kV, kCte, kEpsi, kLastSteer, kLastThrottle };
  enum InputIndex : std::size_t { kSteer, kThrottle };
  template <class T>
  using States = std::array<T, kNx>;
  template <class T>
  using Inputs = std::array<T, kNu>;

  explicit DenseCubicProblem(const CubicProblem& structured) noexcept
      : dt{structured.dt},
        turn_per_metre{structured.turn_per_metre},
        steer_limit{structured.steer_limit},
        speed_reference{structured.speed_reference},
        error_sign{structured.error_sign},
        is_integrated{structured.heading_reach == 0.0},
        is_lateral_recursive{structured.is_lateral_recursive},
        acts_late{structured.acts_late},
        root{structured.root},
        line{structured.line} {}

  [[nodiscard]] static States<double> with_lateral_error(const CubicProblem::State& x, double cte) {
    return {x[0], x[1], x[2], x[3], cte, x[4], x[5], x[6]};
  }

  /// Equations 1 to 6: forward Euler, with the described recursions of both errors.
  template <class T>
  [[nodiscard]] States<T> dynamics(int, const States<T>& x, const Inputs<T>& u) const {
    const T steer = acts_late ? x[kLastSteer] : u[kSteer];
    const T throttle = acts_late ? x[kLastThrottle] : u[kThrottle];
    const T turn = x[kV] * steer * (turn_per_metre * dt);
    return {
        x[kX] + x[kV] * cos(x[kPsi]) * dt,
        x[kY] + x[kV] * sin(x[kPsi]) * dt,
        x[kPsi] + turn,
        x[kV] + throttle * dt,
        (is_lateral_recursive ? x[kCte] : line.at(x[kX]) - x[kY]) + x[kV] * sin(x[kEpsi]) * (error_sign * dt),
        (is_integrated ? x[kEpsi] : x[kPsi] - atan(line.slope(x[kX]))) + turn,
        u[kSteer],
        u[kThrottle]};
  }

  /// Equation 7, one stage. The first stage has no change to pay for, as described.
  template <class T>
  [[nodiscard]] std::array<T, kNr> residual(int k, const States<T>& x, const Inputs<T>& u) const {
    const double is_change = k > 0 ? 1.0 : 0.0;
    return {x[kCte] * root[0],
            x[kEpsi] * root[1],
            (x[kV] - speed_reference) * root[2],
            u[kSteer] * root[3],
            u[kThrottle] * root[4],
            (u[kSteer] - x[kLastSteer]) * (is_change * root[5]),
            (u[kThrottle] - x[kLastThrottle]) * (is_change * root[6]),
            x[kV] * u[kSteer] * root[7]};
  }

  template <class T>
  [[nodiscard]] std::array<T, kNe> terminal_residual(const States<T>& x) const {
    return {x[kCte] * root[0], x[kEpsi] * root[1], (x[kV] - speed_reference) * root[2]};
  }

  [[nodiscard]] Inputs<double> input_lower(int) const { return {-steer_limit, -1.0}; }
  [[nodiscard]] Inputs<double> input_upper(int) const { return {steer_limit, 1.0}; }

  double dt;
  double turn_per_metre;
  double steer_limit;
  double speed_reference;
  double error_sign;
  bool is_integrated;         ///< the heading error, from step to step
  bool is_lateral_recursive;  ///< the lateral error, from step to step
  bool acts_late;
  std::array<double, kNr> root;
  Cubic line;
};

solver::SolveReport solve(const CubicProblem& problem, const State& start, CubicTrajectory& answer) {
  return with_instructions(chosen_instruction_set(), [&](auto instructions) {
    return make_cubic_solver<decltype(instructions)>({.max_iterations = 100})
        ->solve(problem, start, answer, Deadline::never());
  });
}

TEST(CubicProblem, HasTheOptimaOfTheDenseForm) {
  using Dense = solver::OcpSolver<DenseCubicProblem, 200>;
  const auto dense_solver = std::make_unique<Dense>(solver::SolverOptions{.max_iterations = 100});
  const auto dense = std::make_unique<Dense::Trajectory>();
  const auto answer = std::make_unique<CubicTrajectory>();
  Random random{11};
  int compared = 0;
  for (int turn = 0; turn < 8; ++turn) {
    for (const CubicProblem& problem : all_variants(random)) {
      const double speed = random.uniform(5.0, 25.0) * problem.speed_unit;
      const State start{0.0, 0.0, 0.0, speed, -std::atan(problem.line.slope(0.0)), random.uniform(-0.1, 0.1),
                        0.3};
      answer->horizon = dense->horizon = 9;
      answer->u.fill({});
      dense->u.fill({});
      const solver::SolveReport report = solve(problem, start, *answer);
      const DenseCubicProblem described{problem};
      const solver::SolveReport expected = dense_solver->solve(
          described, DenseCubicProblem::with_lateral_error(start, problem.first_lateral_error), *dense,
          Deadline::never());
      ASSERT_EQ(report.status, solver::SolveStatus::kOptimal);
      ASSERT_EQ(expected.status, solver::SolveStatus::kOptimal);
      if (std::fabs(report.cost - expected.cost) > 1e-6 * expected.cost) continue;  // another local optimum
      ++compared;
      for (std::size_t k = 0; k < 9; ++k) {
        ASSERT_NEAR(answer->u[k][0], dense->u[k][0], 2e-5) << k;  // both solvers' tolerance
        ASSERT_NEAR(answer->u[k][1], dense->u[k][1], 2e-4) << k;
      }
    }
  }
  EXPECT_GE(compared, 180) << "of 192";
}

std::vector<std::vector<double>> read_csv(const std::string& path) {
  std::vector<std::vector<double>> rows;
  std::ifstream file{path};
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::istringstream cells{line};
    std::string cell;
    rows.emplace_back();
    while (std::getline(cells, cell, ',')) rows.back().push_back(std::stod(cell));
  }
  return rows;
}

/// Ipopt's optima of the same formulation (tolerance 1e-10, tests/reference_nlp/README.md), every tenth
/// instance.
TEST(CubicProblem, HasTheOptimaThatIpoptFinds) {
  const std::string folder = std::string{CHICANE_SOURCE_DIR} + "/tests/reference_nlp/";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "optima are not compared with Ipopt's: no " << folder;
  const auto answer = std::make_unique<CubicTrajectory>();
  int compared = 0;
  int unequal = 0;
  int unsolved = 0;
  for (const auto& [set, n] :
       {std::pair{"30mps", 7}, {"30mps", 10}, {"30mps", 20}, {"30mps", 50}, {"16mps", 50}}) {
    const auto instances = read_csv(folder + "lap_" + set + ".csv");
    const auto golden = read_csv(folder + "golden_" + set + "_N" + std::to_string(n) + ".csv");
    for (std::size_t i = 0; i < golden.size(); i += 10) {
      const auto& g = golden[i];
      const auto& in = instances[static_cast<std::size_t>(g[0])];
      if (g[1] != 1.0) continue;
      CubicMpcOptions options;
      options.speed_reference = in[10];
      CubicProblem problem{options, model::VehicleParams{}};
      problem.line = {{in[6], in[7], in[8], in[9]}};
      answer->horizon = n - 1;
      answer->u.fill({});
      problem.first_lateral_error = in[4];
      const auto report = solve(problem, {in[0], in[1], in[2], in[3], in[5], 0.0, 0.0}, *answer);
      ++compared;
      if (report.status != solver::SolveStatus::kOptimal) {
        ++unsolved;
        continue;
      }
      // A non-convex problem may have a better minimum than the golden one; it must never be a worse one.
      EXPECT_LE(report.cost, g[2] * (1.0 + 1e-6)) << set << ' ' << n << ' ' << g[0];
      if (report.cost < g[2] * (1.0 - 1e-6)) ++unequal;
      if (std::fabs(report.cost - g[2]) <= 1e-9 * g[2]) {
        EXPECT_NEAR(answer->u[0][0], g[3], 1e-5);  // both solvers' tolerance, by the smallest weight
      }
    }
  }
  EXPECT_GT(compared, 100);
  EXPECT_LE(unequal, compared / 100);
  EXPECT_LE(unsolved, compared / 100)
      << "cold starts at 30 m/s are harder than any step of a running controller";
}

constexpr double kRounding = 1e-14;  // of a few operations on numbers of magnitude 10
const Cubic kLine{{0.5, 0.1, -0.02, 0.001}};
const std::array<double, 7> kDescribed{2.0, 0.3, 0.05, 12.0, -0.04, 0.0, 0.0};

DescribedModel<Cubic> model(double sign = 1.0) {
  return {.line = kLine, .dt = 0.1, .turn_per_length = sign * 0.1 / 2.67};
}

TEST(DescribedModel, MovesByForwardEuler) {
  const std::array input{0.2, -0.5};
  const auto [x, y, psi, v, epsi, steer, acceleration] = model().next(kDescribed, input, input);
  const double turn = 12.0 * 0.2 * 0.1 / 2.67;
  const double slope = 0.1 + 2.0 * (-0.02) * 2.0 + 3.0 * 0.001 * 4.0;
  EXPECT_NEAR(x, 2.0 + 1.2 * std::cos(0.05), kRounding);
  EXPECT_NEAR(y, 0.3 + 1.2 * std::sin(0.05), kRounding);
  EXPECT_NEAR(psi, 0.05 + turn, kRounding);
  EXPECT_NEAR(v, 12.0 - 0.05, kRounding);
  EXPECT_NEAR(epsi, 0.05 - std::atan(slope) + turn, kRounding);
  EXPECT_EQ(steer, 0.2);
  EXPECT_EQ(acceleration, -0.5);
}

TEST(DescribedModel, IsMovedByWhatActsAndKeepsWhatIsAsked) {
  const auto [x, y, psi, v, epsi, steer, acceleration] =
      model().next(kDescribed, std::array{0.0, 1.0}, std::array{0.2, -0.5});
  EXPECT_EQ(psi, 0.05);
  EXPECT_NEAR(v, 12.1, kRounding);
  EXPECT_EQ(steer, 0.2);
  EXPECT_EQ(acceleration, -0.5);
}

TEST(DescribedModel, TurnsTheOtherWayWithTheOtherSign) {
  const std::array input{0.2, 0.0};
  const double left = std::get<2>(model(1.0).next(kDescribed, input, input)) - 0.05;
  const double right = std::get<2>(model(-1.0).next(kDescribed, input, input)) - 0.05;
  EXPECT_GT(left, 0.0);
  EXPECT_NEAR(right, -left, kRounding);
}

constexpr double kLength = 2.67;

/// Heading along W's y at 20 m/s, wheel 0.1 rad to the left, half throttle.
model::Measurement moving() {
  model::Measurement now;
  now.x = 3.0;
  now.y = 4.0;
  now.psi = 0.5 * kPi;
  now.speed = 20.0;
  now.steer = 0.1;
  now.throttle = 0.5;
  now.delay = 0.14;
  return now;
}

TEST(RollForward, MovesWhatItsHandlingSays) {
  struct Row {
    LatencyHandling handling;
    double y, psi, speed, compensated;
  };
  for (const auto& [handling, y, psi, speed, compensated] :
       {Row{LatencyHandling::kNone, 4.0, 0.0, 20.0, 0.0},
        {LatencyHandling::kInsideModel, 4.0, 0.0, 20.0, 0.0},
        {LatencyHandling::kPositionOnly, 6.0, 0.0, 20.0, 0.1},
        {LatencyHandling::kRollForward, 6.0, 20.0 * 0.1 / kLength * 0.1, 20.05, 0.1}}) {
    SCOPED_TRACE(static_cast<int>(handling));
    RollForward roll{handling, 0.1, kLength};
    const Motion start = roll.predict(moving());
    EXPECT_NEAR(start.pose.x, 3.0, 1e-12);
    EXPECT_NEAR(start.pose.y, y, 1e-12);
    EXPECT_NEAR(start.pose.psi, 0.5 * kPi + psi, 1e-12);
    EXPECT_NEAR(start.speed, speed, 1e-12);
    EXPECT_EQ(roll.compensated(), compensated);
  }
}

TEST(RollForward, AveragesTheMeasuredLatencyWithTheValueBefore) {
  RollForward roll{LatencyHandling::kMeasured, 0.1, kLength};
  const Motion start = roll.predict(moving());
  const double latency = 0.5 * (0.1 + 0.14);
  EXPECT_DOUBLE_EQ(roll.compensated(), latency);
  const double curvature = std::tan(0.1) / kLength;
  EXPECT_NEAR(start.pose.y, 4.0 + 20.0 * latency, 1e-12);
  EXPECT_NEAR(start.pose.psi,
              0.5 * kPi + 20.0 * curvature * latency + 0.5 * 0.5 * curvature * latency * latency, 1e-12);
  EXPECT_NEAR(start.speed, 20.0 + 0.5 * latency, 1e-12);
  (void)roll.predict(moving());
  EXPECT_DOUBLE_EQ(roll.compensated(), 0.5 * (latency + 0.14));
  roll.reset();
  EXPECT_DOUBLE_EQ(roll.compensated(), 0.1);
}

TEST(RollForward, LeavesOutTheTermOfTheAccelerationWhenAskedTo) {
  RollForward with{LatencyHandling::kMeasured, 0.1, kLength};
  RollForward without{LatencyHandling::kMeasured, 0.1, kLength, 1.0, false};
  const double latency = 0.5 * (0.1 + 0.14);
  const double term = 0.5 * 0.5 * std::tan(0.1) / kLength * latency * latency;
  EXPECT_NEAR(with.predict(moving()).pose.psi - without.predict(moving()).pose.psi, term, 1e-14);
  EXPECT_GT(term, 1e-4);
}

TEST(RollForward, RejectsAnImpossibleLatency) {
  RollForward roll{LatencyHandling::kMeasured, 0.1, kLength};
  model::Measurement now = moving();
  for (const double delay :
       {std::numeric_limits<double>::quiet_NaN(), 1e9, -1e9, std::numeric_limits<double>::infinity()}) {
    now.delay = delay;
    (void)roll.predict(now);
    EXPECT_GE(roll.compensated(), 0.0);
    EXPECT_LE(roll.compensated(), 0.5);
  }
}

TEST(RollForward, MilesPerHourTakeTheCarAsMuchFarther) {
  model::Measurement now;
  now.speed = 10.0;
  now.psi = 0.3;
  now.steer = 0.05;
  RollForward literal(LatencyHandling::kPositionOnly, 0.1, 2.67, 2.25);
  RollForward longer(LatencyHandling::kPositionOnly, 0.225, 2.67);
  const Motion a = literal.predict(now);
  const Motion b = longer.predict(now);
  EXPECT_NEAR(a.pose.x, b.pose.x, 1e-12);
  EXPECT_NEAR(a.pose.y, b.pose.y, 1e-12);
  EXPECT_NEAR(a.speed, 10.0, 1e-12);  // told in m/s again
  RollForward inside(LatencyHandling::kInsideModel, 0.1, 2.67, 2.25);
  EXPECT_EQ(inside.predict(now).speed, 10.0);
}

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

model::Measurement with_waypoints(const std::vector<Vec2>& points) {
  model::Measurement now;
  now.waypoint_count = static_cast<int>(points.size());
  std::copy(points.begin(), points.end(), now.waypoints.begin());
  return now;
}

TEST(CarFrame, PutsWhatIsAheadOnXAndWhatIsLeftOnY) {
  const auto now = with_waypoints({{10.0, 25.0}, {0.0, 20.0}});
  const model::Pose car{10.0, 20.0, 0.5 * kPi};  // looking along W's y
  const LocalPoints local = to_car_frame(now, car);
  ASSERT_EQ(local.count, 2);
  EXPECT_NEAR(local.points[0].x(), 5.0, 1e-12);
  EXPECT_NEAR(local.points[0].y(), 0.0, 1e-12);
  EXPECT_NEAR(local.points[1].x(), 0.0, 1e-12);
  EXPECT_NEAR(local.points[1].y(), 10.0, 1e-12);
}

TEST(CarFrame, IsTheSameByRotationAndByRadiusAndAngle) {
  Random random{3};
  for (int turn = 0; turn < 200; ++turn) {
    std::vector<Vec2> points;
    for (int i = 0; i < 6; ++i)
      points.emplace_back(random.uniform(-200.0, 200.0), random.uniform(-200.0, 200.0));
    const model::Pose car{random.uniform(-200.0, 200.0), random.uniform(-200.0, 200.0),
                          random.uniform(-7.0, 7.0)};
    const LocalPoints a = to_car_frame(with_waypoints(points), car);
    const LocalPoints b = to_car_frame_polar(with_waypoints(points), car);
    ASSERT_EQ(a.count, b.count);
    // 1e-12: rounding of an arc tangent and a sine, times 600 m.
    for (std::size_t i = 0; i < 6; ++i) ASSERT_LT((a.points[i] - b.points[i]).norm(), 1e-12 * 600.0);
  }
}

TEST(CarFrame, SkipsPointsThatAreNotFiniteAndRejectsAnImpossibleCount) {
  auto now =
      with_waypoints({{1.0, 2.0}, {kNaN, 1.0}, {3.0, std::numeric_limits<double>::infinity()}, {4.0, 5.0}});
  EXPECT_EQ(to_car_frame(now, {}).count, 2);
  now.waypoint_count = 1'000'000;
  EXPECT_LE(to_car_frame(now, {}).count, model::Measurement::kMaxWaypoints);
  now.waypoint_count = -5;
  EXPECT_EQ(to_car_frame_polar(now, {}).count, 0);
}

TEST(FitCubic, EqualsEigensHouseholderSolutionOnRandomPoints) {
  Random random{17};
  for (int turn = 0; turn < 500; ++turn) {
    const int count = 4 + static_cast<int>(random.bits() % 20U);
    std::vector<Vec2> points;
    Eigen::MatrixXd a(count, 4);
    Eigen::VectorXd b(count);
    for (int i = 0; i < count; ++i) {
      const double x = 5.0 * i + random.uniform(-2.0, 2.0) - 10.0;
      points.emplace_back(x, random.uniform(-20.0, 20.0));
      a.row(i) << 1.0, x, x * x, x * x * x;
      b(i) = points.back().y();
    }
    const Eigen::VectorXd expected = a.householderQr().solve(b);
    Cubic fit;
    ASSERT_TRUE(fit_cubic(points, fit));
    // 1e-7 relative: condition of the unscaled powers (about 1e6) times rounding, with room.
    for (int i = 0; i < 4; ++i)
      ASSERT_NEAR(fit.c[static_cast<std::size_t>(i)], expected(i), 1e-7 * (1.0 + std::fabs(expected(i))));
  }
}

TEST(FitCubic, LowersTheDegreeForFewerPoints) {
  Cubic fit;
  ASSERT_TRUE(fit_cubic(std::vector<Vec2>{{0.0, 1.0}, {10.0, 3.0}}, fit));
  EXPECT_NEAR(fit.at(5.0), 2.0, 1e-12);
  EXPECT_EQ(fit.c[2], 0.0);
  EXPECT_EQ(fit.c[3], 0.0);
  ASSERT_TRUE(fit_cubic(std::vector<Vec2>{{0.0, 1.0}, {10.0, 2.0}, {20.0, 5.0}}, fit));
  EXPECT_NEAR(fit.at(20.0), 5.0, 1e-12);
  EXPECT_EQ(fit.c[3], 0.0);
}

TEST(FitCubic, HasTheOrderThatIsAsked) {
  std::vector<Vec2> points;
  for (const double x : {-3.0, -1.0, 1.0, 3.0}) points.emplace_back(x, 1.0 + x * x);
  Cubic fit;
  ASSERT_TRUE(fit_cubic(points, fit, 2));
  EXPECT_NEAR(fit.at(3.0), 10.0, 1e-12);
  ASSERT_TRUE(fit_cubic(points, fit, 1));
  EXPECT_NEAR(fit.c[0], 6.0, 1e-12) << "the mean";
  EXPECT_NEAR(fit.c[1], 0.0, 1e-12);
  EXPECT_EQ(fit.c[2], 0.0);
  EXPECT_EQ(fit.c[3], 0.0);
}

TEST(FitCubic, TakesTheMeanWherePointsShareAnX) {
  Cubic fit;
  ASSERT_TRUE(fit_cubic(std::vector<Vec2>{{0.0, 1.0}, {0.0, 3.0}, {10.0, 5.0}, {10.0, 7.0}}, fit));
  EXPECT_NEAR(fit.at(0.0), 2.0, 1e-9);
  EXPECT_NEAR(fit.at(10.0), 6.0, 1e-9);
}

TEST(FitCubic, RefusesALineThatHasNoExtentAhead) {
  Cubic fit{{9.0, 9.0, 9.0, 9.0}};
  EXPECT_FALSE(fit_cubic(std::vector<Vec2>{}, fit));
  EXPECT_FALSE(fit_cubic(std::vector<Vec2>{{5.0, 5.0}}, fit));
  EXPECT_FALSE(fit_cubic(std::vector<Vec2>{{5.0, 0.0}, {5.0, 10.0}, {5.0, 20.0}}, fit));
  EXPECT_EQ(fit.c[0], 9.0);
}

}  // namespace
}  // namespace chicane::controller
