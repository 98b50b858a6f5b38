// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <random>
#include <string>

#include "carus/material/fibre.hpp"
#include "carus/material/hessian.hpp"
#include "carus/material/hooke.hpp"
#include "carus/material/mooney_rivlin.hpp"
#include "carus/material/neo_hooke.hpp"

namespace carus::material {

inline constexpr double shear = 30e3;  // [Pa] of every law in these tests
inline constexpr double bulk = 10 * shear;

inline const Vec3 fibre_direction = Vec3(2, 1, -2) / 3;

/// What a law promises beyond the common interface.
struct Traits {
  std::string name;
  bool objective = true;
  bool isotropic = true;
};

template <class T>
NeoHooke<T> neo_hooke() {
  return NeoHooke<T>(constant<T>(shear / 2));
}
template <class T>
MooneyRivlin<T> mooney_rivlin() {
  return {constant<T>(0.3 * shear), constant<T>(0.2 * shear)};
}
template <class T>
Fibre<T> fibre() {
  const Vec3& a = fibre_direction;
  return {constant<T>(shear), constant<T>(0.8), {constant<T>(a[0]), constant<T>(a[1]), constant<T>(a[2])}};
}

/// One body over every law: body(law in T, traits).
template <class T, class Body>
void for_each_law(Body body) {
  body(neo_hooke<T>(), Traits{"neo-Hooke"});
  body(mooney_rivlin<T>(), Traits{"Mooney-Rivlin"});
  body(HookeSmallStrain<T>(constant<T>(shear)), Traits{.name = "Hooke, small strain", .objective = false});
  body(HookeCorotated<T>(constant<T>(shear)), Traits{"Hooke, corotated"});
  body(fibre<T>(), Traits{.name = "fibre", .isotropic = false});
}

inline Mat3 random_matrix(std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  return Mat3::NullaryExpr([&] { return uniform(random); });
}
inline Mat3 random_rotation(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random)).normalized().matrix();
}
/// Rotation times stretch, principal stretches within (1 - size)..(1 + size).
inline Mat3 random_deformation(std::mt19937& random, double size) {
  std::uniform_real_distribution<double> uniform(1 - size, 1 + size);
  const Mat3 Q = random_rotation(random);
  return random_rotation(random) * Q * Vec3(uniform(random), uniform(random), uniform(random)).asDiagonal() *
         Q.transpose();
}

}  // namespace carus::material
