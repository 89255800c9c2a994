// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CoarseLattice.h
 * @brief Points that bound circumradii from the start, so that operations fit into tiles.
 */
#ifndef voxplex_CoarseLattice_h
#define voxplex_CoarseLattice_h

#include "Base/GridIndex.h"
#include "Base/MixBits.h"
#include "Geometry/HilbertOrder.h"
#include "Parallel/ParallelCollect.h"
#include "Refinement/RefinementContext.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>
#include <vector>

namespace voxplex
{

/** A node of the coarse lattice. */
template <int D>
struct LatticeNode
{
  Point<D> Position;
  VertexKind Kind;
};

/**
 * Makes nodes of a lattice over the box. Their spacing grows with the distance from interfaces.
 *
 * If there are only the corners of the box, every interface point is next to a corner. So all
 * operations need the same vertices, and none fits into a tile. With the nodes, circumradii near
 * interfaces are about the spacing, and farther away about the distance from the interfaces.
 *
 * Nodes on the faces of the box lie there exactly. Otherwise nodes are moved at random by up to a
 * quarter of the spacing along each axis, because cospherical points are slow and make slivers. The
 * result does not depend on the number of threads.
 *
 * @param spacing near interfaces
 * @param clearance no node is nearer to an interface, since the sample spacing rule inserts
 *   points there
 */
template <int D>
std::vector<LatticeNode<D>> MakeCoarseLattice(
  const RefinementContext<D>& context, double spacing, double clearance, unsigned threads)
{
  using Index = std::array<std::size_t, static_cast<std::size_t>(D)>;
  constexpr double Jitter = 0.25; // of the spacing, on both sides
  constexpr double Reach = 1.5;   // a node is used up to this distance, in the spacing of its level
  constexpr std::size_t Grain = 4096;
  const Box<D>& box = context.Mesh.GetBox();
  Index last; // the nodes of each axis are 0 ... last
  Index nodes;
  Point<D> step;
  for (std::size_t a = 0; a < D; ++a)
  {
    const double length = box.Max[a] - box.Min[a];
    last[a] = std::max<std::size_t>(1, static_cast<std::size_t>(length / spacing));
    nodes[a] = last[a] + 1;
    step[a] = length / static_cast<double>(last[a]);
  }
  const std::size_t count = CountCells(nodes);
  return ParallelCollect<LatticeNode<D>>(count, Grain, threads,
    [&](std::size_t first, std::size_t end, std::vector<LatticeNode<D>>& lattice)
    {
      for (std::size_t k = first; k < end; ++k)
      {
        const Index index = IndexAt(k, nodes);
        std::size_t bits = 0; // of the coordinates inside of the box
        for (std::size_t a = 0; a < D; ++a)
        {
          bits |= index[a] == 0 || index[a] == last[a] ? 0 : index[a];
        }
        if (bits == 0)
        {
          continue; // a corner
        }
        LatticeNode<D> node{ {}, VertexKind::Free };
        const double levelSpacing = spacing * static_cast<double>(bits & (~bits + 1));
        std::uint64_t random = MixBits(k + GoldenGamma);
        for (std::size_t a = 0; a < D; ++a)
        {
          random = MixBits(random + GoldenGamma);
          if (index[a] == 0 || index[a] == last[a])
          {
            node.Position[a] = index[a] == 0 ? box.Min[a] : box.Max[a];
            const bool isFlatEnd = a + 1 == D && context.HasTimeBorder[index[a] == 0 ? 0 : 1];
            node.Kind = isFlatEnd ? node.Kind : VertexKind::Box;
            continue;
          }
          const double offset = static_cast<double>(random >> 11) * 0x1p-52 - 1.0; // -1 ... 1
          node.Position[a] =
            box.Min[a] + (static_cast<double>(index[a]) + Jitter * offset) * step[a];
        }
        const double distance = context.Image.DistanceBound(node.Position);
        if (distance <= Reach * levelSpacing && distance >= clearance)
        {
          lattice.push_back(node);
        }
      }
    });
}

/** Inserts the nodes along a Hilbert curve. Nothing is screened. No other worker may operate. */
template <int D>
void InsertCoarseLattice(RefinementContext<D>& context, RefinementWorker<D>& worker,
  const std::vector<LatticeNode<D>>& nodes)
{
  Triangulation<D>& mesh = context.Mesh;
  std::vector<std::pair<std::uint64_t, std::size_t>> along;
  for (std::size_t i = 0; i < nodes.size(); ++i)
  {
    along.push_back({ HilbertIndex<D>(nodes[i].Position, mesh.GetBox()), i });
  }
  std::sort(along.begin(), along.end());
  SimplexId near = mesh.FirstAlive();
  for (const auto& [index, i] : along)
  {
    const LatticeNode<D>& node = nodes[i];
    const SimplexId conflict = mesh.FindConflict(worker.Kernel, node.Position, near);
    if (conflict != None &&
      mesh.Insert(worker.Kernel, node.Position, node.Kind, conflict) == InsertionOutcome::Inserted)
    {
      near = worker.Kernel.Created[0];
    }
  }
}

} // namespace voxplex

#endif
