// SPDX-License-Identifier: Apache-2.0
#include "carus/report/coding.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "carus/report/pack.hpp"
#include "small_run.hpp"

namespace carus::report {
namespace {

using Integers = std::vector<std::int32_t>;

TEST(Planes, AreWhatTheFormatSays) {
  // Zigzag: 0 -> 0, -1 -> 1, 1 -> 2, 300 -> 600 = 0x0258; low bytes first, then the second ones.
  const auto p = to_planes(Integers{0, -1, 1, 300});
  EXPECT_EQ(p.planes, 2);
  EXPECT_THAT(p.bytes, testing::ElementsAre(0, 1, 2, 0x58, 0, 0, 0, 2));
}

TEST(Planes, ReadBackToTheSameIntegers) {
  std::mt19937 random(1);
  for (const std::int64_t largest : {0LL, 1LL, 63LL, 64LL, 32767LL, 8388607LL, 2147483647LL}) {
    std::uniform_int_distribution<std::int64_t> any(-largest, largest);
    Integers values{std::int32_t(largest), std::int32_t(-largest)};
    for (int i = 0; i < 500; ++i) values.push_back(std::int32_t(any(random)));
    const auto p = to_planes(values);
    EXPECT_EQ(from_planes(p.bytes, p.planes, values.size()), values) << largest;
    EXPECT_EQ(p.planes, largest < 128 ? 1 : largest < 32768 ? 2 : largest < 8388608 ? 3 : 4) << largest;
  }
  EXPECT_EQ(from_planes(to_planes(Integers{}).bytes, 1, 0), Integers{});
  const Integers least{std::numeric_limits<std::int32_t>::min()};
  EXPECT_EQ(from_planes(to_planes(least).bytes, 4, 1), least);
}

TEST(Planes, OfTheWrongSizeAreRefused) {
  const std::vector<std::uint8_t> bytes(7);
  EXPECT_NE(test::error_of([&] { from_planes(bytes, 2, 4); }), "");
  EXPECT_NE(test::error_of([&] { from_planes(bytes, 0, 0); }), "");
  EXPECT_NE(test::error_of([&] { from_planes(bytes, 7, 1); }), "");
}

TEST(Deflate, ReadsBackAndRefusesWhatIsCut) {
  std::vector<std::uint8_t> raw(10000);
  for (std::size_t i = 0; i < raw.size(); ++i) raw[i] = std::uint8_t(i * i / 7);
  const auto packed = deflate(raw);
  EXPECT_EQ(inflate(packed, raw.size()), raw);
  EXPECT_NE(test::error_of([&] { inflate(packed.substr(0, packed.size() - 9), raw.size()); }), "");
  EXPECT_NE(test::error_of([&] { inflate(packed, raw.size() - 1); }), "");
  EXPECT_NE(test::error_of([&] { inflate(packed, raw.size() + 1); }), "");
  EXPECT_EQ(inflate(deflate({}), 0).size(), 0u);
}

TEST(Base64, IsThatOfTheRfc) {
  // RFC 4648, section 10
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xff\xfe"), "//4=");
}

TEST(Quantiser, IsHalfAStepOffAtMost) {
  const Quantiser q(2e-5, "x");
  std::mt19937 random(2);
  std::uniform_real_distribution<double> any(-0.4, 0.4);
  double worst = 0;
  for (int i = 0; i < 10000; ++i) {
    const double x = any(random);
    worst = std::max(worst, std::abs(q.quantum() * q(x) - x));
  }
  EXPECT_LE(worst, 1e-5 * (1 + 1e-9));
  EXPECT_GT(worst, 0.9e-5);
  EXPECT_THAT(test::error_of([&] { static_cast<void>(q(std::nan(""))); }), testing::HasSubstr("x: the value nan"));
  EXPECT_NE(test::error_of([&] { static_cast<void>(q(1e9)); }), "");
}

/// Nothing accumulates: 200 frames of slow drift, far below a step each, stay within half a step of the truth.
TEST(Frames, ReadBackWithinHalfAStepHoweverMany) {
  const Quantiser q(2e-5, "x");
  const std::size_t nodes = 50, count = 200;
  std::vector<std::vector<double>> truth;
  std::vector<Integers> frames;
  Integers rest(nodes);
  for (std::size_t i = 0; i < nodes; ++i) rest[i] = q(1e-3 * double(i));
  for (std::size_t k = 0; k < count; ++k) {
    truth.emplace_back();
    frames.emplace_back();
    for (std::size_t i = 0; i < nodes; ++i) {
      truth[k].push_back(1e-3 * double(i) + 3e-6 * double(k) + 1e-2 * std::sin(0.05 * double(k) + double(i)));
      frames[k].push_back(q(truth[k][i]));
    }
  }
  for (const int order : {1, 2}) {
    const auto packed = pack_frames(frames, rest, order, 6);
    const auto back = unpack_frames(packed, count, rest, nodes);
    double worst = 0;
    for (std::size_t k = 0; k < count; ++k) {
      for (std::size_t i = 0; i < nodes; ++i) worst = std::max(worst, std::abs(2e-5 * back[k][i] - truth[k][i]));
    }
    EXPECT_LE(worst, 1e-5 * (1 + 1e-9)) << order;
    EXPECT_LT(packed.bytes.size(), nodes * count * 4 / 2) << order;
  }
}

}  // namespace
}  // namespace carus::report
