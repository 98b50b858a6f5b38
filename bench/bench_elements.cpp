// SPDX-License-Identifier: Apache-2.0
// Purpose: cost of the explicit solver per element and step, on the block of the tests. The kernel alone (one thread),
// then whole steps without contact on one and two threads. Goal: kernel with assembly <= 10 ns per element and step on
// one core. Command: ./dev bench, or bench_elements; CARUS_ISA=portable|avx2|avx512 chooses the instruction set.
#include <benchmark/benchmark.h>

#include "carus/fem/element_block.hpp"
#include "carus/solve/energy.hpp"
#include "carus/solve/explicit.hpp"
#include "shapes.hpp"

namespace {

using namespace carus;

fem::Model block(bool average_nodal_pressure) {
  fem::Model model;
  model.mesh = shapes::box({0, 0, 0}, {0.1, 0.1, 0.1}, 20, 20, 21);  // 50,400 tets
  material::Material m;
  m.c10 = 30e3, m.poisson = 0.45, m.average_nodal_pressure = average_nodal_pressure;
  model.regions = {{"block", "block", m}};
  model.blocked.assign(model.mesh.nodes.size(), 0);
  return model;
}

void kernel_forces(benchmark::State& state) {
  const fem::Model model = block(false);
  auto blocks = fem::make_blocks(model, 16);
  const auto material = solve::kernel_material(model.regions[0], 0.02);
  for (auto& b : blocks) {
    for (std::size_t i = 0; i < b.nodes.size(); ++i) {
      const Vec3 x = 1.01 * model.mesh.nodes[b.nodes[i]];
      b.x[i] = {{float(x.x()), float(x.y()), float(x.z()), 0.f}};
    }
  }
  for (auto _ : state) {
    for (auto& b : blocks) {
      const auto report =
          fem::kernel().forces(b.batches.data(), b.batches.size(), material, b.x.data(), b.f.data(), nullptr, nullptr);
      benchmark::DoNotOptimize(report);
    }
  }
  const double elements = double(model.mesh.tets.size());
  state.SetLabel(fem::kernel().name);
  state.counters["per_element"] =
      benchmark::Counter(elements, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  state.counters["bytes_per_element"] = double(sizeof(fem::Batch)) / fem::lanes;
}
BENCHMARK(kernel_forces)->Unit(benchmark::kMicrosecond);

void whole_step(benchmark::State& state) {
  const fem::Model model = block(state.range(1) != 0);
  solve::ExplicitOptions options;
  options.labour_duration = options.pseudo_duration = 10, options.time_step = 1e-5,
  options.threads = int(state.range(0));
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
