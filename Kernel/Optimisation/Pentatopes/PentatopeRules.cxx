// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Optimisation/Pentatopes/PentatopeRules.h"

#include <algorithm>

namespace voxplex
{

namespace
{

/** Circumradii stay below this times the size: a little less, for rounding. */
constexpr double BelowSize = 1.0 - 1e-9;

} // namespace

//------------------------------------------------------------------------------------------------
bool PentatopeRules::Allows(const PentatopeShape& shape, double oldRatio, LabelId label) const
{
  if (!(shape.Ratio <= std::max(this->Bounds.RadiusEdgeRatio, oldRatio)))
  {
    return false;
  }
  if (!this->Bounds.Sizing)
  {
    return true;
  }
  // Sizes are asked for where the label is only, as in refinement.
  const Point<4>& centre = shape.Ball.Center;
  if (this->Surfaces.Label(centre) != label)
  {
    return false;
  }
  const double size = BelowSize * this->Bounds.Sizing->ElementSize(centre, label);
  return shape.Ball.Radius2 < size * size;
}

bool PentatopeRules::IsOnPlane(const PentatopeComplex& complex, std::uint32_t s, unsigned i) const
{
  const double time = complex.PointOf(s, (i + 1) % 5)[3];
  for (unsigned k = 2; k < 5; ++k)
  {
    if (complex.PointOf(s, (i + k) % 5)[3] != time)
    {
      return false;
    }
  }
  return this->Bounds.Planes.AreAt(time);
}

} // namespace voxplex
