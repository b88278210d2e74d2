// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>

#include "chicane/base/compiler.hpp"
#include "chicane/base/math.hpp"
#include "chicane/model/vehicle.hpp"
#include "chicane/model/wheel_forces.hpp"

/// The car model of controllers, guard and planner: motion of a single track with tyres that saturate.

namespace chicane::model {

/// Part of a car's state that does not depend on its position and heading, in the axes of the body.
template <class T>
struct BodyMotion {
  T vx{};            ///< forward velocity [m/s]
  T vy{};            ///< lateral velocity, left positive [m/s]
  T r{};             ///< yaw rate [rad/s]
  T steer{};         ///< road-wheel angle [rad]
  T acceleration{};  ///< net acceleration by drive, brakes and drag, without cornering resistance [m/s²]
};

/// The car model of a tracking controller: a single track with saturating tyres, steering and drive lag,
/// and the share h by which some cars turn their velocity with the body (docs/controller.md, eq. 1–5).
///
///     v_y' = k_f α_f + k_r α_r + φ a_x δ − (1 − h) r v_x    α_f = δ − (v_y + a r)/v_x
///     r'   = (m / I)(a (k_f α_f + φ a_x δ) − b k_r α_r)     α_r =   − (v_y − b r)/v_x
///     v_x' = a_x + (1 − h) r v_y − k_f α_f δ
///
/// k are secant stiffnesses per mass, F/(m α), of a saturating tyre. One step is linearly implicit in (v_y,
/// r): tyres that are stiff at low speed cannot make it unstable, and v_x → 0 tends to the kinematic bicycle,
/// so one model serves every speed from standstill on. Tyres that share force add air and rolling (eq. 4g).
///
/// T is double, or holds derivatives, several stages at once, or both (base/jet.hpp). No allocation, no
/// failure for finite input, any dt > 0. Error O(dt²) per step.
class PredictionModel {
 public:
  explicit PredictionModel(const model::VehicleParams& vehicle) noexcept { set_vehicle(vehicle); }
  /// Changes the car.
  void set_vehicle(const model::VehicleParams& vehicle) noexcept {
    vehicle_ = vehicle;
    per_peak_ = per_peak(vehicle);
    unloading_front_ = unloading(vehicle, vehicle.rear_axle, vehicle.roll_share_front);
    unloading_rear_ = unloading(vehicle, vehicle.front_axle, 1.0 - vehicle.roll_share_front);
    rolling_ = std::max(vehicle.drag_constant - vehicle.drag_driven, 0.0) / vehicle.load_constant;
  }

  /// Share of the difference between present and commanded value that a first-order lag leaves.
  struct Lag {
    double end = 0.0;   ///< at the end of a step
    double mean = 0.0;  ///< mean over the step
  };
  /// Lags of steering and drive over a step of dt [s].
  struct Lags {
    Lag steer;
    Lag drive;
  };
  [[nodiscard]] Lags lags(double dt) const noexcept {
    return {lag(vehicle_.steer_lag, dt), lag(vehicle_.drive_lag, dt)};
  }

  /// v_x, v_y and r after dt [s] with the given mean road-wheel angle [rad] and net acceleration [m/s²]. `dt`
  /// is one number, or one for each lane of T.
  template <class T, class D>
  [[nodiscard]] CHICANE_INLINE inline BodyMotion<T> advance(const BodyMotion<T>& from, const T& steer,
                                                            const T& acceleration,
                                                            const D& dt) const noexcept {
    const model::VehicleParams& p = vehicle_;
    const Tires<T> tires = tire_state<false>(from, steer);
    const T& kf = tires.stiffness_front;
    const T& kr = tires.stiffness_rear;
    const T& inverse_v = tires.inverse_speed;
    const double a = p.front_axle;
    const double b = p.rear_axle;
    const D turn = dt * (p.mass / p.yaw_inertia);

    // (1 − dt A)(v_y, r)⁺ = (v_y, r) + dt B δ
    const T sum = (kf + kr) * inverse_v;
    const T moment = (a * kf - b * kr) * inverse_v;
    const T damping = (a * a * kf + b * b * kr) * inverse_v;
    const T a11 = 1.0 + dt * sum;
    const T a12 = dt * (moment + (1.0 - p.steer_helper) * from.vx);
    const T a21 = turn * moment;
    const T a22 = 1.0 + turn * damping;
    // Drive and brake force of the front wheels point along the wheels, and so also to the side.
    const T force = (kf + front_force<false>(T(acceleration + tires.air))) * steer;
    const T b1 = from.vy + dt * force;
    const T b2 = from.r + (turn * a) * force + turn * tires.twist;
    const T det = a11 * a22 - a12 * a21;
    // A large implicit step of a car that spins is singular: its growth is limited to fivefold.
    const T inverse_det = 1.0 / T(select(det > kLeastDeterminant, det, kLeastDeterminant));
    BodyMotion<T> to;
    to.vy = (b1 * a22 - a12 * b2) * inverse_det;
    to.r = (a11 * b2 - a21 * b1) * inverse_det;

    const T slip_front = steer - (to.vy + a * to.r) * inverse_v;
    to.vx = from.vx + dt * (acceleration - tires.lost + (1.0 - p.steer_helper) * to.r * to.vy -
                            kf * steer * slip_front);
    return to;
  }

