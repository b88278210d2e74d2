// SPDX-License-Identifier: MIT
#include "families/list.hpp"

#include <array>

namespace chicane::bench {

// One for each family, compiled alone (one_family.cpp).
Family cart_pole_family();
Family planar_quadrotor_family();
Family quadrotor_family();
Family rocket_landing_family();
Family chain_of_masses_family();
Family parking_family();
Family crane_family();
Family double_pendulum_family();
Family arm_family();
Family acrobot_family();
Family reactor_family();
Family glider_family();
// With something that must hold.
Family hard_cart_pole_family();
Family hard_rocket_landing_family();
Family hard_planar_quadrotor_family();
Family hard_parking_family();
Family arm_on_a_line_family();
Family crane_in_least_time_family();
Family periodic_pendulum_family();
Family goddard_rocket_family();
Family lorry_family();
Family bryson_denham_family();
Family gates_family();
Family tanks_family();
Family brachistochrone_family();
Family orbit_raising_family();
Family tube_family();
// Nearly possible and conflicting ones.
Family point_mass_family();
Family hanging_chain_family();
Family slow_turn_family();

std::span<const Family> all_families() {
  static const std::array families{cart_pole_family(),
                                   planar_quadrotor_family(),
                                   quadrotor_family(),
                                   rocket_landing_family(),
                                   chain_of_masses_family(),
                                   parking_family(),
                                   crane_family(),
                                   double_pendulum_family(),
                                   arm_family(),
                                   acrobot_family(),
                                   reactor_family(),
                                   glider_family(),
                                   hard_cart_pole_family(),
                                   hard_rocket_landing_family(),
                                   hard_planar_quadrotor_family(),
                                   hard_parking_family(),
                                   arm_on_a_line_family(),
                                   crane_in_least_time_family(),
                                   periodic_pendulum_family(),
                                   goddard_rocket_family(),
                                   lorry_family(),
                                   bryson_denham_family(),
                                   gates_family(),
                                   tanks_family(),
                                   brachistochrone_family(),
                                   orbit_raising_family(),
                                   tube_family(),
                                   point_mass_family(),
                                   hanging_chain_family(),
                                   slow_turn_family()};
  return families;
}

}  // namespace chicane::bench
