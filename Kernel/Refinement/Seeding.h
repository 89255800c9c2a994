// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Seeding.h
 * @brief A start that gives every thread work.
 */
#ifndef voxplex_Seeding_h
#define voxplex_Seeding_h

#include "Geometry/HilbertOrder.h"
#include "Refinement/RefinementContext.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace voxplex
{

/**
 * Feature points closest to the nodes of a coarse lattice over the domain, no two nearer than delta: points
 * that R1 might insert as well, so nothing that the rules promise changes. None near flat ends.
 *
 * @param number about how many nodes; fewer where these would be nearer than a few delta; 0 for none
 */
template <int D>
std::vector<FeatureSeed<D>> SampleInterfaces(
  const RefinementContext<D>& context, std::size_t number)
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
  std::array<std::size_t, static_cast<std::size_t>(D)> nodes;
  std::size_t count = 1;
  for (std::size_t a = 0; a < D; ++a)
  {
    nodes[a] =
      std::max<std::size_t>(1, static_cast<std::size_t>((bounds.Max[a] - bounds.Min[a]) / spacing));
    count *= nodes[a];
  }
  std::vector<FeatureSeed<D>> sample;
  for (std::size_t k = 0; k < count; ++k)
  {
    Point<D> p;
    std::size_t rest = k;
    for (std::size_t a = 0; a < D; ++a)
    {
      const double fraction =
        (static_cast<double>(rest % nodes[a]) + 0.5) / static_cast<double>(nodes[a]);
      p[a] = bounds.Min[a] + fraction * (bounds.Max[a] - bounds.Min[a]);
      rest /= nodes[a];
    }
    Point<D> z;
    Point<D> onEnd;
    const LabelId label = context.Image.Label(p);
    if (context.Image.DistanceBounds(p).Lower < spacing &&
      context.Image.ClosestSurfacePoint(p, label, z) &&
      !context.IsNearEnd(z, context.Sizing.Base().Delta, onEnd))
    {
      const double delta = context.Sizing.BaseAt(z);
      sample.push_back({ z,
        context.Sizing.Sources().Interfaces
          ? std::max(delta, context.Sizing.SamplingDistanceBehind(p, label, z))
          : delta });
    }
  }
  return sample;
}

/**
 * Inserts feature points along a Hilbert curve.
 *
 * @param Rules as in Refiner
 * @param worker inserts; nobody else may operate meanwhile. What is made is screened, unless it screens later.
 */
template <typename Rules, int D = Rules::Dimension>
void InsertSeeds(RefinementContext<D>& context, RefinementWorker<D>& worker,
  const std::vector<FeatureSeed<D>>& seeds)
{
  Triangulation<D>& mesh = context.Mesh;
  std::vector<std::pair<std::uint64_t, std::size_t>> along;
  for (std::size_t i = 0; i < seeds.size(); ++i)
  {
    along.push_back({ HilbertIndex<D>(mesh.GetBox().Clamp(seeds[i].Position), mesh.GetBox()), i });
  }
  std::sort(along.begin(), along.end());
  SimplexId near = mesh.FirstAlive();
  Rules rules(context, worker);
  for (const auto& [index, i] : along)
  {
    rules.InsertSeed(seeds[i], near);
    near = mesh.IsAlive(near) ? near : mesh.FirstAlive();
  }
  mesh.Unlock(worker.Kernel);
}

/**
 * Inserts a sample of the interfaces and the seeds that are asked for.
 *
 * The thesis starts all threads from the few simplices of the box and loses its first seconds to
 * rollbacks and idling (section 3.4.3, figure 3.6); with a few dozen points a thread all begin with work
 * of their own. The points are counted as insertions by R1.
 *
 * @param Rules as in Refiner
 * @param worker inserts; nobody else may operate meanwhile. Nothing is screened: most of what is made does not last.
 * @param seeds to be inserted besides
 * @param nodes about how many points the sample has, 0 for none
 */
template <typename Rules, int D = Rules::Dimension>
void SeedTriangulation(RefinementContext<D>& context, RefinementWorker<D>& worker,
  const std::vector<FeatureSeed<D>>& seeds, std::size_t nodes)
{
  worker.ScreensLater = true;
  InsertSeeds<Rules>(
    context, worker, seeds); // first: the sample would stand in the way of junctions
  InsertSeeds<Rules>(context, worker, SampleInterfaces(context, nodes));
  worker.ScreensLater = false;
}

/**
 * All living simplices, so that neighbours in the list are near each other in space: consecutive pieces of it are good
 * starts for threads.
 */
template <int D>
std::vector<SimplexId> LivingAlongCurve(const Triangulation<D>& mesh)
{
  std::vector<std::pair<std::uint64_t, SimplexId>> order;
  for (SimplexId s = 0; s < mesh.SimplexIdEnd(); ++s)
  {
    if (mesh.IsAlive(s))
    {
      Point<D> centre{};
      for (const VertexId v : mesh.GetSimplex(s).V)
      {
        for (std::size_t a = 0; a < D; ++a)
        {
          centre[a] += mesh.Position(v)[a] / (D + 1);
        }
      }
      order.push_back({ HilbertIndex<D>(mesh.GetBox().Clamp(centre), mesh.GetBox()), s });
    }
  }
  std::sort(order.begin(), order.end());
  std::vector<SimplexId> simplices;
  simplices.reserve(order.size());
  for (const auto& [index, s] : order)
  {
    simplices.push_back(s);
  }
  return simplices;
}

} // namespace voxplex

#endif