  /// Motion after dt [s] with constant commands, lags of steering and drive included.
  [[nodiscard]] BodyMotion<double> advance(const BodyMotion<double>& from, double steer_command,
                                           double acceleration_command, double dt,
                                           const Lags& lags) const noexcept {
    const double steer = from.steer - steer_command;
    const double acceleration = from.acceleration - acceleration_command;
    BodyMotion<double> to = advance(from, steer_command + steer * lags.steer.mean,
                                    acceleration_command + acceleration * lags.drive.mean, dt);
    to.steer = steer_command + steer * lags.steer.end;
    to.acceleration = acceleration_command + acceleration * lags.drive.end;
    return to;
  }

  /// Time derivatives of v_x, v_y and r, and the use of the tyres.
  template <class T>
  struct Change {
    T vx, vy;                     ///< [m/s²]
    T r;                          ///< [rad/s²]
    T square_front, square_rear;  ///< squares of TireUse::front and rear
    T along_front, along_rear;    ///< as in TireUse
  };
  /// Time derivatives at a motion (eq. 1–3). They are smooth, for searches that use second derivatives: the
  /// change from drive to brakes is blended within kBlend.
  template <class T>
  [[nodiscard]] Change<T> change(const BodyMotion<T>& at) const noexcept {
    const model::VehicleParams& p = vehicle_;
    const Tires<T> tires = tire_state<true>(at, at.steer);
    const T front = tires.stiffness_front * (at.steer - (at.vy + p.front_axle * at.r) * tires.inverse_speed);
    const T rear = tires.stiffness_rear * ((p.rear_axle * at.r - at.vy) * tires.inverse_speed);
    const T pull = front_force<true>(T(at.acceleration + tires.air)) * at.steer;
    const T turn = (1.0 - p.steer_helper) * at.r;
    return {
        .vx = at.acceleration - tires.lost + turn * at.vy - front * at.steer,
        .vy = front + rear + pull - turn * at.vx,
        .r = (p.mass / p.yaw_inertia) * (p.front_axle * (front + pull) - p.rear_axle * rear + tires.twist),
        .square_front = (per_peak_ * per_peak_) * tires.square_front,
        .square_rear = (per_peak_ * per_peak_) * tires.square_rear,
        .along_front = tires.along_front,
        .along_rear = tires.along_rear};
  }

  /// Use of an axle's tyres: 1 is the peak of the tyre curve. While the axle drives it is the use of the
  /// inner wheel, which spins first.
  template <class T>
  struct TireUse {
    T front, rear;  ///< slip over the slip of the peak, both directions together
    /// Longitudinal force over peak force; 0 for a car without friction_coupling.
    T along_front, along_rear;
  };
  /// Use of the tyres in a motion.
  template <class T>
  [[nodiscard]] CHICANE_INLINE inline TireUse<T> tire_use(const BodyMotion<T>& motion) const noexcept {
    const Tires<T> tires = tire_state<false>(motion, motion.steer);
    return {sqrt(tires.square_front) * per_peak_, sqrt(tires.square_rear) * per_peak_, tires.along_front,
            tires.along_rear};
  }

  /// Road-wheel angle that gives a yaw acceleration [rad/s²], without lag [rad]. The front slip is limited to
  /// that of the peak force and to kMostSlip, at which a road tyre has nine tenths of it.
  [[nodiscard]] double steer_for(const BodyMotion<double>& m, double yaw_acceleration) const noexcept {
    const model::VehicleParams& p = vehicle_;
    const Tires<double> tires = tire_state<false>(m, m.steer);
    const double rear = tires.stiffness_rear * (p.rear_axle * m.r - m.vy) * tires.inverse_speed;
    const double wanted = (p.yaw_inertia / p.mass * yaw_acceleration + p.rear_axle * rear) / p.front_axle -
                          front_force<false>(m.acceleration + tires.air) * m.steer;
    const double most = p.friction / p.cornering_front * std::min(1.0 / per_peak_, kMostSlip);
    const double slip = wanted / tires.stiffness_front;
    return (slip < -most  ? -most
            : slip > most ? most
                          : slip) +
           (m.vy + p.front_axle * m.r) * tires.inverse_speed;
  }

