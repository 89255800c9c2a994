// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Geometry/ExactPredicates.h"

#include "Geometry/Circumball.h"
#include "Geometry/Determinants.h"

#include <CGAL/Exact_rational.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>

#ifndef CGAL_USE_GMP
#error "CGAL needs GMP: without it the doubles that it makes of large fractions are no numbers."
#endif

namespace voxplex
{
namespace
{

__extension__ using Int128 = __int128;
__extension__ using UInt128 = unsigned __int128;

template <class T, int D, int Rows>
using Matrix =
  std::array<std::array<T, static_cast<std::size_t>(D)>, static_cast<std::size_t>(Rows)>;

//------------------------------------------------------------------------------
// Number types. The determinants of Determinants.h are homogeneous, so a type may carry its degree.
// The product of degrees A and B has degree A + B, and a type that is wide enough for its values.

/** Integers: values of degree 1 and 2 have 64 bits, values of higher degree have 128 bits. */
template <int Degree>
struct ShortInteger
{
  using ValueType = std::conditional_t<Degree <= 2, std::int64_t, Int128>;
  ValueType Value;

  friend ShortInteger operator+(ShortInteger a, ShortInteger b) { return { a.Value + b.Value }; }
  friend ShortInteger operator-(ShortInteger a, ShortInteger b) { return { a.Value - b.Value }; }
  int Sign() const { return (this->Value > 0) - (this->Value < 0); }
};

template <int A, int B>
inline ShortInteger<A + B> operator*(ShortInteger<A> a, ShortInteger<B> b)
{
  using Product = typename ShortInteger<A + B>::ValueType;
  return { static_cast<Product>(a.Value) * b.Value };
}

/**
 * Two's complement integers of Words 64-bit words, the least significant word first. With cpp_int of
 * Boost.Multiprecision of the same widths, the predicates take two to three times as long.
 */
template <int Words>
struct WideInteger
{
  std::array<std::uint64_t, static_cast<std::size_t>(Words)> Word;

  friend WideInteger operator+(const WideInteger& a, const WideInteger& b)
  {
    WideInteger r;
    UInt128 carry = 0;
    for (std::size_t i = 0; i < r.Word.size(); ++i)
    {
      carry += static_cast<UInt128>(a.Word[i]) + b.Word[i];
      r.Word[i] = static_cast<std::uint64_t>(carry);
      carry >>= 64;
    }
    return r;
  }

  friend WideInteger operator-(const WideInteger& a, const WideInteger& b)
  {
    WideInteger r;
    std::uint64_t borrow = 0;
    for (std::size_t i = 0; i < r.Word.size(); ++i)
    {
      const UInt128 t = static_cast<UInt128>(a.Word[i]) - b.Word[i] - borrow;
      r.Word[i] = static_cast<std::uint64_t>(t);
      borrow = static_cast<std::uint64_t>(t >> 64) & 1U;
    }
    return r;
  }

  bool IsNegative() const { return (this->Word.back() >> 63) != 0; }

  int Sign() const
  {
    std::uint64_t any = 0;
    for (const std::uint64_t w : this->Word)
    {
      any |= w;
    }
    return any == 0 ? 0 : (this->IsNegative() ? -1 : 1);
  }
};

/** If mask is all ones: r -= b * 2^(64 offset), modulo the width of r. If mask is 0: no change. */
template <std::size_t N, std::size_t M>
inline void SubtractMasked(std::array<std::uint64_t, N>& r, const std::array<std::uint64_t, M>& b,
  std::size_t offset, std::uint64_t mask)
{
  std::uint64_t borrow = 0;
  for (std::size_t i = 0; i < M; ++i)
  {
    const UInt128 t = static_cast<UInt128>(r[offset + i]) - (b[i] & mask) - borrow;
    r[offset + i] = static_cast<std::uint64_t>(t);
    borrow = static_cast<std::uint64_t>(t >> 64) & 1U;
  }
}

/**
 * The exact product. The words are multiplied as unsigned numbers. So a negative operand is read as
 * a number that is 2^(64 words) too large. The end of the function subtracts this error.
 */
template <int A, int B>
inline WideInteger<A + B> operator*(const WideInteger<A>& a, const WideInteger<B>& b)
{
  WideInteger<A + B> r;
  r.Word.fill(0);
  for (std::size_t i = 0; i < a.Word.size(); ++i)
  {
    std::uint64_t carry = 0;
    for (std::size_t j = 0; j < b.Word.size(); ++j)
    {
      const UInt128 t = static_cast<UInt128>(a.Word[i]) * b.Word[j] + r.Word[i + j] + carry;
      r.Word[i + j] = static_cast<std::uint64_t>(t);
      carry = static_cast<std::uint64_t>(t >> 64);
    }
    r.Word[i + b.Word.size()] = carry;
  }
  SubtractMasked(r.Word, b.Word, a.Word.size(), a.IsNegative() ? ~std::uint64_t{ 0 } : 0);
  SubtractMasked(r.Word, a.Word, b.Word.size(), b.IsNegative() ? ~std::uint64_t{ 0 } : 0);
  return r;
}

/**
 * CGAL's rationals without expression templates: with `auto` these would keep dangling references.
 */
struct Rational
{
  CGAL::Exact_rational Value;

