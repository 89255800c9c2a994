// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Predicates against an independent reference: determinants by naive expansion in Boost's integers
 * of any size. Every random test prints its seed; VOXPLEX_TEST_SEED repeats a run.
 */
#include "Geometry/Predicates.h"
#include "PredicateTesting.h"
#include "Sanitizers.h"
#include "TriangulationChecks.h"

#include <gtest/gtest.h>

#include <boost/multiprecision/cpp_int.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <random>
#include <set>
#include <string>
#include <vector>

using namespace voxplex;
using namespace voxplex::predicatetesting;

namespace
{

using Integer = boost::multiprecision::cpp_int;

//------------------------------------------------------------------------------
// The reference.

/** Determinant by expansion along the first row. */
Integer NaiveDeterminant(const std::vector<std::vector<Integer>>& m)
{
  if (m.size() == 1)
  {
    return m[0][0];
  }
  Integer sum = 0;
  for (std::size_t k = 0; k < m.size(); ++k)
  {
    if (m[0][k] == 0)
    {
      continue;
    }
    std::vector<std::vector<Integer>> minor;
    for (std::size_t i = 1; i < m.size(); ++i)
    {
      minor.push_back(m[i]);
      minor.back().erase(minor.back().begin() + static_cast<std::ptrdiff_t>(k));
    }
    const Integer term = m[0][k] * NaiveDeterminant(minor);
    sum += k % 2 == 0 ? term : Integer(-term);
  }
  return sum;
}

/** Coordinates times a common power of two that makes them integers. */
template <int D>
std::vector<std::vector<Integer>> AsIntegers(const std::vector<Point<D>>& points)
{
  int lowest = 0;
  for (const Point<D>& p : points)
  {
    for (const double x : p)
    {
      if (x != 0.0)
      {
        int exponent = 0;
        std::frexp(x, &exponent);
        lowest = std::min(lowest, exponent - 53);
      }
    }
  }
  std::vector<std::vector<Integer>> integers;
  for (const Point<D>& p : points)
  {
    integers.emplace_back();
    for (const double x : p)
    {
      int exponent = 0;
      const double mantissa = std::frexp(x, &exponent);
      Integer value(static_cast<std::int64_t>(std::ldexp(mantissa, 53)));
      if (x != 0.0)
      {
        value <<= static_cast<unsigned>(exponent - 53 - lowest);
      }
      integers.back().push_back(value);
    }
  }
  return integers;
}

template <int D>
int ReferenceOrientation(const std::vector<Point<D>>& points)
{
  std::vector<std::vector<Integer>> rows = AsIntegers<D>(points);
  for (std::size_t i = 1; i < rows.size(); ++i)
  {
    for (std::size_t j = 0; j < rows[i].size(); ++j)
    {
      rows[i][j] -= rows[0][j];
    }
  }
  rows.erase(rows.begin());
  return NaiveDeterminant(rows).sign();
}

/**
 * In-sphere for either orientation: p is inside when its lifted point lies under the hyperplane of
 * the others. The determinant of the rows (x, 1, lift) is linear in the lift of p, the last row,
 * with the cofactor det(x, 1) of the simplex: so p is inside when the two have opposite signs.
 * @param epsilons D + 2 numbers to take for the lifts' perturbation where the points are
 * co-spherical
 */
template <int D>
int ReferenceInSphere(
  const std::vector<Point<D>>& points, const std::vector<Integer>* epsilons = nullptr)
{
  std::vector<std::vector<Integer>> rows = AsIntegers<D>(points);
  for (std::size_t i = 0; i < rows.size(); ++i)
  {
    Integer lift = 0;
    for (const Integer& x : rows[i])
    {
      lift += x * x;
    }
    if (epsilons != nullptr)
    {
      lift += (*epsilons)[i];
    }
    rows[i].emplace_back(1);
    rows[i].push_back(lift);
  }
  std::vector<std::vector<Integer>> cofactor(rows.begin(), rows.end() - 1);
  for (std::vector<Integer>& row : cofactor)
  {
    row.pop_back();
  }
  return -NaiveDeterminant(rows).sign() * NaiveDeterminant(cofactor).sign();
}

/**
 * The perturbation in numbers, for co-spherical points. The determinant is then the sum of eps_i
 * times orientations of D + 1 of the points; from one point to the next in lexicographic order eps
 * grows by more than twice D + 2 times the largest such orientation.
 */
template <int D>
int ReferencePerturbed(const std::vector<Point<D>>& points)
{
  unsigned bits = 0;
  for (const std::vector<Integer>& row : AsIntegers<D>(points))
  {
    for (const Integer& x : row)
    {
      bits = x == 0 ? bits : std::max(bits, static_cast<unsigned>(msb(abs(x))) + 1);
    }
  }
  const unsigned step = static_cast<unsigned>(D) * (bits + 1) + 12;
  std::vector<std::size_t> order(points.size());
  for (std::size_t i = 0; i < order.size(); ++i)
  {
    order[i] = i;
  }
  std::sort(order.begin(), order.end(),
    [&points](std::size_t a, std::size_t b) { return points[a] < points[b]; });
  std::vector<Integer> epsilons(points.size());
  for (std::size_t rank = 0; rank < order.size(); ++rank)
  {
    epsilons[order[rank]] = Integer(1) << step * static_cast<unsigned>(rank);
  }
  return ReferenceInSphere<D>(points, &epsilons);
}

//------------------------------------------------------------------------------
// Families of points.

template <int D>
struct Family
{
  std::string Name;
  std::function<Point<D>()> Make;
  double Extent; ///< coordinates lie in [-Extent, Extent]
};

template <int D>
std::vector<Family<D>> Families(std::mt19937_64& engine)
{
  const auto uniform = [&engine](double low, double high)
  { return std::uniform_real_distribution<double>(low, high)(engine); };
  const auto random = [uniform](double center, double half)
  {
    return [uniform, center, half]
    { return checks::Drawn<D>([&] { return uniform(center - half, center + half); }); };
  };
  const auto lattice = [&engine](int size, double spacing, double origin)
  {
    return [&engine, size, spacing, origin]
    {
      return checks::Drawn<D>([&]
        { return origin + spacing * static_cast<double>(engine() % static_cast<unsigned>(size)); });
    };
  };
  // Lattice points. Some of their coordinates are moved by up to two units in the last place.
  const auto perturbed = [&engine](std::function<Point<D>()> make)
  {
    return [&engine, make]
    {
      Point<D> p = make();
      for (double& x : p)
      {
        const unsigned choice = static_cast<unsigned>(engine() % 8);
        const double target = choice % 2 == 0 ? 1e9 : -1e9;
        for (unsigned i = 0; i < choice / 2 && choice < 6; ++i)
        {
          x = std::nextafter(x, target);
        }
      }
      return p;
    };
  };
  const auto flattened = [random, &engine](double thickness)
  {
    return [make = random(0.0, 1.0), thickness, &engine]
    {
      Point<D> p = make();
      p[engine() % 16 == 0 ? 0 : 1] *= thickness;
      return p;
    };
  };
  const auto onSphere = [random](double radius)
  {
    return [make = random(0.0, 1.0), radius]
    {
      Point<D> p = make();
      const double factor = radius / std::sqrt(Dot(p, p));
      for (double& x : p)
      {
        x *= factor;
      }
      return p;
    };
  };
  const auto onPlane = [random]
  {
    return [make = random(0.0, 1.0)]
    {
      Point<D> p = make();
      p[0] = 0.3 * p[1] - 0.4 * p[2] + 0.1;
      return p;
    };
  };
  const auto bits = [&engine](int count)
  {
    return [&engine, count]
    {
      return checks::Drawn<D>(
        [&] { return std::ldexp(static_cast<double>(engine() >> (64 - count)), -20); });
    };
  };
  std::vector<Family<D>> families = {
    { "random", random(0.0, 1.0), 1.0 },
    { "random, small in a large box", random(300.0, 0.01), 512.0 },
    { "random, far from the origin", random(1e6, 1e-3), 2e6 },
    { "lattice 2", lattice(2, 1.0, 0.0), 4.0 },
    { "lattice 3", lattice(3, 0.5, -7.0), 256.0 },
    { "lattice 4 of 0.277", lattice(4, 0.277, 0.0), 200.0 },
    { "lattice 2 of 0.1", lattice(2, 0.1, 0.1), 1.0 },
    { "lattice 3 of 0.1 at 27.7", lattice(3, 0.1, 27.7), 64.0 },
    { "lattice 2, last places moved", perturbed(lattice(2, 1.0, 1.0)), 4.0 },
    { "lattice 3 of 0.277, last places moved", perturbed(lattice(3, 0.277, 5.0)), 64.0 },
    { "lattice 3 around zero, last places moved", perturbed(lattice(3, 1.0, -1.0)), 4.0 },
    { "nearly flat, 1e-9", flattened(1e-9), 1.0 },
    { "nearly flat, 1e-40", flattened(1e-40), 1.0 },
    { "nearly flat, 1e-300", flattened(1e-300), 1.0 },
    { "on a sphere as large as the box", onSphere(1.0), 1.0 },
    { "on a sphere in a large box", onSphere(0.1), 1.0 },
    { "on a plane across the box", onPlane(), 1.0 },
  };
  // Around the widths where the exact stages change hands.
  for (const int count : { 16, 19, 20, 21, 22, 24, 25, 26, 27, 30, 31, 32, 33, 34, 53, 62, 63, 64 })
  {
    families.push_back(
      { std::to_string(count) + " bits", bits(count), std::ldexp(1.0, count - 20) });
  }
  return families;
}

/** D + 2 points of a family, the first D + 1 of them positively oriented; false after many flat
 * ones. */
template <int D>
bool MakeCase(const Family<D>& family, std::vector<Point<D>>& points)
{
  for (int attempt = 0; attempt < 200; ++attempt)
  {
    std::set<Point<D>> distinct;
    while (distinct.size() < static_cast<std::size_t>(D + 2))
    {
      distinct.insert(family.Make());
    }
    points.assign(distinct.begin(), distinct.end());
    // A set is sorted; the order of the points must be any.
    std::mt19937_64 shuffle(static_cast<std::uint64_t>(attempt) + distinct.size() +
      static_cast<std::uint64_t>(std::abs((*distinct.begin())[0]) * 1e6));
    std::shuffle(points.begin(), points.end(), shuffle);
    const int orientation =
      ReferenceOrientation<D>(std::vector<Point<D>>(points.begin(), points.end() - 1));
    if (orientation < 0)
    {
      std::swap(points[0], points[1]);
    }
    if (orientation != 0)
    {
      return true;
    }
  }
  return false;
}

template <int D>
Predicates<D> MakePredicates(double extent)
{
  Point<D> min;
  Point<D> max;
  min.fill(-extent);
  max.fill(extent);
  return Predicates<D>(min, max);
}

} // namespace

