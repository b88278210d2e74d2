// SPDX-License-Identifier: MIT
// The textbook: the controller of the five public write-ups in one file, to be read from top to bottom. No
// car library stands behind it: the solver of this repository, Eigen for the fit, Boost for the socket.
//
//   cmake build/release -DCHICANE_BUILD_EXAMPLES=ON && cmake --build build/release --target 00_textbook_mpc
//   00_textbook_mpc [port 4567] [mph 40] [sleep_ms 100]   the controller
//   chicane simulate --track original-lake --laps 2       the car, in another terminal; or the original game
//
// The write-ups are presets here: weighted, measured-latency, sixty-mph, fast-short-step, delay-in-model
// (docs/the_five_systems.md). Numbers and equations are those of `weighted`, which gives all its weights;
// comments name the others where they differ. Exercises stand at the end.
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <thread>
#include <tuple>
#include <utility>
#include <vector>

#include <Eigen/Dense>
#include <boost/asio.hpp>
#include <boost/beast.hpp>
#include <nlohmann/json.hpp>

#include "chicane/solver/ocp_solver.hpp"

using boost::asio::ip::tcp;
using nlohmann::json;

constexpr int kN = 10;            // states in the plan; measured-latency: 20, sixty-mph: 7
constexpr double kDt = 0.1;       // time from one to the next [s]; fast-short-step: 0.025
constexpr double kLf = 2.67;      // [m] the turning rate is v / Lf * delta; the course fitted it to circles
constexpr double kLatency = 0.1;  // time from telemetry to the wheels, as the controller assumes it [s]
constexpr double kMaxSteer = 25.0 * 3.14159265358979 / 180.0;  // [rad]
constexpr double kMpsPerMph = 0.44704;

// ---- 1 Telemetry: 42["telemetry",{"ptsx":[six numbers],"ptsy":[...],"x":...,"y":...,"psi":...,...}]
// World axes: x east, y north [m]; psi from east, counter-clockwise [rad].
struct Telemetry {
  std::vector<double> ptsx, ptsy;  // waypoints on the middle of the road: one behind the car, five ahead
  double x, y, psi;
  double speed;           // [mph]
  double steering_angle;  // wheels now [rad], positive to the RIGHT
  double throttle;        // pedal now, [0, 1]; braking reads as 0
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Telemetry, ptsx, ptsy, x, y, psi, speed, steering_angle, throttle)

// ---- 2 Roll-forward: the answer acts `kLatency` = L later. The plan begins where the car will be then.
//   x += v cos(psi) L      y += v sin(psi) L      psi -= v / Lf * delta * L      v += a L
// weighted and fast-short-step do this. sixty-mph moves x and y only. measured-latency measures L while
// driving. delay-in-model does without: in its model an input acts one step later. v is in m/s in the first
// three (in mph, as sixty-mph prints it, these weights leave the road); the last adds pedal * L to mph.
void roll_forward(Telemetry& car) {
  const double distance = car.speed * kMpsPerMph * kLatency;
  car.x += distance * std::cos(car.psi);
  car.y += distance * std::sin(car.psi);
  car.psi -= distance / kLf * car.steering_angle;
  car.speed += car.throttle * kLatency;
}

// ---- 3 The car's frame: origin at the car, x forward, y left. The car is at x = 0, y = 0, psi = 0 there.
//   x_car = dx cos(psi) + dy sin(psi)      y_car = dy cos(psi) - dx sin(psi)
// measured-latency computes the same by radius and angle.
void to_car_frame(Telemetry& car) {
  for (std::size_t i = 0; i < car.ptsx.size(); ++i) {
    const double dx = car.ptsx[i] - car.x, dy = car.ptsy[i] - car.y;
    car.ptsx[i] = dx * std::cos(car.psi) + dy * std::sin(car.psi);
    car.ptsy[i] = dy * std::cos(car.psi) - dx * std::sin(car.psi);
  }
}

