// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "carus/verify/problem.hpp"

/// The problems, by what they prove. Each function returns its checks; suite.cpp names and refers them.
namespace carus::verify {

std::vector<Check> uniaxial();
std::vector<Check> equibiaxial();
std::vector<Check> simple_shear();
std::vector<Check> patch();

std::vector<Check> thick_sphere();
std::vector<Check> bending_block();
std::vector<Check> cook_membrane();

std::vector<Check> twisted_column();
std::vector<Check> cantilever();

std::vector<Check> contact_patch();
std::vector<Check> hertz_plane();
std::vector<Check> hertz_spheres();
std::vector<Check> curved_slide();

std::vector<Check> wave();
std::vector<Check> prony_relaxation();
std::vector<Check> prony_creep();
std::vector<Check> elastic_impact();

std::vector<Check> ellipsoid_in_tube();

}  // namespace carus::verify