  friend Rational operator+(const Rational& a, const Rational& b) { return { a.Value + b.Value }; }
  friend Rational operator-(const Rational& a, const Rational& b) { return { a.Value - b.Value }; }
  friend Rational operator*(const Rational& a, const Rational& b) { return { a.Value * b.Value }; }
  int Sign() const { return static_cast<int>(CGAL::sign(this->Value)); }
};

//------------------------------------------------------------------------------
// Conversion from doubles to integers.

/** |x| = Mantissa * 2^Exponent with an odd mantissa. If x is 0, the mantissa is 0. */
struct OddForm
{
  std::uint64_t Mantissa;
  int Exponent;
};

inline OddForm Decode(double x)
{
  const std::uint64_t bits = std::bit_cast<std::uint64_t>(x);
  const int biased = static_cast<int>((bits >> 52) & 0x7ffU);
  const std::uint64_t fraction = bits & 0xfffffffffffffULL;
  const std::uint64_t mantissa = biased != 0 ? fraction | 0x10000000000000ULL : fraction;
  const int zeros = std::countr_zero(mantissa) & 63; // 0 for zero
  return { mantissa >> zeros, std::max(biased, 1) - 1075 + zeros };
}

/** The range of bit positions from the lowest to the highest bit that is set in any number. */
struct BitSpan
{
  int Lowest = std::numeric_limits<int>::max();
  int End = std::numeric_limits<int>::min();
  int Bits() const { return this->End > this->Lowest ? this->End - this->Lowest : 0; }
};

/** Has no branches on the numbers: on a lattice, zeros among the differences are unpredictable. */
template <std::size_t D, std::size_t Rows>
BitSpan SpanOf(const std::array<std::array<double, D>, Rows>& m)
{
  BitSpan span;
  for (const auto& row : m)
  {
    for (const double x : row)
    {
      const OddForm odd = Decode(x);
      const bool zero = odd.Mantissa == 0;
      const int end = odd.Exponent + static_cast<int>(std::bit_width(odd.Mantissa));
      span.Lowest = std::min(span.Lowest, zero ? std::numeric_limits<int>::max() : odd.Exponent);
      span.End = std::max(span.End, zero ? std::numeric_limits<int>::min() : end);
    }
  }
  return span;
}

/** x / 2^lowest. The result is an integer of at most CoordinateBits bits. */
inline Int128 ToInt128(double x, int lowest)
{
  const OddForm odd = Decode(x);
  const int shift = odd.Mantissa != 0 ? odd.Exponent - lowest : 0;
  const Int128 magnitude = static_cast<Int128>(odd.Mantissa) << shift;
  return x < 0.0 ? -magnitude : magnitude;
}

/** Number of bits of the largest |integer| of the matrix. */
template <std::size_t D, std::size_t Rows>
int BitsOf(const std::array<std::array<Int128, D>, Rows>& m)
{
  UInt128 any = 0;
  for (const auto& row : m)
  {
    for (const Int128 x : row)
    {
      any |= static_cast<UInt128>(x < 0 ? -x : x);
    }
  }
  const std::uint64_t high = static_cast<std::uint64_t>(any >> 64);
  return high != 0 ? 64 + static_cast<int>(std::bit_width(high))
                   : static_cast<int>(std::bit_width(static_cast<std::uint64_t>(any)));
}

//------------------------------------------------------------------------------
// The two polynomials as policies. Sign() computes the sign from the rows of differences. If
// |differences| have at most ShortBits bits, ShortInteger holds every intermediate value.

/** det of the rows. If |entry| < 2^B, |det| <= D! 2^DB, which is < 2^(3B + 2.6), < 2^(4B + 4.6). */
template <int D>
struct OrientationPolynomial
{
  static constexpr int Rows = D;
  static constexpr int ShortBits = D == 3 ? 31 : 30; // 64-bit minors: 2B + 1 <= 63