//------------------------------------------------------------------------------
template <class T>
class PredicatesTest : public RandomTest<T>
{
};
TYPED_TEST_SUITE(PredicatesTest, Dimensions);

TEST(FloatingPoint, IsStrictHere)
{
  EXPECT_TRUE(FloatingPointIsStrict());
}

//------------------------------------------------------------------------------
TYPED_TEST(PredicatesTest, AgreeWithReference)
{
  constexpr int D = TypeParam::value;
  for (const Family<D>& family : Families<D>(this->Engine))
  {
    SCOPED_TRACE(family.Name);
    Predicates<D> predicates = MakePredicates<D>(family.Extent);
    std::map<int, int> signs;
    for (int round = 0; round < (D == 3 ? 400 : 120) / (Sanitized ? 4 : 1); ++round)
    {
      std::vector<Point<D>> points;
      ASSERT_TRUE(MakeCase<D>(family, points));
      const auto simplex = Pointers<D>(points);
      const Point<D>& p = points.back();

      const int inSphere = ReferenceInSphere<D>(points);
      ++signs[inSphere];
      ASSERT_EQ(ExactInSphere<D>(simplex.data(), p), inSphere) << Print<D>(points);
      ASSERT_EQ(predicates.InSphere(simplex.data(), p), inSphere) << Print<D>(points);

      ASSERT_EQ(ExactOrientation<D>(simplex.data()), 1) << Print<D>(points);
      ASSERT_EQ(predicates.Orientation(simplex.data()), 1) << Print<D>(points);
      // Any other D + 1 of the points, which may be flat or negative.
      const std::vector<Point<D>> others(points.begin() + 1, points.end());
      const auto other = Pointers<D>(others);
      const int orientation = ReferenceOrientation<D>(others);
      ASSERT_EQ(ExactOrientation<D>(other.data()), orientation) << Print<D>(others);
      ASSERT_EQ(predicates.Orientation(other.data()), orientation) << Print<D>(others);

      const bool conflict = predicates.InSpherePerturbed(simplex.data(), p);
      if (inSphere != 0)
      {
        ASSERT_EQ(conflict, inSphere > 0) << Print<D>(points);
      }
      else
      {
        ASSERT_EQ(conflict, ReferencePerturbed<D>(points) > 0) << Print<D>(points);
      }
    }
    if (family.Name == "lattice 2")
    {
      EXPECT_GT(signs[0], 0); // the family that is there for ties has ties
    }
  }
}

