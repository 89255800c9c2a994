// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/SimplexLabels.h"

#include "Parallel/ParallelFor.h"

namespace voxplex
{

template <int D>
SimplexLabels LabelSimplices(const Triangulation<D>& triangulation, const Domain<D>& image,
  unsigned threads, const std::stop_token& stop)
{
  constexpr std::size_t Grain = 4096;
  SimplexLabels labels(triangulation.SimplexIdEnd());
  ParallelFor(
    0, labels.size(), Grain, threads,
    [&](std::size_t first, std::size_t last)
    {
      for (auto s = static_cast<SimplexId>(first); s < last; ++s)
      {
        labels[s] =
          triangulation.IsAlive(s) ? LabelAtCentre(triangulation, image, s) : LabelId{ 0 };
      }
    },
    stop);
  return labels;
}

template SimplexLabels LabelSimplices<3>(
  const Triangulation<3>&, const Domain<3>&, unsigned, const std::stop_token&);
template SimplexLabels LabelSimplices<4>(
  const Triangulation<4>&, const Domain<4>&, unsigned, const std::stop_token&);

} // namespace voxplex
