// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Quality/LostComponents.h"

#include "Base/GridIndex.h"
#include "Geometry/SimplexQuality.h"
#include "Image/BitMask.h"
#include "Parallel/ParallelFor.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <memory>
#include <span>

namespace voxplex
{

namespace
{

/** The voxel that contains the centroid of an element, counted from the first voxel of the crop. */
template <int D>
typename GridGeometry<D>::Index VoxelOf(
  const LabelImage<D>& image, const SimplexMesh<D>& mesh, std::size_t simplex)
{
  Point<D> centroid{};
  for (const std::uint32_t v : mesh.Simplices[simplex])
  {
    for (std::size_t a = 0; a < D; ++a)
    {
      centroid[a] += mesh.Points[v][a] / (D + 1);
    }
  }
  const Point<D> index = image.Grid().ToIndex(centroid);
  typename GridGeometry<D>::Index voxel;
  for (std::size_t a = 0; a < D; ++a)
  {
    voxel[a] = std::llround(index[a]) - image.CropOrigin()[a];
  }
  return voxel;
}

/** Calls visit with each voxel of the block of 3^D voxels around a voxel. */
template <int D, typename Visit>
void ForEachAround(const typename GridGeometry<D>::Index& centre, const Visit& visit)
{
  auto low = centre;
  auto high = centre;
  for (std::size_t a = 0; a < D; ++a)
  {
    --low[a];
    ++high[a];
  }
  ForEachIndex(low, high, visit);
}

/** The voxels whose block of 3^D voxels contains a voxel of some components. */
template <int D>
class Surroundings
{
public:
  using Index = typename GridGeometry<D>::Index;

  explicit Surroundings(const Index& dimensions)
    : Mask(Shifted(dimensions, 2))
  {
  }

  void Add(const Components<D>& components, std::uint32_t component)
  {
    components.ForEachRun(component,
      [this](const Index& first, std::int64_t length)
      {
        Index high = Shifted(first, 2); // one voxel farther, in a mask that begins at -1
        high[0] += length - 1;
        ForEachIndex(first, high, [this](const Index& at) { this->Mask.Set(at); });
      });
  }

  bool Contain(const Index& voxel) const
  {
    const Index at = Shifted(voxel, 1);
    for (std::size_t a = 0; a < D; ++a)
    {
      if (at[a] < 0 || at[a] >= this->Mask.Dimensions()[a])
      {
        return false;
      }
    }
    return this->Mask.Test(at);
  }

private:
  static Index Shifted(Index index, std::int64_t by)
  {
    for (std::int64_t& i : index)
    {
      i += by;
    }
    return index;
  }