  /// Slip angle of the rear tyres at the peak of their curve [rad].
  [[nodiscard]] double peak_slip_rear() const noexcept {
    return vehicle_.friction / (vehicle_.cornering_rear * per_peak_);
  }
  /// Speed by which slip angles are kept finite [m/s]; chosen. They divide by √(v² + kSpeedFloor²).
  static constexpr double kSpeedFloor = 1.0;
  /// Normal acceleration carried by the tyres at speed v [m/s²].
  [[nodiscard]] double load(double v) const noexcept { return vehicle_.load(v); }
  [[nodiscard]] const model::VehicleParams& vehicle() const noexcept { return vehicle_; }

 private:
  static constexpr double kGravity = 9.81;  ///< [m/s²]
  static constexpr double kLeastDeterminant =
      0.2;  ///< limit of the growth in an implicit step: fivefold; chosen

  /// State of the axles' tyres.
  template <class T>
  struct Tires {
    T inverse_speed;                    ///< one over the speed in slip angles [s/m]
    T square_front, square_rear;        ///< square of the slip z (secant())
    T along_front, along_rear;          ///< longitudinal force over peak force
    T stiffness_front, stiffness_rear;  ///< secant stiffness per mass, k in eq. 1–3 [m/s²]
    T lost;                             ///< acceleration lost to spinning wheels or anti-lock [m/s²]
    T twist;                            ///< yaw moment by that loss and by rolling, over mass [m²/s²]
    T air;                              ///< acceleration that the tyres give against the air [m/s²]
  };

  /// Lag of a time constant [s] over a step of dt [s].
  static Lag lag(double time_constant, double dt) noexcept {
    constexpr double kInstant = 1e-4;  // [s] time constant that counts as none; chosen
    if (time_constant <= kInstant) return {};
    const double decay = exp(-dt / time_constant);
    return {decay, (1.0 - decay) * time_constant / dt};
  }

