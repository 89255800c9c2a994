// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Optimisation/Pentatopes/PentatopeRules.h"

#include <algorithm>

namespace voxplex
{

//------------------------------------------------------------------------------------------------
bool PentatopeRules::Allows(const PentatopeShape& shape, double oldRatio, LabelId label) const
{
  if (!(shape.Ratio <= std::max(this->Bounds.RadiusEdgeRatio, oldRatio)))
  {
    return false;
  }
  // Sizes are asked for where the label is only, as in refinement.
  return !this->Bounds.Sizing ||
    (this->Surfaces.Label(shape.Ball.Center) == label &&
      this->Bounds.Sizing->IsSmallEnough(shape.Ball, label));
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