  BitMask<D> Mask;
};

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
std::vector<std::uint32_t> FindLostComponents(const Components<D>& components,
  const LabelImage<D>& image, const SimplexMesh<D>& mesh, const std::vector<bool>& wanted,
  unsigned threads, const std::stop_token& stop)
{
  using Index = typename GridGeometry<D>::Index;
  const std::vector<Component<D>>& all = components.All();
  const auto found = std::make_unique<std::atomic<bool>[]>(all.size());
  // Most elements belong to labels whose components have all been found.
  const std::span<const std::int64_t> values = image.Values();
  const auto missing = std::make_unique<std::atomic<std::uint32_t>[]>(values.size());
  for (std::size_t c = 0; c < all.size(); ++c)
  {
    missing[all[c].Label] += wanted[c] ? 1u : 0u;
  }
  const auto idOf = [&](std::int64_t value)
  {
    const auto at = std::lower_bound(values.begin() + 1, values.end(), value); // after background
    return at != values.end() && *at == value ? static_cast<LabelId>(at - values.begin())
                                              : LabelId{ 0 };
  };
  const auto mark = [&](const Index& voxel, LabelId label)
  {
    const std::uint32_t c = components.At(voxel);
    if (c != Components<D>::None && all[c].Label == label &&
      !found[c].load(std::memory_order_relaxed) &&
      !found[c].exchange(true, std::memory_order_relaxed) && wanted[c])
    {
      missing[label].fetch_sub(1, std::memory_order_relaxed);
    }
  };
  constexpr std::size_t SimplicesAtOnce = 4096;
  ParallelFor(
    0, mesh.Simplices.size(), SimplicesAtOnce, threads,
    [&](std::size_t begin, std::size_t end)
    {
      std::int64_t value = 0;
      LabelId label = 0;
      for (std::size_t s = begin; s < end; ++s)
      {
        if (mesh.Labels[s] != value)
        {
          value = mesh.Labels[s];
          label = idOf(value);
        }
        if (missing[label].load(std::memory_order_relaxed) != 0)
        {
          mark(VoxelOf(image, mesh, s), label);
        }
      }
    },
    stop);

  const auto findLost = [&]
  {
    std::vector<std::uint32_t> lost;
    for (std::size_t c = 0; c < all.size(); ++c)
    {
      if (wanted[c] && !found[c].load(std::memory_order_relaxed))
      {
        lost.push_back(static_cast<std::uint32_t>(c));
      }
    }
    return lost;
  };
  const std::vector<std::uint32_t> seemLost = findLost();
  if (seemLost.empty())
  {
    return {};
  }
  Surroundings<D> near(image.CropDimensions());
  for (const std::uint32_t c : seemLost)
  {
    near.Add(components, c);
  }
  ParallelFor(
    0, mesh.Simplices.size(), SimplicesAtOnce, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t s = begin; s < end; ++s)
      {
        const Index centre = VoxelOf(image, mesh, s);
        if (near.Contain(centre))
        {
          const LabelId label = idOf(mesh.Labels[s]);
          ForEachAround<D>(centre, [&](const Index& voxel) { mark(voxel, label); });
        }
      }
    },
    stop);
  return findLost();
}

//------------------------------------------------------------------------------------------------
template <int D>
std::vector<std::uint32_t> FindWitnessesOf(const std::vector<std::uint32_t>& components,
  const Components<D>& all, const LabelImage<D>& image, const SimplexMesh<D>& mesh)
{
  if (components.empty())
  {
    return {};
  }
  struct Witness
  {
    double Shape = -1.0;
    std::uint32_t Element = 0;
  };
  std::vector<Witness> witnesses(components.size());
  const auto consider = [&](std::uint32_t element, const typename GridGeometry<D>::Index& voxel)
  {
    const std::uint32_t c = all.At(voxel);
    const auto at = std::lower_bound(components.begin(), components.end(), c);
    if (at == components.end() || *at != c ||
      image.Values()[all.All()[c].Label] != mesh.Labels[element])
    {
      return;
    }
    const double shape = NormalizedVolume<D>(mesh.PointsOf(element).data());
    Witness& best = witnesses[static_cast<std::size_t>(at - components.begin())];
    best = shape > best.Shape ? Witness{ shape, element } : best;
  };
  for (std::size_t s = 0; s < mesh.Simplices.size(); ++s)
  {
    ForEachAround<D>(VoxelOf(image, mesh, s),
      [&](const auto& voxel) { consider(static_cast<std::uint32_t>(s), voxel); });
  }
  std::vector<std::uint32_t> elements;
  for (const Witness& witness : witnesses)
  {
    if (witness.Shape >= 0.0)
    {
      elements.push_back(witness.Element);
    }
  }
  std::sort(elements.begin(), elements.end());
  elements.erase(std::unique(elements.begin(), elements.end()), elements.end());
  return elements;
}

template std::vector<std::uint32_t> FindLostComponents<3>(const Components<3>&,
  const LabelImage<3>&, const SimplexMesh<3>&, const std::vector<bool>&, unsigned,
  const std::stop_token&);
template std::vector<std::uint32_t> FindLostComponents<4>(const Components<4>&,
  const LabelImage<4>&, const SimplexMesh<4>&, const std::vector<bool>&, unsigned,
  const std::stop_token&);
template std::vector<std::uint32_t> FindWitnessesOf<3>(const std::vector<std::uint32_t>&,
  const Components<3>&, const LabelImage<3>&, const SimplexMesh<3>&);
template std::vector<std::uint32_t> FindWitnessesOf<4>(const std::vector<std::uint32_t>&,
  const Components<4>&, const LabelImage<4>&, const SimplexMesh<4>&);

} // namespace voxplex