// ---- 4 The line: the cubic f(x) = c0 + c1 x + c2 x^2 + c3 x^3 nearest to the waypoints, in least squares.
// polyfit and polyeval of the write-ups: Householder QR of the matrix whose rows are 1, x, x^2, x^3.
struct Cubic {  // auto: the solver also passes its type for derivatives
  Eigen::Vector4d c;
  auto at(const auto& x) const { return c[0] + x * (c[1] + x * (c[2] + x * c[3])); }
  auto slope(const auto& x) const { return c[1] + x * (2.0 * c[2] + x * (3.0 * c[3])); }
};
Cubic polyfit(const std::vector<double>& x, const std::vector<double>& y) {
  const auto n = static_cast<Eigen::Index>(x.size());
  const Eigen::Map<const Eigen::ArrayXd> xs(x.data(), n), ys(y.data(), n);
  Eigen::MatrixXd rows(n, 4);
  for (int power = 0; power < 4; ++power) rows.col(power) = xs.pow(power);
  return {rows.householderQr().solve(ys.matrix())};
}

// ---- 5 The optimal control problem: what the write-ups give to Ipopt as FG_eval.
struct Textbook {
  // Six states as in the write-ups: position, heading, speed, cte = f(x) - y, positive where the line is to
  // the left [m], epsi = heading minus the line's [rad]. Two more hold the inputs before: changes cost.
  static constexpr int kNx = 8, kNu = 2;
  static constexpr int kNr = 7, kNe = 3, kNc = 0;  // costs of a step, of the end; soft constraints
  Cubic f;
  double v_ref;  // [mph]

  // The model. v is telemetry's number, in mph, used as if it were m/s: no write-up names a conversion, and
  // these weights need it so (exercise 5). So the model travels and turns 2.24 times too fast, and the
  // controller asks for less steering. psi has a minus because delta is positive to the right. The other four
  // write psi + v / Lf * delta * dt: then the steering that is sent and read changes its sign.
  auto dynamics(auto /*step*/, const auto& state, const auto& input) const {
    const auto& [x, y, psi, v, cte, epsi, delta_before, a_before] = state;
    const auto& [delta, a] = input;
    const auto psi_des = atan(f.slope(x));
    return std::make_tuple(
        x + v * cos(psi) * kDt,                 // x_next    = x + v cos(psi) dt
        y + v * sin(psi) * kDt,                 // y_next    = y + v sin(psi) dt
        psi - v / kLf * delta * kDt,            // psi_next  = psi - v / Lf * delta * dt
        v + a * kDt,                            // v_next    = v + a dt   (printed as v a dt, a misprint)
        f.at(x) - y + v * sin(epsi) * kDt,      // cte_next  = f(x) - y + v sin(epsi) dt   (exercise 6)
        psi - psi_des - v / kLf * delta * kDt,  // epsi_next = psi - psi_des - v / Lf * delta * dt
        delta, a);
  }

  // Seven costs: the sum over the plan of weight * error^2. The solver minimises half of it.
  static constexpr double kCte = 200, kEpsi = 200, kV = 0.1, kDelta = 1, kA = 1, kDdelta = 10, kDa = 1;
  auto residual(auto k, const auto& state, const auto& input) const {
    const auto& [x, y, psi, v, cte, epsi, delta_before, a_before] = state;
    const auto& [delta, a] = input;
    using chicane::select, chicane::solver::stage_number;
    const auto has_before = select(stage_number(k) > 0.0, 1.0, 0.0);  // the first step has no step before
    return std::make_tuple(std::sqrt(kCte) * cte, std::sqrt(kEpsi) * epsi, std::sqrt(kV) * (v - v_ref),
                           std::sqrt(kDelta) * delta, std::sqrt(kA) * a,
                           has_before * std::sqrt(kDdelta) * (delta - delta_before),
                           has_before * std::sqrt(kDa) * (a - a_before));
  }
  auto terminal_residual(const auto& state) const {
    const auto& [x, y, psi, v, cte, epsi, delta_before, a_before] = state;
    return std::make_tuple(std::sqrt(kCte) * cte, std::sqrt(kEpsi) * epsi, std::sqrt(kV) * (v - v_ref));
  }

  // Bounds: |delta| <= 25 degrees, |a| <= 1. The pedal a is used as an acceleration: 1 mph/s.
  std::array<double, 2> input_lower(int) const { return {-kMaxSteer, -1.0}; }
  std::array<double, 2> input_upper(int) const { return {kMaxSteer, 1.0}; }
};