//------------------------------------------------------------------------------
TYPED_TEST(PredicatesTest, PerturbationDependsOnThePointsAlone)
{
  constexpr int D = TypeParam::value;
  const Family<D> family = Families<D>(this->Engine)[3];
  Predicates<D> predicates = MakePredicates<D>(family.Extent);
  for (int round = 0; round < 50; ++round)
  {
    std::vector<Point<D>> points;
    ASSERT_TRUE(MakeCase<D>(family, points));
    const Point<D> p = points.back();
    points.pop_back();
    const bool conflict = predicates.InSpherePerturbed(Pointers<D>(points).data(), p);
    std::sort(points.begin(), points.end());
    do
    {
      const auto simplex = Pointers<D>(points);
      if (predicates.Orientation(simplex.data()) > 0)
      {
        ASSERT_EQ(predicates.InSpherePerturbed(simplex.data(), p), conflict);
      }
      else
      {
        ASSERT_EQ(predicates.Orientation(simplex.data()), -1);
      }
    } while (std::next_permutation(points.begin(), points.end()));
  }
}

//------------------------------------------------------------------------------
// Two simplices on the two sides of a facet: each is in conflict with the other's apex or none is.
TYPED_TEST(PredicatesTest, ConflictAcrossAFacetIsMutual)
{
  constexpr int D = TypeParam::value;
  const std::vector<Family<D>> families = Families<D>(this->Engine);
  int ties = 0;
  for (const std::size_t which : { 3U, 4U, 8U })
  {
    Predicates<D> predicates = MakePredicates<D>(families[which].Extent);
    for (int round = 0; round < 200; ++round)
    {
      std::vector<Point<D>> points;
      ASSERT_TRUE(MakeCase<D>(families[which], points));
      for (int i = 0; i <= D; ++i)
      {
        // The simplex with vertex i replaced by p, if p lies beyond the facet opposite to vertex i.
        std::vector<Point<D>> mirrored = points;
        std::swap(mirrored[static_cast<std::size_t>(i)], mirrored.back());
        const auto simplex = Pointers<D>(points);
        if (predicates.Orientation(Pointers<D>(mirrored).data()) >= 0)
        {
          continue;
        }
        std::swap(mirrored[0], mirrored[1]); // positively oriented again
        ties += predicates.InSphere(simplex.data(), points.back()) == 0;
        ASSERT_EQ(predicates.InSpherePerturbed(simplex.data(), points.back()),
          predicates.InSpherePerturbed(Pointers<D>(mirrored).data(), mirrored.back()))
          << Print<D>(points);
      }
    }
  }
  EXPECT_GT(ties, 0);
}