  /// State of the tyres in a motion with the given road-wheel angle (docs/controller.md, eq. 4a–4g), in three
  /// parts: loads of the axles; tyres that share no force between the directions; tyres that do, by the
  /// wheels of each axle. With kSmooth all corners are rounded.
  template <bool kSmooth, class T>
  [[nodiscard]] CHICANE_INLINE inline Tires<T> tire_state(const BodyMotion<T>& m,
                                                          const T& steer) const noexcept {
    // Loads of the axles by weight, downforce and load transfer.
    const model::VehicleParams& p = vehicle_;
    const double per_wheelbase = 1.0 / p.wheelbase();
    const double rest_front = p.rear_axle * per_wheelbase;  // share of the load at rest
    const double rest_rear = p.front_axle * per_wheelbase;
    const T speed = sqrt(m.vx * m.vx + kSpeedFloor * kSpeedFloor);
    const T load_now = p.load_constant + (p.load_per_speed + p.load_quadratic * speed) * speed;
    // Load transfer depends on the weight alone, not on downforce.
    const T rest = p.load_quadratic > 0.0 ? T(p.load_constant / load_now) : T(1.0);
    const T transfer = (p.height / kGravity) * rest * m.acceleration;
    T part_front = 1.0 - (1.0 / p.rear_axle) * transfer;  // load over that at rest
    T part_rear = 1.0 + (1.0 / p.front_axle) * transfer;
    if (p.load_balance != 0.0) {
      const T pressed = p.load_balance * (1.0 - rest);
      part_front = part_front + (1.0 / rest_front) * pressed;
      part_rear = part_rear - (1.0 / rest_rear) * pressed;
    }
    part_front = least<kSmooth>(part_front);
    part_rear = least<kSmooth>(part_rear);
    const T load_front = rest_front * load_now * part_front;
    const T load_rear = rest_rear * load_now * part_rear;
    const T grip_front = 1.0 + p.load_sensitivity * (1.0 - part_front);  // friction over that at rest
    const T grip_rear = 1.0 + p.load_sensitivity * (1.0 - part_rear);
    Tires<T> t;
    t.inverse_speed = 1.0 / speed;
    const T slip_front = steer - (m.vy + p.front_axle * m.r) * t.inverse_speed;
    const T slip_rear = (p.rear_axle * m.r - m.vy) * t.inverse_speed;

    // Tyres whose longitudinal and lateral force do not depend on each other.
    const double per_friction = 1.0 / p.friction;
    if (!(p.friction_coupling > 0.0)) {
      const auto axle = [&](double cornering, const T& slip, const T& load, T& square, T& stiffness)
                            CHICANE_INLINE {
                              const T z = (cornering / p.friction) * slip;
                              square = z * z;
                              stiffness = cornering * load * secant(square);
                            };
      axle(p.cornering_front, slip_front, grip_front * load_front, t.square_front, t.stiffness_front);
      axle(p.cornering_rear, slip_rear, grip_rear * load_rear, t.square_rear, t.stiffness_rear);
      t.along_front = t.along_rear = t.lost = t.twist = t.air = T(0.0);
      return t;
    }

    // Lateral acceleration by the tyres (eq. 4d), with equal loads of both wheels of an axle. It differs from
    // v_x r while the slip angle of the car changes.
    t.air = (p.drag_linear + p.drag_quadratic * speed) * speed;
    const T force = m.acceleration + t.air;
    const T drive = positive<kSmooth>(force, kBlend);
    const T brake = drive - force;
    const T pulls[2] = {T(p.drive_share_front * drive + p.brake_share_front * brake),
                        T((1.0 - p.drive_share_front) * drive + (1.0 - p.brake_share_front) * brake)};
    const T slips[2] = {(p.cornering_front * per_friction) * slip_front,
                        (p.cornering_rear * per_friction) * slip_rear};
    const T squares[2] = {slips[0] * slips[0], slips[1] * slips[1]};
    const T across[2] = {secant(squares[0]), secant(squares[1])};
    const auto lateral = [&](const T& z, const T& secant, const T& load, const T& pull) CHICANE_INLINE {
      const T use_along = per_friction * pull / load;
      return p.friction * load * z * secant * sqrt(least<kSmooth>(T(1.0 - use_along * use_along)));
    };
    const T by_tires = lateral(slips[0], across[0], T(grip_front * load_front), pulls[0]) +
                       lateral(slips[1], across[1], T(grip_rear * load_rear), pulls[1]);
    const T sideways = rest * by_tires;
    const T side = 2.0 * positive<kSmooth>(sideways, kBlend) - sideways;

    // Both wheels of an axle have its slip angle and half its longitudinal force, and loads of their own.
    // `driving` is 1 while the inner wheel may spin, and 0 while braking, when anti-lock prevents it.
    const T driving = 0.5 + 0.5 * force / sqrt(force * force + kBlend * kBlend);
    struct LoadedAxle {
      double cornering, unloading, rest;
      T z2, across2, part, grip, pull;
      T along{}, square{}, stiffness{};
    };
    LoadedAxle axles[2] = {{p.cornering_front, unloading_front_, rest_front, squares[0],
                            across[0] * across[0], part_front, grip_front, pulls[0]},
                           {p.cornering_rear, unloading_rear_, rest_rear, squares[1], across[1] * across[1],
                            part_rear, grip_rear, pulls[1]}};
    T lost[2] = {T(0.0), T(0.0)};
    // Loops that are not unrolled make a quarter of the code to compile.
#pragma GCC unroll 1
    for (LoadedAxle& axle : axles) {
      const T shift = axle.unloading * side;
      const T parts[2] = {least<kSmooth>(axle.part - shift), axle.part + shift};  // inner and outer wheel
      T use[2], square[2], stiffness[2];
#pragma GCC unroll 1
      for (int i = 0; i < 2; ++i) {
        const T load =
            (0.5 * axle.rest) * load_now * parts[i] * (1.0 + p.load_sensitivity * (1.0 - parts[i]));
        use[i] = (0.5 * per_friction) * axle.pull / load;
        const T over = positive<kSmooth>(T(use[i] - kMostAlong), kSmoothUse);
        lost[i] = lost[i] + over * (p.friction * load);
        // Longitudinal slip that gives this force together with the lateral slip (similarity).
        const T kept = use[i] - over;
        const T u2 = kept * kept;
        const T first = secant(axle.z2 + u2 / (axle.across2 * sqrt(1.0 - u2 * u2)));
        square[i] = axle.z2 + u2 / (first * first);
        stiffness[i] = axle.cornering * load * secant(square[i]);
      }
      const T mean = (parts[0] * square[0] + parts[1] * square[1]) / (parts[0] + parts[1]);
      axle.square = mean + driving * (square[0] - mean);
      const T together = (per_friction * axle.pull) / (axle.grip * (axle.rest * load_now * axle.part));
      axle.along = together + driving * (use[0] - together);
      axle.stiffness = stiffness[0] + stiffness[1];
    }
    t.square_front = axles[0].square;
    t.square_rear = axles[1].square;
    t.along_front = axles[0].along;
    t.along_rear = axles[1].along;
    t.stiffness_front = axles[0].stiffness;
    t.stiffness_rear = axles[1].stiffness;
    const T sign = select(force < 0.0, T(-1.0), T(1.0));
    t.lost = sign * (lost[0] + lost[1]);
    // The loaded outer wheels roll with more resistance.
    t.twist = (0.5 * p.track_width) * sign * (sideways / (side + kLeastSide)) * (lost[0] - lost[1]) -
              (p.height * rolling_) * by_tires;
    return t;
  }

