// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Seeding.h
 * @brief The seeds from which refinement starts, so that every thread has work.
 */
#ifndef voxplex_Seeding_h
#define voxplex_Seeding_h

#include "Base/GridIndex.h"
#include "Geometry/HilbertOrder.h"
#include "Parallel/ParallelCollect.h"
#include "Parallel/ParallelSort.h"
#include "Refinement/RefinementContext.h"

#include <algorithm>
#include <cmath>
#include <compare>
#include <span>
#include <utility>
#include <vector>

namespace voxplex
{

/**
 * Feature points closest to the nodes of a lattice over the domain. No point is near a flat end.
 * The sample spacing rule might insert the same points, so the guarantees of the rules stay the
 * same. InsertSeeds() skips points that are nearer than delta to another.
 *
 * @param spacing of the nodes
 * @param reach nodes that are farther from all interfaces give no point
 */
template <int D>
std::vector<FeatureSeed<D>> SampleInterfaces(
  const RefinementContext<D>& context, double spacing, double reach, unsigned threads)
{
  constexpr std::size_t grain = 1024;
  const Box<D> bounds = context.Image.Bounds();
  std::array<std::size_t, static_cast<std::size_t>(D)> nodes;
  for (std::size_t a = 0; a < D; ++a)
  {
    nodes[a] =
      std::max<std::size_t>(1, static_cast<std::size_t>((bounds.Max[a] - bounds.Min[a]) / spacing));
  }
  const auto sampleFrom = [&](std::size_t k, std::vector<FeatureSeed<D>>& sample)
  {
    const auto node = IndexAt(k, nodes);
    Point<D> p;
    for (std::size_t a = 0; a < D; ++a)
    {
      const double fraction = (static_cast<double>(node[a]) + 0.5) / static_cast<double>(nodes[a]);
      p[a] = bounds.Min[a] + fraction * (bounds.Max[a] - bounds.Min[a]);
    }
    Point<D> z;
    Point<D> onEnd;
    const LabelId label = context.Image.Label(p);
    if (context.Image.DistanceBound(p) < reach && context.Image.ClosestSurfacePoint(p, label, z) &&
      !context.IsNearEnd(z, context.Sizing.BaseAt(z), onEnd))
    {
      const double delta = context.Sizing.BaseAt(z);
      sample.push_back({ z,
        context.Sizing.Sources().Interfaces
          ? std::max(delta, context.Sizing.SamplingDistanceBehind(p, label, z))
          : delta });
    }
  };
  return ParallelCollect<FeatureSeed<D>>(CountCells(nodes), grain, threads,
    [&](std::size_t first, std::size_t last, std::vector<FeatureSeed<D>>& sample)
    {
      for (std::size_t k = first; k < last; ++k)
      {
        sampleFrom(k, sample);
      }
    });
}

/**
 * A sample for threads to start from.
 * @param number approximate number of nodes; fewer if these would be nearer than a few delta; 0 for
 *   none
 */
template <int D>
std::vector<FeatureSeed<D>> SampleInterfaces(
  const RefinementContext<D>& context, std::size_t number, unsigned threads)
{
  if (number == 0)
  {
    return {};
  }
  const Box<D> bounds = context.Image.Bounds();
  const double finest = context.Sizing.Base().Finest();
  double volume = 1.0;
  for (std::size_t a = 0; a < D; ++a)
  {
    volume *= std::max(bounds.Max[a] - bounds.Min[a], finest);
  }
  constexpr double FewestDeltas = 4.0;
  const double spacing =
    std::max(FewestDeltas * finest, std::pow(volume / static_cast<double>(number), 1.0 / D));
  return SampleInterfaces(context, spacing, spacing, threads);
}

/** The order in which seeds are inserted: shared points first, then along a Hilbert curve. */
template <int D>
std::vector<std::size_t> SeedsAlongCurve(
  const Triangulation<D>& mesh, const std::vector<FeatureSeed<D>>& seeds)
{
  struct SeedOnCurve
  {
    bool IsLate;
    std::uint64_t Index;
    std::size_t Seed;

    auto operator<=>(const SeedOnCurve&) const = default;
  };
  std::vector<SeedOnCurve> along;
  along.reserve(seeds.size());
  for (std::size_t i = 0; i < seeds.size(); ++i)
  {
    along.push_back({ !seeds[i].IsShared,
      HilbertIndex<D>(mesh.GetBox().Clamp(seeds[i].Position), mesh.GetBox()), i });
  }
  std::sort(along.begin(), along.end());
  std::vector<std::size_t> order;
  order.reserve(along.size());
  for (const SeedOnCurve& place : along)
  {
    order.push_back(place.Seed);
  }
  return order;
}

/**
 * Inserts points along a Hilbert curve, shared points first.
 *
 * @param Rules as in Refiner
 * @param worker inserts; no other thread may operate meanwhile. New simplices are screened, unless
 *   the worker screens later.
 */
template <typename Rules, int D = Rules::Dimension>
void InsertSeeds(RefinementContext<D>& context, RefinementWorker<D>& worker,
  const std::vector<FeatureSeed<D>>& seeds)
{
  Triangulation<D>& mesh = context.Mesh;
  SimplexId near = mesh.FirstAlive();
  Rules rules(context, worker);
  for (const std::size_t i : SeedsAlongCurve(mesh, seeds))
  {
    rules.InsertSeed(seeds[i], near);
    near = mesh.IsAlive(near) ? near : mesh.FirstAlive();
  }
  mesh.Unlock(worker.Kernel);
}

/**
 * Inserts the given seeds and a sample of the interfaces.
 *
 * The thesis starts all threads from the few simplices of the box and loses its first seconds to
 * rollbacks and idling (section 3.4.3, figure 3.6). With a few dozen points per thread, every
 * thread begins with work of its own. The points are counted as insertions by the
 * sample spacing rule.
 *
 * @param Rules as in Refiner
 * @param worker inserts; no other thread may operate meanwhile. Nothing is screened: most of the new
 *   simplices do not last.
 * @param seeds are inserted before the sample
 * @param nodes approximate number of points of the sample, 0 for none
 * @param threads find the points of the sample
 */
template <typename Rules, int D = Rules::Dimension>
void SeedTriangulation(RefinementContext<D>& context, RefinementWorker<D>& worker,
  const std::vector<FeatureSeed<D>>& seeds, std::size_t nodes, unsigned threads)
{
  worker.ScreensLater = true;
  // The seeds come first: points of the sample would be in the way of junctions.
  InsertSeeds<Rules>(context, worker, seeds);
  InsertSeeds<Rules>(context, worker, SampleInterfaces(context, nodes, threads));
  worker.ScreensLater = false;
}

/**
 * All living simplices, ordered so that neighbours in the list are near each other in space. A
 * thread starts well from a piece of the list.
 */
template <int D>
std::vector<SimplexId> LivingAlongCurve(const Triangulation<D>& mesh, unsigned threads)
{
  struct SimplexOnCurve
  {
    std::uint32_t Index;
    SimplexId Id;
  };
  constexpr std::size_t grain = 4096;
  constexpr unsigned dropped = 63 / D * D - 30; // bits: 30 are enough for places
  std::vector<SimplexOnCurve> places =
    ParallelCollect<SimplexOnCurve>(mesh.SimplexIdEnd(), grain, threads,
      [&](std::size_t first, std::size_t last, std::vector<SimplexOnCurve>& found)
      {
        for (auto s = static_cast<SimplexId>(first); s < last; ++s)
        {
          if (!mesh.IsAlive(s))
          {
            continue;
          }
          Point<D> centre{};
          for (const VertexId v : mesh.GetSimplex(s).V)
          {
            for (std::size_t a = 0; a < D; ++a)
            {
              centre[a] += mesh.Position(v)[a] / (D + 1);
            }
          }
          const std::uint64_t index =
            HilbertIndex<D>(mesh.GetBox().Clamp(centre), mesh.GetBox()) >> dropped;
          found.push_back({ static_cast<std::uint32_t>(index), s });
        }
      });
  std::vector<SimplexOnCurve> scratch(places.size());
  const std::span<const SimplexOnCurve> along = ParallelRadixSort(
    std::span<SimplexOnCurve>(places), std::span<SimplexOnCurve>(scratch), 30,
    [](const SimplexOnCurve& place) { return place.Index; }, threads);
  std::vector<SimplexId> simplices;
  simplices.reserve(along.size());
  for (const SimplexOnCurve& place : along)
  {
    simplices.push_back(place.Id);
  }
  return simplices;
}

} // namespace voxplex

#endif