//------------------------------------------------------------------------------
namespace
{

/**
 * The simplices of a set of points that no other point conflicts with, found by brute force, must
 * fill the convex hull exactly once: their volumes add up to it, and no facet has two simplices on
 * one side.
 */
template <int D>
void ExpectPerturbedDelaunayFills(const std::vector<Point<D>>& points, double extent, double volume)
{
  Predicates<D> predicates = MakePredicates<D>(extent);
  double filled = 0.0;
  // Facets, as the sorted indices of their vertices, with the side that a simplex lies on.
  std::map<std::vector<std::size_t>, std::set<int>> sides;
  std::vector<bool> chosen(points.size(), false);
  std::fill_n(chosen.begin(), D + 1, true);
  do
  {
    std::vector<std::size_t> index;
    std::vector<Point<D>> vertices;
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      if (chosen[i])
      {
        index.push_back(i);
        vertices.push_back(points[i]);
      }
    }
    const int orientation = predicates.Orientation(Pointers<D>(vertices).data());
    if (orientation == 0)
    {
      continue;
    }
    if (orientation < 0)
    {
      std::swap(vertices[0], vertices[1]);
    }
    const auto simplex = Pointers<D>(vertices);
    bool delaunay = true;
    for (std::size_t i = 0; i < points.size() && delaunay; ++i)
    {
      delaunay = chosen[i] || !predicates.InSpherePerturbed(simplex.data(), points[i]);
    }
    if (!delaunay)
    {
      continue;
    }
    std::array<Point<D>, static_cast<std::size_t>(D)> edges;
    for (std::size_t i = 0; i < edges.size(); ++i)
    {
      edges[i] = Subtract(vertices[i + 1], vertices[0]);
    }
    filled += Determinant(edges);
    for (std::size_t i = 0; i < index.size(); ++i)
    {
      std::vector<std::size_t> facet = index;
      facet.erase(facet.begin() + static_cast<std::ptrdiff_t>(i));
      // The side of the facet: the orientation with the apex first, vertices in index order.
      const int side = (i % 2 == 0 ? 1 : -1) * orientation;
      EXPECT_TRUE(sides[facet].insert(side).second) << "two simplices on one side of a facet";
    }
  } while (std::prev_permutation(chosen.begin(), chosen.end()));
  EXPECT_NEAR(filled, volume * (D == 3 ? 6.0 : 24.0), 1e-9 * volume);
}