  template <class Number>
  static int Sign(const Matrix<Number, D, Rows>& rows)
  {
    return Determinant(rows).Sign();
  }
};

/**
 * det of the rows (row, |row|^2). If |entry| < 2^B, |det| <= (D + 1)! D 2^((D + 2) B), which is
 * < 2^(5B + 6.2) in 3D and < 2^(6B + 9) in 4D.
 */
template <int D>
struct InSpherePolynomial
{
  static constexpr int Rows = D + 1;
  static constexpr int ShortBits = D == 3 ? 24 : 19; // 5B + 6.2 and 6B + 9 < 127

  template <class Number>
  static int Sign(const Matrix<Number, D, Rows>& rows)
  {
    std::array<decltype(SquaredNorm(rows[0])), static_cast<std::size_t>(Rows)> lifts;
    for (std::size_t i = 0; i < lifts.size(); ++i)
    {
      lifts[i] = SquaredNorm(rows[i]);
    }
    // If the base point is inside, the determinant is negative in odd dimensions.
    const int sign = LiftedDeterminant(rows, lifts).Sign();
    return D % 2 == 0 ? sign : -sign;
  }
};

/**
 * Largest B such that 64 k bits hold all values of degree k if |entry| < 2^B. Degree 2 is the
 * tightest: 4 (2^62)^2 = 2^126 < 2^127. The other degrees k need 3B + 2.6, 4B + 4.6, 5B + 6.2 and
 * 6B + 9 < 64 k - 1. With twice the number of words the limit is 126 bits.
 */
constexpr int WideBits = 62;

/** Coordinates of at most this number of bits are subtracted in 128-bit integers. */
constexpr int CoordinateBits = 125;

/** Copies a matrix, and converts its number type. */
template <class To, class From, std::size_t D, std::size_t Rows, class Convert>
std::array<std::array<To, D>, Rows> Converted(
  const std::array<std::array<From, D>, Rows>& from, Convert convert)
{
  std::array<std::array<To, D>, Rows> to;
  for (std::size_t i = 0; i < Rows; ++i)
  {
    for (std::size_t j = 0; j < D; ++j)
    {
      to[i][j] = convert(from[i][j]);
    }
  }
  return to;
}

/** Sign of the polynomial for integer differences of at most the given number of bits (<= 126). */
template <template <int> class Polynomial, int D, class Integer, std::size_t Rows>
int SignOfIntegers(
  const std::array<std::array<Integer, static_cast<std::size_t>(D)>, Rows>& m, int bits)
{
  if (bits <= Polynomial<D>::ShortBits)
  {
    return Polynomial<D>::Sign(Converted<ShortInteger<1>>(
      m, [](Integer x) { return ShortInteger<1>{ static_cast<std::int64_t>(x) }; }));
  }
  if (bits <= WideBits)
  {
    return Polynomial<D>::Sign(Converted<WideInteger<1>>(
      m, [](Integer x) { return WideInteger<1>{ { static_cast<std::uint64_t>(x) } }; }));
  }
  return Polynomial<D>::Sign(Converted<WideInteger<2>>(m,
    [](Integer x)
    {
      const UInt128 u = static_cast<UInt128>(static_cast<Int128>(x));
      return WideInteger<2>{ { static_cast<std::uint64_t>(u),
        static_cast<std::uint64_t>(u >> 64) } };
    }));
}

/** a - b in double. If the result was rounded, `exact` is set to false (Knuth's two-sum). */
inline double TwoDifference(double a, double b, bool& exact)
{
  const double x = a - b;
  const double virtualB = a - x;
  const double virtualA = x + virtualB;
  const double tail = (a - virtualA) + (virtualB - b);
  exact = exact && tail == 0.0;
  return x;
}

/** Sign of the polynomial for the rows points[i] - base. */
template <template <int> class Polynomial, int D>
int SignOfPolynomial(const Point<D>* const* points, const Point<D>& base)
{
  constexpr int Rows = Polynomial<D>::Rows;
  constexpr std::size_t RowCount = static_cast<std::size_t>(Rows);
  constexpr std::size_t Columns = static_cast<std::size_t>(D);

  // 1. The differences are exact in double.
  Matrix<double, D, Rows> differences;
  bool exact = true;
  for (std::size_t i = 0; i < RowCount; ++i)
  {
    for (std::size_t j = 0; j < Columns; ++j)
    {
      differences[i][j] = TwoDifference((*points[i])[j], base[j], exact);
    }
  }
  if (exact)
  {
    const BitSpan span = SpanOf(differences);
    if (span.Bits() <= WideBits && span.Lowest >= -1000 && span.End <= 1000)
    {
      const double scale = std::ldexp(1.0, -span.Lowest); // the products are exact
      const auto integers = Converted<std::int64_t>(
        differences, [scale](double x) { return static_cast<std::int64_t>(x * scale); });
      return SignOfIntegers<Polynomial, D>(integers, span.Bits());
    }
  }

  // 2. The coordinates become integers.
  Matrix<double, D, Rows + 1> coordinates;
  coordinates[RowCount] = base;
  for (std::size_t i = 0; i < RowCount; ++i)
  {
    coordinates[i] = *points[i];
  }
  const BitSpan span = SpanOf(coordinates);
  if (span.Bits() <= CoordinateBits)
  {
    const int lowest = span.Lowest;
    Matrix<Int128, D, Rows> integers;
    for (std::size_t j = 0; j < Columns; ++j)
    {
      const Int128 origin = ToInt128(base[j], lowest);
      for (std::size_t i = 0; i < RowCount; ++i)
      {
        integers[i][j] = ToInt128(coordinates[i][j], lowest) - origin;
      }
    }
    return SignOfIntegers<Polynomial, D>(integers, BitsOf(integers));
  }

  // 3. Rationals, for any doubles.
  Matrix<Rational, D, Rows> rationals;
  for (std::size_t i = 0; i < RowCount; ++i)
  {
    for (std::size_t j = 0; j < Columns; ++j)
    {
      rationals[i][j].Value =
        CGAL::Exact_rational(coordinates[i][j]) - CGAL::Exact_rational(base[j]);
    }
  }
  return Polynomial<D>::Sign(rationals);
}

} // namespace

//------------------------------------------------------------------------------
template <int D>
int ExactOrientation(const Point<D>* const* points)
{
  return SignOfPolynomial<OrientationPolynomial, D>(points + 1, *points[0]);
}

//------------------------------------------------------------------------------
template <int D>
int ExactInSphere(const Point<D>* const* simplex, const Point<D>& p)
{
  return SignOfPolynomial<InSpherePolynomial, D>(simplex, p);
}

//------------------------------------------------------------------------------
template <int D>
bool RoundedExactCircumball(const Point<D>* const* simplex, Circumball<D>& ball)
{
  constexpr std::size_t Columns = static_cast<std::size_t>(D);
  Matrix<Rational, D, D> edges;
  std::array<Rational, Columns> lifts;
  for (std::size_t i = 0; i < Columns; ++i)
  {
    for (std::size_t j = 0; j < Columns; ++j)
    {
      edges[i][j].Value =
        CGAL::Exact_rational((*simplex[i + 1])[j]) - CGAL::Exact_rational((*simplex[0])[j]);
    }
    lifts[i] = SquaredNorm(edges[i]);
  }
  const Rational determinant = Determinant(edges);
  if (determinant.Sign() == 0)
  {
    return false;
  }
  // Cramer's rule: edges . c = lifts / 2.
  const CGAL::Exact_rational twice = determinant.Value + determinant.Value;
  CGAL::Exact_rational radius2(0);
  for (std::size_t k = 0; k < Columns; ++k)
  {
    Matrix<Rational, D, D> replaced = edges;
    for (std::size_t i = 0; i < Columns; ++i)
    {
      replaced[i][k] = lifts[i];
    }
    const CGAL::Exact_rational c = Determinant(replaced).Value / twice;
    radius2 += c * c;
    ball.Center[k] = CGAL::to_double(CGAL::Exact_rational(c + (*simplex[0])[k]));
  }
  ball.Radius2 = CGAL::to_double(radius2);
  return true;
}

template int ExactOrientation<3>(const Point<3>* const*);
template int ExactOrientation<4>(const Point<4>* const*);
template int ExactInSphere<3>(const Point<3>* const*, const Point<3>&);
template int ExactInSphere<4>(const Point<4>* const*, const Point<4>&);
template bool RoundedExactCircumball<3>(const Point<3>* const*, Circumball<3>&);
template bool RoundedExactCircumball<4>(const Point<4>* const*, Circumball<4>&);

} // namespace voxplex
