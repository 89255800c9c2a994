// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PickingRegion.h
 * @brief Tries several points of a region for one insertion (thesis, section 4.1).
 */
#ifndef voxplex_PickingRegion_h
#define voxplex_PickingRegion_h

#include "Base/MixBits.h"
#include "Refinement/RefinementContext.h"

#include <bit>
#include <cstdint>

namespace voxplex
{

/**
 * Pseudo-random numbers that depend on a seed and a place alone, and not on the thread
 * (splitmix64).
 */
template <int D>
class PseudoRandom
{
public:
  PseudoRandom(std::uint64_t seed, const Point<D>& place)
    : State(seed)
  {
    for (const double x : place)
    {
      this->State = this->Next() ^ std::bit_cast<std::uint64_t>(x);
    }
  }
  Point<D> InBall(const Point<D>& centre, double radius)
  {
    for (;;)
    {
      Point<D> p;
      for (double& x : p)
      {
        x = static_cast<double>(this->Next() >> 11) * 0x1p-52 - 1.0;
      }
      if (Dot(p, p) > 1.0)
      {
        continue;
      }
      for (std::size_t a = 0; a < D; ++a)
      {
        p[a] = centre[a] + radius * p[a];
      }
      return p;
    }
  }

private:
  std::uint64_t Next()
  {
    this->State += GoldenGamma;
    return MixBits(this->State);
  }

  std::uint64_t State;
};

/**
 * Inserts the first point that a veto accepts. The veto's own candidate comes first, then random
 * points of the picking region. If none is accepted, the best of them is inserted.
 *
 * @param veto a Triangulation<D>::InsertionVeto with `Candidate`, `Best`, `HasBest` (whether any
 *   point was acceptable at all) and `AcceptAll`
 * @param draw bool(Point<D>&): draws a candidate; returns false if the point cannot be used
 * @param insert RuleOutcome(Point<D>&): inserts a point if the veto accepts it
 */
template <typename BestPick, typename Draw, typename Insert>
RuleOutcome InsertPick(
  RuleStatistics& statistics, unsigned picks, BestPick& veto, Draw&& draw, Insert&& insert)
{
  for (unsigned pick = 0; pick < picks; ++pick)
  {
    if (pick > 0 && !draw(veto.Candidate))
    {
      continue;
    }
    ++statistics.PicksTried;
    const RuleOutcome outcome = insert(veto.Candidate);
    if (outcome != RuleOutcome::Good)
    {
      return outcome;
    }
  }
  if (!veto.HasBest)
  {
    return RuleOutcome::Good;
  }
  veto.AcceptAll = true;
  return insert(veto.Best);
}

} // namespace voxplex

#endif
