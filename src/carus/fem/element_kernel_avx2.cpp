// SPDX-License-Identifier: Apache-2.0
#include "carus/fem/element_kernel_impl.hpp"

namespace carus::fem::avx2 {
#include "carus/fem/element_kernel.inl"
}  // namespace carus::fem::avx2
