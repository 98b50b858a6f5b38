// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>
#include <string_view>

#include "carus/fem/element_block.hpp"

namespace carus::fem {

#define CARUS_DECLARE_KERNEL(isa)                                                                             \
  namespace isa {                                                                                             \
  KernelReport forces(const Batch*, std::size_t, const KernelMaterial&, const Float4*, Float4*, const float*, \
                      const BatchStress*);                                                                    \
  double relax(const Batch*, std::size_t, const KernelMaterial&, const Float4*, BatchStress*);                \
  void volumes(const Batch*, std::size_t, const Float4*, float*);                                             \
  }
CARUS_DECLARE_KERNEL(portable)
#ifdef CARUS_X86
CARUS_DECLARE_KERNEL(avx2)
CARUS_DECLARE_KERNEL(avx512)
#endif

const Kernel& kernel() {
  static const Kernel chosen = [] {
    const Kernel fallback{portable::forces, portable::relax, portable::volumes, "portable"};
#ifdef CARUS_X86
    const char* env = std::getenv("CARUS_ISA");
    const std::string_view want = env ? env : "";
    const bool has_avx512 =
        __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
    const bool has_avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
    if (has_avx512 && (want.empty() || want == "avx512"))
      return Kernel{avx512::forces, avx512::relax, avx512::volumes, "avx512"};
    if (has_avx2 && (want.empty() || want == "avx2" || want == "avx512"))
      return Kernel{avx2::forces, avx2::relax, avx2::volumes, "avx2"};
#endif
    return fallback;
  }();
  return chosen;
}

}  // namespace carus::fem