template <int D>
std::vector<Point<D>> LatticePoints(int size, double spacing, double origin)
{
  std::vector<Point<D>> points(1);
  for (std::size_t axis = 0; axis < static_cast<std::size_t>(D); ++axis)
  {
    std::vector<Point<D>> more;
    for (const Point<D>& p : points)
    {
      for (int i = 0; i < size; ++i)
      {
        more.push_back(p);
        more.back()[axis] = origin + spacing * i;
      }
    }
    points = more;
  }
  return points;
}

} // namespace

TYPED_TEST(PredicatesTest, PerturbedDelaunayFillsACubeOnce)
{
  constexpr int D = TypeParam::value;
  for (const double spacing : { 1.0, 0.1, 0.277 })
  {
    for (const double origin : { 0.0, -5.0, 27.7 })
    {
      SCOPED_TRACE(testing::Message() << "spacing " << spacing << ", origin " << origin);
      std::vector<Point<D>> points = LatticePoints<D>(2, spacing, origin);
      std::shuffle(points.begin(), points.end(), this->Engine);
      const double edge = (origin + spacing) - origin;
      ExpectPerturbedDelaunayFills<D>(points, 32.0, std::pow(edge, D));
    }
  }
}

TEST(Predicates3, PerturbedDelaunayFillsALatticeOnce)
{
  ExpectPerturbedDelaunayFills<3>(LatticePoints<3>(3, 1.0, 0.0), 8.0, 8.0);
}

//------------------------------------------------------------------------------
TYPED_TEST(PredicatesTest, StatisticsCount)
{
  constexpr int D = TypeParam::value;
  Predicates<D> predicates = MakePredicates<D>(1.0);
  std::vector<Point<D>> corner(1);
  corner[0].fill(0.0);
  for (std::size_t i = 0; i < static_cast<std::size_t>(D); ++i)
  {
    corner.push_back(corner[0]);
    corner.back()[i] = 1.0;
  }
  const auto simplex = Pointers<D>(corner);
  Point<D> inside;
  inside.fill(0.25);
  Point<D> onSphere;
  onSphere.fill(1.0);

  EXPECT_EQ(predicates.InSphere(simplex.data(), inside), 1);
  const PredicateStatistics& counted = predicates.GetStatistics();
  EXPECT_EQ(counted.Calls, 1U);
  EXPECT_EQ(counted.StaticFailures, 0U);
  EXPECT_EQ(counted.ExactCalls, 0U);

  EXPECT_EQ(predicates.InSphere(simplex.data(), onSphere), 0);
  EXPECT_EQ(counted.Calls, 2U);
  EXPECT_EQ(counted.StaticFailures, 1U);
  EXPECT_EQ(counted.ExactCalls, 1U);
  EXPECT_EQ(counted.Perturbed, 0U);

  EXPECT_FALSE(predicates.InSpherePerturbed(simplex.data(), onSphere)); // it is the largest point
  EXPECT_EQ(counted.Perturbed, 1U);

  // A simplex a thousand times smaller than the box: the semi-static stage decides.
  std::vector<Point<D>> small = corner;
  for (Point<D>& p : small)
  {
    for (double& x : p)
    {
      x *= 1e-4;
    }
  }
  inside.fill(0.25e-4);
  predicates.GetStatistics() = PredicateStatistics();
  EXPECT_EQ(predicates.InSphere(Pointers<D>(small).data(), inside), 1);
  EXPECT_EQ(counted.StaticFailures, 1U);
  EXPECT_EQ(counted.ExactCalls, 0U);
}

//------------------------------------------------------------------------------
// The filters must neither be useless nor, with a bound that is too small, lie; the latter shows in
// AgreeWithReference. A bound that is ten times too large would show here.
TYPED_TEST(PredicatesTest, FiltersDecideRandomPoints)
{
  constexpr int D = TypeParam::value;
  const std::vector<Family<D>> families = Families<D>(this->Engine);
  for (const std::size_t which : { 0U, 1U, 2U })
  {
    Predicates<D> predicates = MakePredicates<D>(families[which].Extent);
    for (int round = 0; round < 1000; ++round)
    {
      std::vector<Point<D>> points;
      for (int i = 0; i < D + 2; ++i)
      {
        points.push_back(families[which].Make());
      }
      predicates.Orientation(Pointers<D>(points).data());
    }
    EXPECT_LE(predicates.GetStatistics().ExactCalls, 1U) << families[which].Name;
    if (which == 0)
    {
      EXPECT_LE(predicates.GetStatistics().StaticFailures, 1U);
    }
  }
}