  /// Secant of the tyre curve over its initial slope, by the square of the slip z, which is in units of peak
  /// force over initial stiffness. The curve is the magic formula, with the secant sin(C atan(z/C))/z, or the
  /// original simulator's, which falls by a quarter between z = 1 and 2.5 (eq. 4a).
  template <class T>
  [[nodiscard]] [[gnu::noinline]] T secant(const T& square) const noexcept {
    const T least = square + kLeastSquare;
    if (vehicle_.tire_shape > 0.0) return model::magic_secant(vehicle_.tire_shape, least);
    const T z = sqrt(least);
    const T beyond = (z - 1.0) * (1.0 / 1.5);
    const T w = select(beyond < 1.0, beyond, T(1.0));
    return select(z < 1.0, 1.0 + z - z * z, (1.0 - 0.25 * (w * w * (3.0 - 2.0 * w))) / z);
  }

  /// max(x, 0), exact or smooth within about `width`.
  template <bool kSmooth, class T>
  [[nodiscard]] CHICANE_INLINE static inline T positive(const T& x, double width) noexcept {
    if constexpr (kSmooth) {
      return 0.5 * (x + sqrt(x * x + width * width));
    } else {
      return positive_part(x);
    }
  }
  /// Drive and brake force of the front wheels, of all wheels' `force`; both over the car's mass [m/s²].
  template <bool kSmooth, class T>
  [[nodiscard]] CHICANE_INLINE inline T front_force(const T& force) const noexcept {
    const T drive = positive<kSmooth>(force, kBlend);
    return vehicle_.drive_share_front * drive + vehicle_.brake_share_front * (force - drive);
  }
  /// max(share, kLeastLoad) of a wheel's load at rest, exact or smooth within about kSmoothLoad.
  template <bool kSmooth, class T>
  [[nodiscard]] CHICANE_INLINE static inline T least(const T& share) noexcept {
    if constexpr (kSmooth) {
      return kLeastLoad + positive<true>(T(share - kLeastLoad), kSmoothLoad);
    } else {
      return select(share > kLeastLoad, share, T(kLeastLoad));
    }
  }
  /// Share of its load at rest that an inner wheel loses for each m/s² of lateral acceleration [s²/m].
  static double unloading(const model::VehicleParams& p, double other_axle, double share) noexcept {
    return 2.0 * p.height * share / p.track_width / (p.load_constant * other_axle / p.wheelbase());
  }
  /// One over the slip z (secant()) of the peak force.
  static double per_peak(const model::VehicleParams& p) noexcept {
    return p.tire_shape > 0.0 ? 1.0 / (p.tire_shape * tan(0.5 * kPi / p.tire_shape)) : 1.0;
  }

  // Chosen.
  static constexpr double kMostSlip = 1.4;      ///< largest front slip z of steer_for()
  static constexpr double kMostAlong = 0.95;    ///< largest longitudinal force, share of the peak
  static constexpr double kLeastSide = 1e-3;    ///< keeps quotients defined without acceleration [m/s²]
  static constexpr double kLeastLoad = 0.1;     ///< least share of the load at rest, and least 1 − u²
  static constexpr double kLeastSquare = 1e-8;  ///< least square of a slip: the secant has a kink at 0
  // Widths over which change() rounds corners of advance(); kBlend blends the wheels of an axle in both.
  static constexpr double kSmoothUse = 0.02;             ///< width at kMostAlong, share of the peak
  static constexpr double kBlend = 0.3;                  ///< width between drive and brakes [m/s²]
  static constexpr double kSmoothLoad = 0.05;            ///< width at kLeastLoad, share of the load at rest
  double unloading_front_ = 0.0, unloading_rear_ = 0.0;  ///< unloading() of the axles [s²/m]
  double rolling_ = 0.0;                                 ///< resistance of rolling wheels over their load
  double per_peak_ = 1.0;                                ///< per_peak()
  model::VehicleParams vehicle_;
};

}  // namespace chicane::model
