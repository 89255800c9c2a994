// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Optimisation/Pentatopes/PentatopeFlips.h"

#include "Geometry/SimplexQuality.h"

#include <algorithm>

namespace voxplex
{

namespace
{

/** A flip has to raise the smallest quality by more than rounding. */
constexpr double LeastGain = 1e-9;

/** The vertex of `other` that s does not have. */
std::uint32_t ApexOf(const PentatopeComplex::Vertices& other, const PentatopeComplex::Vertices& s)
{
  return *std::find_if(other.begin(), other.end(),
    [&s](std::uint32_t v) { return std::find(s.begin(), s.end(), v) == s.end(); });
}

bool Has(const PentatopeComplex::Vertices& s, std::uint32_t v)
{
  return std::find(s.begin(), s.end(), v) != s.end();
}

/**
 * The flip of the six points of s and its neighbour across vertex `across`. No flip is returned if
 * a smaller `across` gives the same one.
 * @param neighbours of s; those of other labels or slabs are None
 */
PentatopeFlip FlipWith(const PentatopeComplex& complex, const PentatopeRules& rules,
  std::uint32_t s, const std::array<std::uint32_t, 5>& neighbours, unsigned across)
{
  const PentatopeComplex::Vertices& corners = complex.Cells[s].V;
  const std::uint32_t apex = ApexOf(complex.Cells[neighbours[across]].V, corners);
  PentatopeFlip flip;
  flip.Old[flip.NumberOfOld++] = s;
  flip.Before = complex.Scores[s];
  for (unsigned k = 0; k < 5; ++k)
  {
    PentatopeComplex::Vertices other = corners;
    other[k] = apex;
    const double volume = SignedVolume<4>(complex.PointsOf(other).data());
    if (volume > 0.0)
    {
      flip.New[flip.NumberOfNew % 4] = other;
      ++flip.NumberOfNew;
      continue;
    }
    const std::uint32_t neighbour = neighbours[k];
    const bool isThere = neighbour != None && Has(complex.Cells[neighbour].V, apex);
    if (!isThere || k < across || flip.NumberOfOld == 4)
    {
      return {};
    }
    flip.Old[flip.NumberOfOld++] = neighbour;
    flip.Before = std::min(flip.Before, complex.Scores[neighbour]);
  }
  if (flip.NumberOfOld + flip.NumberOfNew != 6 || flip.NumberOfOld < 2)
  {
    return {};
  }
  const LabelId label = complex.LabelOf(s);
  double oldRatio = 0.0;
  for (std::size_t k = 0; k < flip.NumberOfOld; ++k)
  {
    oldRatio = std::max(oldRatio, ShapeOf(complex.PointsOf(complex.Cells[flip.Old[k]].V)).Ratio);
  }
  flip.After = 1.0;
  for (std::size_t k = 0; k < flip.NumberOfNew; ++k)
  {
    const PentatopeShape shape = ShapeOf(complex.PointsOf(flip.New[k]));
    if (!(shape.Quality > flip.Before + LeastGain) || !rules.Allows(shape, oldRatio, label))
    {
      return {};
    }
    flip.After = std::min(flip.After, shape.Quality);
  }
  return flip;
}

} // namespace

//------------------------------------------------------------------------------------------------
PentatopeFlip FindFlip(
  const PentatopeComplex& complex, const PentatopeRules& rules, std::uint32_t s)
{
  std::array<std::uint32_t, 5> neighbours = complex.Cells[s].N;
  for (unsigned i = 0; i < 5; ++i)
  {
    if (neighbours[i] != None &&
      (complex.LabelOf(neighbours[i]) != complex.LabelOf(s) || rules.IsOnPlane(complex, s, i)))
    {
      neighbours[i] = None;
    }
  }
  PentatopeFlip best;
  for (unsigned i = 0; i < 5; ++i)
  {
    if (neighbours[i] != None)
    {
      const PentatopeFlip flip = FlipWith(complex, rules, s, neighbours, i);
      if (flip.NumberOfOld != 0 && flip.After - flip.Before > best.After - best.Before)
      {
        best = flip;
      }
    }
  }
  return best;
}

} // namespace voxplex
