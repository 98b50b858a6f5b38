// SPDX-License-Identifier: Apache-2.0
// Purpose: cost of the explicit solver per element and step, on the block of the tests. The kernel alone (one thread),
// then whole steps without contact on one and two threads. Goal: kernel with assembly <= 10 ns per element and step on
// one core. Command: ./dev bench, or bench_elements; CARUS_ISA=portable|avx2|avx512 chooses the instruction set.
#include <benchmark/benchmark.h>

#include "scenes.hpp"

namespace {

using namespace carus;

void kernel_forces(benchmark::State& state) {
  const fem::Model model = bench::block(false);
  bench::Kernel kernel(model);
  for (auto _ : state) benchmark::DoNotOptimize(kernel.forces());
  const double elements = double(model.mesh.tets.size());
  state.SetLabel(fem::kernel().name);
  state.counters["per_element"] =
      benchmark::Counter(elements, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  state.counters["bytes_per_element"] = double(sizeof(fem::Batch)) / fem::lanes;
}
BENCHMARK(kernel_forces)->Unit(benchmark::kMicrosecond);

void whole_step(benchmark::State& state) {
  const fem::Model model = bench::block(state.range(1) != 0);
  const auto options = bench::step_options(int(state.range(0)));
  solve::Explicit solver(model, options);
  const double chunk = 50;
  double t = 0;
  for (auto _ : state) solver.advance_to(t += chunk * options.time_step);
  state.counters["per_element"] =
      benchmark::Counter(double(model.mesh.tets.size()) * chunk,
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  state.SetLabel(fem::kernel().name);
}
BENCHMARK(whole_step)
    ->ArgNames({"threads", "nodal_pressure"})
    ->Args({1, 0})
    ->Args({2, 0})
    ->Args({1, 1})
    ->Args({2, 1})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
