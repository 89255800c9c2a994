// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file BorderEdges.h
 * @brief Internal to ImageDomain: where interfaces meet the faces on which the image cuts the object.
 */
#ifndef voxplex_BorderEdges_h
#define voxplex_BorderEdges_h

#include "Image/GridGeometry.h"

#include <algorithm>
#include <cmath>

namespace voxplex
{

/**
 * Starts from a point on a cut face. Finds a point near it where an interface, or another cut face,
 * meets that face. If there are several, it takes the nearest one. The search goes in steps of half
 * a voxel along the gradient of the label's margin within the face. If there is no gradient, it
 * goes along the axes and diagonals of the face.
 */
template <typename Field>
class BorderEdgeSearch
{
public:
  /**
   * @param field a LabelField<3> or ScalarField<3>
   * @param x a point on the faces, in lattice coordinates
   * @param faces the cut faces of x, as bits (see BorderPlanes)
   * @param reach the largest distance of the point, in the frame
   */
  BorderEdgeSearch(const Field& field, const GridGeometry<3>& grid, const Point<3>& x,
    unsigned faces, double reach)
    : Image(field)
    , Grid(grid)
    , From(x)
    , Faces(faces)
    , Reach(reach)
    , Label(field.ExtendedLabelAt(x))
  {
  }

  /** @return false if there is no such point within reach */
  bool Find(Point<3>& edge)
  {
    for (unsigned face = 0; face < 6; ++face)
    {
      const Point<3> y = this->Image.Borders().MoveOnto(this->From, 1u << face);
      if (!((this->Faces >> face) & 1) && std::isfinite(y[face / 2]) &&
        this->Image.ExtendedLabelAt(y) != 0)
      {
        this->Consider(y);
      }
    }
    Point<3> gradient;
    Point<3> down{};
    if (this->Image.ExtendedMarginGradientAt(this->From, this->Label, gradient))
    {
      for (std::size_t a = 0; a < 3; ++a)
      {
        const double spacing = this->Grid.Spacing(static_cast<int>(a));
        down[a] = this->IsFree(a) ? -gradient[a] / (spacing * spacing) : 0.0;
      }
    }
    if (Dot(down, down) > 0.0)
    {
      this->Walk(down);
    }
    else
    {
      this->WalkAround();
    }
    edge = this->Nearest;
    return this->Found;
  }

private:
  /** Whether the faces leave this axis free. */
  bool IsFree(std::size_t axis) const { return ((this->Faces >> (2 * axis)) & 3) == 0; }

  /**
   * Keeps y if it is nearer, unless it is beyond another cut face: labels continue there, the
   * object does not.
   */
  void Consider(const Point<3>& y)
  {
    const Point<3> step = this->Grid.ToFrame(Subtract(y, this->From));
    const double distance = std::sqrt(Dot(step, step));
    if (distance <= this->Reach && this->Image.Borders().Distance(y) >= -Field::RootTolerance)
    {
      this->Reach = distance;
      this->Nearest = y;
      this->Found = true;
    }
  }

  void WalkAround()
  {
    for (int k = 0; k < 27; ++k)
    {
      Point<3> direction;
      bool inFaces = k != 13;
      for (std::size_t a = 0; a < 3; ++a)
      {
        const int step = k / (a == 0 ? 1 : a == 1 ? 3 : 9) % 3 - 1;
        inFaces = inFaces && (step == 0 || this->IsFree(a));
        direction[a] = step / this->Grid.Spacing(static_cast<int>(a));
      }
      if (inFaces)
      {
        this->Walk(direction);
      }
    }
  }

  /** Walks until the label ends, at most as far as the reach. */
  void Walk(const Point<3>& direction)
  {
    double longest = 0.0;
    for (const double d : direction)
    {
      longest = std::max(longest, std::abs(d));
    }
    const auto at = [&](double t)
    {
      Point<3> y;
      for (std::size_t a = 0; a < 3; ++a)
      {
        y[a] = this->From[a] + t * direction[a];
      }
      return y;
    };
    const auto isInside = [&](double t)
    { return this->Image.ExtendedMarginAt(at(t), this->Label) > 0.0; };
    const Point<3> unit = this->Grid.ToFrame(direction);
    const double end = this->Reach / std::sqrt(Dot(unit, unit));
    const double step = 0.5 / longest;
    for (double inside = 0.0; inside < end; inside += step)
    {
      double outside = inside + step;
      if (isInside(outside))
      {
        continue;
      }
      while ((outside - inside) * longest > Field::RootTolerance)
      {
        const double middle = 0.5 * (inside + outside);
        (isInside(middle) ? inside : outside) = middle;
      }
      this->Consider(at(0.5 * (inside + outside)));
      return;
    }
  }

  const Field& Image;
  const GridGeometry<3>& Grid;
  const Point<3> From;
  const unsigned Faces;
  double Reach; ///< distance of the point, once one is found
  const LabelId Label;
  Point<3> Nearest{};
  bool Found = false;
};

} // namespace voxplex

#endif
