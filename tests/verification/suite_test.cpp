// SPDX-License-Identifier: Apache-2.0
// The quick problems of `carus verify`.
#include <gtest/gtest.h>

#include <cstdio>

#include "carus/verify/problem.hpp"

namespace carus::verify {
namespace {

class Suite : public testing::TestWithParam<std::string> {};

TEST_P(Suite, IsMet) {
  for (const Problem& p : problems()) {
    if (p.name != GetParam()) continue;
    const auto outcome = run(p);
    std::printf("%s", as_text(outcome).c_str());
    EXPECT_TRUE(outcome.met());
  }
}

std::vector<std::string> quick() {
  std::vector<std::string> names;
  for (const Problem& p : problems()) {
    if (p.quick) names.push_back(p.name);
  }
  return names;
}

INSTANTIATE_TEST_SUITE_P(Verify, Suite, testing::ValuesIn(quick()), [](const auto& problem) { return problem.param; });

/// The suite can fail: by a number, by an order, by an error, by being empty.
TEST(SuiteItself, NoticesFailure) {
  const auto outcome_of = [](std::function<std::vector<Check>()> f) {
    static Problem p;
    p = {"x", "x", "x", true, std::move(f)};
    return run(p);
  };
  const Check good{"q", "m", "explicit", 2, 2.01, 0.01};
  EXPECT_TRUE(outcome_of([&] { return std::vector{good}; }).met());
  Check off = good;
  off.obtained = 2.03;
  EXPECT_FALSE(outcome_of([&] { return std::vector{good, off}; }).met());
  Check nan = good;
  nan.obtained = NAN;
  EXPECT_FALSE(outcome_of([&] { return std::vector{nan}; }).met());
  Check slow = good;
  slow.order = 0.4, slow.least_order = 1;
  EXPECT_FALSE(outcome_of([&] { return std::vector{slow}; }).met());
  EXPECT_FALSE(outcome_of([] { return std::vector<Check>{}; }).met());
  const auto failed = outcome_of([]() -> std::vector<Check> { throw std::runtime_error("inverted"); });
  EXPECT_FALSE(failed.met());
  EXPECT_EQ(verdict({failed}).substr(0, 8), "NOT MET:");
}

}  // namespace
}  // namespace carus::verify
