// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

// Everything here is forced inline: a kernel compiled for a wider instruction set leaves no symbol that the linker
// could pick for the rest of the program. For that reason also no Eigen in the headers that kernels include. The ABI of
// vectors as arguments then never matters either.
#pragma GCC diagnostic ignored "-Wpsabi"
#define CARUS_INLINE [[gnu::always_inline]] inline

namespace carus::material {

/// 16 or 8 elements side by side, in single precision, one register of AVX-512 or AVX2; the laws are written once for
/// these and for double. A vector wider than a register is taken apart through memory, at four times the cost.
typedef float Float16 __attribute__((vector_size(64)));
typedef std::int32_t Int16 __attribute__((vector_size(64)));
typedef float Float8 __attribute__((vector_size(32)));
typedef std::int32_t Int8 __attribute__((vector_size(32)));

template <class T>
struct IntOf {};
template <>
struct IntOf<Float16> {
  using type = Int16;
};
template <>
struct IntOf<Float8> {
  using type = Int8;
};
template <class T>
concept Packed = requires {
  typename IntOf<T>::type;
};

template <class T>
struct ScalarOf {
  using type = T;
};
template <Packed T>
struct ScalarOf<T> {
  using type = float;
};
/// The type of a literal that multiplies a T.
template <class T>
using Scalar = typename ScalarOf<T>::type;

template <class T>
CARUS_INLINE T constant(double value) {
  return T{} + static_cast<Scalar<T>>(value);
}

/// x^(-1/3) for x > 0.
CARUS_INLINE double rcbrt(double x) { return 1.0 / std::cbrt(x); }

/// x^(-1/3) for x > 0, relative error < 3e-7. The exponent divided by -3 as an integer is right within 3.5 %; Newton's
/// y <- y + y (1 - x y^3)/3 takes the error e to -2 e^2: 2.4e-3, 1.2e-5, 3e-10. No library call, no division.
template <Packed F>
CARUS_INLINE F rcbrt(F x) {
  using I = typename IntOf<F>::type;
  const F bits = __builtin_convertvector(reinterpret_cast<I>(x), F);
  const I guess = __builtin_convertvector(1419908138.0f - bits * (1.0f / 3.0f), I);
  F y = reinterpret_cast<F>(guess);
  for (int step = 0; step < 3; ++step) y += y * (1.0f - x * y * y * y) * (1.0f / 3.0f);
  return y;
}

/// x^(1/3) for x > 0.
CARUS_INLINE double cbrt(double x) { return std::cbrt(x); }
template <Packed F>
CARUS_INLINE F cbrt(F x) {
  const F y = rcbrt(x);
  return x * y * y;
}

CARUS_INLINE double exp(double x) { return std::exp(x); }

/// e^x for |x| <= 87, relative error < 3e-7; beyond, x is taken at the limit. x = k ln 2 + r, |r| <= ln(2)/2, Taylor to
/// r^7.
template <Packed F>
CARUS_INLINE F exp(F x) {
  using I = typename IntOf<F>::type;
  const F limit = constant<F>(87);
  x = x > limit ? limit : (x < -limit ? -limit : x);
  // Adding and taking away 1.5 * 2^23 rounds to the nearest integer.
  const F k = (x * 1.44269504f + 12582912.0f) - 12582912.0f;
  const F r = (x - k * 0.693359375f) + k * 2.12194440e-4f;  // ln 2 in two parts (Cody and Waite)
  F sum = 1.0f / 720.0f + r * (1.0f / 5040.0f);
  sum = 1.0f / 120.0f + r * sum;
  sum = 1.0f / 24.0f + r * sum;
  sum = 1.0f / 6.0f + r * sum;
  sum = 0.5f + r * sum;
  sum = 1.0f + r * (1.0f + r * sum);
  const I exponent = (__builtin_convertvector(k, I) + 127) << 23;
  return sum * reinterpret_cast<F>(exponent);
}

/// <x> = max(x, 0).
CARUS_INLINE double positive_part(double x) { return x > 0 ? x : 0; }
template <Packed F>
CARUS_INLINE F positive_part(F x) {
  return x > 0 ? x : F{};
}

template <class T>
struct Vec3T {
  T x, y, z;
};
template <class T>
CARUS_INLINE T dot(const Vec3T<T>& a, const Vec3T<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// 3x3 matrix: row i, column j is mij.
template <class T>
struct Mat3T {
  T m00, m01, m02, m10, m11, m12, m20, m21, m22;

  CARUS_INLINE Mat3T& operator+=(const Mat3T& b) {
    return combine(b, [](T& p, const T& q) { p += q; });
  }
  CARUS_INLINE Mat3T& operator-=(const Mat3T& b) {
    return combine(b, [](T& p, const T& q) { p -= q; });
  }
  CARUS_INLINE Mat3T& operator*=(const T& s) {
    return combine(*this, [&s](T& p, const T&) { p *= s; });
  }
  CARUS_INLINE friend Mat3T operator+(Mat3T a, const Mat3T& b) { return a += b; }
  CARUS_INLINE friend Mat3T operator-(Mat3T a, const Mat3T& b) { return a -= b; }
  CARUS_INLINE friend Mat3T operator*(Mat3T a, const T& s) { return a *= s; }
  CARUS_INLINE friend Mat3T operator*(const T& s, Mat3T a) { return a *= s; }

 private:
  template <class Op>
  CARUS_INLINE Mat3T& combine(const Mat3T& b, Op op) {
    op(m00, b.m00), op(m01, b.m01), op(m02, b.m02);
    op(m10, b.m10), op(m11, b.m11), op(m12, b.m12);
    op(m20, b.m20), op(m21, b.m21), op(m22, b.m22);
    return *this;
  }
};

template <class T>
CARUS_INLINE Mat3T<T> identity() {
  const T one = constant<T>(1), o = T{};
  return {one, o, o, o, one, o, o, o, one};
}

/// A + s I.
template <class T>
CARUS_INLINE Mat3T<T> plus_diagonal(Mat3T<T> A, const T& s) {
  A.m00 += s, A.m11 += s, A.m22 += s;
  return A;
}
template <class T>
CARUS_INLINE Mat3T<T> minus_identity(const Mat3T<T>& A) {
  return plus_diagonal(A, constant<T>(-1));
}

template <class T>
CARUS_INLINE Mat3T<T> transpose(const Mat3T<T>& A) {
  return {A.m00, A.m10, A.m20, A.m01, A.m11, A.m21, A.m02, A.m12, A.m22};
}

/// A B.
template <class T>
CARUS_INLINE Mat3T<T> multiply(const Mat3T<T>& A, const Mat3T<T>& B) {
  return {A.m00 * B.m00 + A.m01 * B.m10 + A.m02 * B.m20, A.m00 * B.m01 + A.m01 * B.m11 + A.m02 * B.m21,
          A.m00 * B.m02 + A.m01 * B.m12 + A.m02 * B.m22, A.m10 * B.m00 + A.m11 * B.m10 + A.m12 * B.m20,
          A.m10 * B.m01 + A.m11 * B.m11 + A.m12 * B.m21, A.m10 * B.m02 + A.m11 * B.m12 + A.m12 * B.m22,
          A.m20 * B.m00 + A.m21 * B.m10 + A.m22 * B.m20, A.m20 * B.m01 + A.m21 * B.m11 + A.m22 * B.m21,
          A.m20 * B.m02 + A.m21 * B.m12 + A.m22 * B.m22};
}
/// A^T B.
template <class T>
CARUS_INLINE Mat3T<T> transpose_multiply(const Mat3T<T>& A, const Mat3T<T>& B) {
  return multiply(transpose(A), B);
}
/// A B^T.
template <class T>
CARUS_INLINE Mat3T<T> multiply_transpose(const Mat3T<T>& A, const Mat3T<T>& B) {
  return multiply(A, transpose(B));
}
template <class T>
CARUS_INLINE Vec3T<T> multiply(const Mat3T<T>& A, const Vec3T<T>& v) {
  return {A.m00 * v.x + A.m01 * v.y + A.m02 * v.z, A.m10 * v.x + A.m11 * v.y + A.m12 * v.z,
          A.m20 * v.x + A.m21 * v.y + A.m22 * v.z};
}
template <class T>
CARUS_INLINE Mat3T<T> outer(const Vec3T<T>& a, const Vec3T<T>& b) {
  return {a.x * b.x, a.x * b.y, a.x * b.z, a.y * b.x, a.y * b.y, a.y * b.z, a.z * b.x, a.z * b.y, a.z * b.z};
}

template <class T>
CARUS_INLINE T trace(const Mat3T<T>& A) {
  return A.m00 + A.m11 + A.m22;
}
/// A : B.
template <class T>
CARUS_INLINE T contract(const Mat3T<T>& A, const Mat3T<T>& B) {
  return A.m00 * B.m00 + A.m01 * B.m01 + A.m02 * B.m02 + A.m10 * B.m10 + A.m11 * B.m11 + A.m12 * B.m12 + A.m20 * B.m20 +
         A.m21 * B.m21 + A.m22 * B.m22;
}
template <class T>
CARUS_INLINE Mat3T<T> deviator(const Mat3T<T>& A) {
  return plus_diagonal<T>(A, trace(A) * Scalar<T>(-1.0 / 3.0));
}

/// cof A = det(A) A^-T = d det(A)/dA.
template <class T>
CARUS_INLINE Mat3T<T> cofactor(const Mat3T<T>& A) {
  return {A.m11 * A.m22 - A.m12 * A.m21, A.m12 * A.m20 - A.m10 * A.m22, A.m10 * A.m21 - A.m11 * A.m20,
          A.m02 * A.m21 - A.m01 * A.m22, A.m00 * A.m22 - A.m02 * A.m20, A.m01 * A.m20 - A.m00 * A.m21,
          A.m01 * A.m12 - A.m02 * A.m11, A.m02 * A.m10 - A.m00 * A.m12, A.m00 * A.m11 - A.m01 * A.m10};
}
/// d cof(A) along dA: cof is quadratic, so this is its polarisation, cof(A + dA) - cof(A) - cof(dA).
template <class T>
CARUS_INLINE Mat3T<T> cofactor_rate(const Mat3T<T>& A, const Mat3T<T>& dA) {
  return cofactor<T>(A + dA) - cofactor(A) - cofactor(dA);
}
/// cof(I + H) - I = tr(H) I - H^T + cof H, exact near H = 0.
template <class T>
CARUS_INLINE Mat3T<T> cofactor_minus_identity(const Mat3T<T>& H) {
  return plus_diagonal<T>(cofactor(H) - transpose(H), trace(H));
}

template <class T>
CARUS_INLINE T determinant(const Mat3T<T>& A) {
  return A.m00 * (A.m11 * A.m22 - A.m12 * A.m21) + A.m01 * (A.m12 * A.m20 - A.m10 * A.m22) +
         A.m02 * (A.m10 * A.m21 - A.m11 * A.m20);
}
/// det(I + H) - 1 = tr H + tr cof H + det H, exact near H = 0.
template <class T>
CARUS_INLINE T determinant_minus_one(const Mat3T<T>& H) {
  return trace(H) + trace(cofactor(H)) + determinant(H);
}

/// A^-1; det A must not be 0.
template <class T>
CARUS_INLINE Mat3T<T> inverse(const Mat3T<T>& A) {
  return transpose<T>(cofactor(A)) * T(constant<T>(1) / determinant(A));
}

}  // namespace carus::material
