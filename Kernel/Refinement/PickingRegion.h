// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PickingRegion.h
 * @brief Trying several points of a region for one insertion (thesis, section 4.1).
 */
#ifndef voxplex_PickingRegion_h
#define voxplex_PickingRegion_h

#include "Base/MixBits.h"
#include "Refinement/RefinementContext.h"

#include <bit>
#include <cstdint>

namespace voxplex
{

/** Numbers that depend on a seed and a place only, whichever thread asks (splitmix64). */
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
 * Inserts the first point that a judge accepts: the judge's candidate first, then random points of the
 * picking region; if none is good, the best of them.
 *
 * @param judge a Triangulation<D>::Judge with `Candidate`, `Best`, `HasBest` (whether any point was
 * acceptable at all) and `AcceptAll`
 * @param draw bool(Point<D>&): draws a candidate; false if that cannot be used
 * @param insert Verdict(Point<D>&): inserts a point if the judge accepts it
 */
template <typename BestPick, typename Draw, typename Insert>
Verdict InsertPick(
  RuleStatistics& statistics, unsigned picks, BestPick& judge, Draw&& draw, Insert&& insert)
{
  for (unsigned pick = 0; pick < picks; ++pick)
  {
    if (pick > 0 && !draw(judge.Candidate))
    {
      continue;
    }
    ++statistics.PicksTried;
    const Verdict verdict = insert(judge.Candidate);
    if (verdict != Verdict::Good)
    {
      return verdict;
    }
  }
  if (!judge.HasBest)
  {
    return Verdict::Good;
  }
  judge.AcceptAll = true;
  return insert(judge.Best);
}

} // namespace voxplex

#endif
