// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <vector>

namespace carus::parallel {

/// Limits the threads used while it lives; 0 means all.
class Threads {
 public:
  explicit Threads(int n) {
    if (n > 0) {
      limit_ = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism, std::size_t(n));
    }
  }

 private:
  std::unique_ptr<tbb::global_control> limit_;
};

/// Calls f(begin, end, chunk) over [0, n) in chunks of fixed size. Chunks do not depend on the number of threads, so
/// sums taken per chunk and added in the order of chunks do not either.
template <class F>
void for_chunks(std::size_t n, std::size_t chunk, F&& f) {
  const std::size_t chunks = (n + chunk - 1) / chunk;
  if (chunks <= 1) {
    if (n > 0) f(std::size_t(0), n, std::size_t(0));
    return;
  }
  tbb::parallel_for(
      std::size_t(0), chunks, [&](std::size_t c) { f(c * chunk, std::min(n, (c + 1) * chunk), c); },
      tbb::static_partitioner());
}

/// Sum over [0, n) of f(begin, end), in an order that does not depend on the number of threads.
template <class F>
double sum_chunks(std::size_t n, std::size_t chunk, F&& f) {
  std::vector<double> part((n + chunk - 1) / chunk, 0.0);
  for_chunks(n, chunk, [&](std::size_t b, std::size_t e, std::size_t c) { part[c] = f(b, e); });
  double sum = 0;
  for (const double p : part) sum += p;
  return sum;
}

}  // namespace carus::parallel
