// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PieceShapes.h
 * @brief Internal to OpenRidges: how good the shapes of pieces are.
 */
#ifndef voxplex_PieceShapes_h
#define voxplex_PieceShapes_h

#include "Geometry/ExactPredicates.h"
#include "Geometry/SimplexQuality.h"
#include "Optimisation/Patch.h"
#include "Sizing/SizingField.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace voxplex::opening
{

/**
 * Shapes with these values count as equally good: angles of tetrahedra and of interfaces in
 * degrees, normalized volumes of pentatopes, and the radius-edge ratio.
 */
constexpr double GoodDihedralAngle = 9.0;
constexpr double GoodFacetAngle = 20.0;
constexpr double GoodNormalizedVolume = 0.05;
constexpr double GoodRadiusEdgeRatio = 2.5;

/**
 * Scores are the sine of an angle over that of a good angle, a volume over a good one, or a good
 * ratio over a ratio. A smaller score may be due to rounding in 3D. In 4D the signs of volumes are
 * exact, and slivers can be flatter.
 */
template <int D>
constexpr double SmallestScore = D == 3 ? 1e-6 : 0.0;

/** A larger volume, over the fourth power of the longest edge at a vertex, has the right sign. */
constexpr double CertainVolume = 1e-13;

/** Whether a simplex is positively oriented; in 4D this is exact. */
inline bool IsPositive(const std::array<const Point<3>*, 4>& points)
{
  return SignedVolume<3>(points.data()) > 0.0;
}

inline bool IsPositive(const std::array<const Point<4>*, 5>& points)
{
  double longest2 = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i)
  {
    longest2 = std::max(longest2, Distance2(*points[0], *points[i]));
  }
  const double volume = SignedVolume<4>(points.data());
  return std::abs(volume) > CertainVolume * longest2 * longest2
    ? volume > 0.0
    : ExactOrientation<4>(points.data()) > 0;
}

//------------------------------------------------------------------------------------------------
/**
 * @brief Scores of pieces.
 * @tparam PositionOf gives the position of a vertex
 */
template <int D, typename PositionOf>
class PieceShapes
{
public:
  /** @param sizing bounds circumradii in 4D; may be null */
  PieceShapes(PositionOf positionOf, const SizingField<D>* sizing)
    : Position(std::move(positionOf))
    , Sizing(sizing)
  {
  }

  /** The score of the pieces in the mesh; 0 if a piece is flat or inverted. */
  double ShapesOf(std::span<const NewCell<D>> pieces) const
  {
    double smallest = std::numeric_limits<double>::infinity();
    for (const NewCell<D>& piece : pieces)
    {
      const std::array<const Point<D>*, N> points = this->PointsOf(piece);
      if ((D == 4 || piece.Label != 0) && !IsPositive(points))
      {
        return 0.0; // the optimiser of pentatopes looks at those outside, too
      }
      smallest =
        piece.Label != 0 ? std::min(smallest, this->ScoreOf(points, piece.Label)) : smallest;
    }
    return smallest;
  }

  /** The score of the angles of interfaces between pieces. */
  double FacetsOf(std::span<const NewCell<3>> pieces) const
  {
    std::vector<std::pair<std::array<std::uint32_t, 3>, LabelId>> facets;
    for (const NewCell<3>& piece : pieces)
    {
      for (unsigned i = 0; i < 4; ++i)
      {
        std::array<std::uint32_t, 3> facet{ piece.V[(i + 1) % 4], piece.V[(i + 2) % 4],
          piece.V[(i + 3) % 4] };
        std::sort(facet.begin(), facet.end());
        facets.emplace_back(facet, piece.Label);
      }
    }
    std::sort(facets.begin(), facets.end());
    double smallest = 90.0;
    for (std::size_t f = 1; f < facets.size(); ++f)
    {
      const auto& v = facets[f].first;
      if (v == facets[f - 1].first && facets[f].second != facets[f - 1].second)
      {
        const std::array<double, 3> angles =
          PlanarAngles(this->Position(v[0]), this->Position(v[1]), this->Position(v[2]));
        smallest = std::min(smallest, *std::min_element(angles.begin(), angles.end()));
      }
    }
    return std::sin(smallest / DegreesPerRadian) / std::sin(GoodFacetAngle / DegreesPerRadian);
  }

private:
  static constexpr unsigned N = D + 1;

  std::array<const Point<D>*, N> PointsOf(const NewCell<D>& piece) const
  {
    std::array<const Point<D>*, N> points;
    for (unsigned i = 0; i < N; ++i)
    {
      points[i] = &this->Position(piece.V[i]);
    }
    return points;
  }

  /** The score of one piece. */
  double ScoreOf(const std::array<const Point<3>*, 4>& points, LabelId) const
  {
    static const double goodSine = std::sin(GoodDihedralAngle / DegreesPerRadian);
    return std::min({ 1.0 / goodSine, SmallestDihedralSine(points.data()) / goodSine,
      GoodRadiusEdgeRatio / RadiusEdgeRatio<3>(points.data()) });
  }

  double ScoreOf(const std::array<const Point<4>*, 5>& points, LabelId label) const
  {
    Circumball<4> ball;
    if (!ComputeCircumball<4>(points.data(), ball))
    {
      ComputeCircumballExactly<4>(points.data(), ball);
    }
    const double size = this->Sizing ? this->Sizing->ElementSize(ball.Center, label)
                                     : std::numeric_limits<double>::infinity();
    const double score =
      std::min({ NormalizedVolume<4>(points.data(), ball.Radius2) / GoodNormalizedVolume,
        GoodRadiusEdgeRatio / RadiusEdgeRatio<4>(points.data(), ball.Radius2),
        size / std::sqrt(ball.Radius2) });
    return std::max(score, std::numeric_limits<double>::min()); // it is not flat
  }

  const PositionOf Position;
  const SizingField<D>* const Sizing;
};

} // namespace voxplex::opening

#endif