// ---- 6 One cycle, in the order of the blocks above.
json answer(Telemetry car, double v_ref) {
  roll_forward(car);
  to_car_frame(car);
  const Cubic f = polyfit(car.ptsx, car.ptsy);

  // The first state, with cte = f(0), epsi = -arctan f'(0). has_before makes its last two numbers unused.
  const std::array<double, 8> now{0, 0, 0, car.speed, f.at(0.0), -std::atan(f.slope(0.0)), 0, 0};
  // The solver starts from inputs of zero. Its inputs are within bounds even where it fails: they are sent.
  static const auto solver = std::make_unique<chicane::solver::OcpSolver<Textbook, kN - 1>>();
  chicane::solver::Trajectory<8, 2, kN - 1> plan{.horizon = kN - 1};  // steps
  const auto report = solver->solve(Textbook{.f = f, .v_ref = v_ref}, now, plan);
  if (!usable(report.status)) std::fprintf(stderr, "solver: %s\n", to_string(report.status).data());

  // The first inputs of the plan: steering as a share of 25 degrees, positive to the right, and the pedal.
  // The simulator draws the rest in the frame of the car now, so v L too far back: green plan, yellow cubic.
  json steer{{"steering_angle", plan.u[0][0] / kMaxSteer}, {"throttle", plan.u[0][1]}};
  for (const auto& state : plan.x) steer["mpc_x"].push_back(state[0]), steer["mpc_y"].push_back(state[1]);
  for (double x = 0; x <= 60; x += 5) steer["next_x"].push_back(x), steer["next_y"].push_back(f.at(x));
  return steer;
}

// ---- 7 The socket: 42["steer",{...}] for each 42["telemetry",{...}]. The simulator is the client.
// It waits for each answer before it sends again. The sleep stands for the slow actuators of a real car.
void talk(tcp::socket client, double v_ref, std::chrono::milliseconds sleep) {
  boost::beast::websocket::stream<tcp::socket> socket{std::move(client)};
  boost::system::error_code gone;
  socket.accept(gone);
  for (boost::beast::flat_buffer bytes; socket.read(bytes, gone), !gone; bytes.clear()) {
    const std::string text = boost::beast::buffers_to_string(bytes.data());
    if (!text.starts_with("42[\"telemetry\"")) continue;  // such as "2", a ping
    const json car = json::parse(text.substr(2)).at(1);
    const json event = car.is_null() ? json{"manual", json::object()} : json{"steer", answer(car, v_ref)};
    std::this_thread::sleep_for(sleep);
    socket.write(boost::asio::buffer("42" + event.dump()), gone);
  }
}

int main(int argc, char** argv) {
  const auto number = [&](int i, int otherwise) { return argc > i ? std::atoi(argv[i]) : otherwise; };
  boost::asio::io_context io;
  const auto port = static_cast<unsigned short>(number(1, 4567));
  tcp::acceptor door{io, {boost::asio::ip::address_v4::loopback(), port}};
  for (;;) talk(door.accept(), number(2, 40), std::chrono::milliseconds{number(3, 100)});
}

// ---- Exercises
// Change one thing, drive two laps of original-lake at 60 mph, compare the second one. Unchanged: 45.9 s, at
// most 2.3 m from the middle (`simulate --json`: max_abs_lateral_error_m), no tyre off. textbook_mpc.py
// drives the same laps and needs no build. What we saw:
// 1 N       kN = 7: 47.9 s. 20: 44.0 s. 5: 79 mph in the mean, off the road.
// 2 dt      kDt = 0.2: 7.7 m from the middle, off. 0.05: off, also with kN = 20.
// 3 weights kV = 0.02: 60.9 s, 1.7 m. 1: 42.5 s, 2.5 m. At 40 mph kV = 0.01: off, stops and never starts
// again.
//           kEpsi = 20000: 63.6 s, 0.9 m. kDdelta = 10000: 45.9 s, 2.2 m.
// 4 latency kLatency = 0: weaves, off. 0.05: stays on. 0.2: weaves, off. Third argument 200: off, also
//           with kLatency = 0.2: the wheels turn later still (docs/measured/effects.md).
// 5 units   car.speed in `now` and v_ref in m/s: off. In m/s and with kDdelta = 30000: 53.1 s, 0.8 m.
// 6 sign    cte_next = f(x) - y - v sin(epsi) dt, the sign that fits cte = f(x) - y: 47.7 s, 1.3 m.
// 7 states  measured-latency's recursion, cte_next = cte - v sin(epsi) dt and epsi_next = epsi -
//           v / Lf * delta * dt: 47.9 s, 2.5 m. With its own cte + v sin(epsi) dt: off at once.
