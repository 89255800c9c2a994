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

/** The elements of a mesh, as LabelledTriangulation has them. */
template <int D>
class MeshElements
{
public:
  /** Both must outlive this object. */
  MeshElements(const SimplexMesh<D>& mesh, const LabelImage<D>& image)
    : Mesh(mesh)
    , Values(image.Values())
  {
  }

  std::size_t Size() const { return this->Mesh.Simplices.size(); }

  const Point<D>& PointOf(std::size_t element, std::size_t i) const
  {
    return this->Mesh.Points[this->Mesh.Simplices[element][i]];
  }

  /** Tells the labels of elements; 0 for a value that the image does not have. */
  class LabelReader
  {
  public:
    explicit LabelReader(const MeshElements& elements)
      : Of(elements)
    {
    }

    LabelId operator()(std::size_t element)
    {
      if (this->Of.Mesh.Labels[element] != this->Value)
      {
        this->Value = this->Of.Mesh.Labels[element];
        const auto values = this->Of.Values;
        const auto at =
          std::lower_bound(values.begin() + 1, values.end(), this->Value); // after background
        this->Label = at != values.end() && *at == this->Value
          ? static_cast<LabelId>(at - values.begin())
          : LabelId{ 0 };
      }
      return this->Label;
    }

  private:
    const MeshElements& Of;
    std::int64_t Value = 0;
    LabelId Label = 0;
  };

private:
  const SimplexMesh<D>& Mesh;
  const std::span<const std::int64_t> Values;
};

/** The voxels of the crop where elements are looked for. */
template <int D, typename Elements>
class Places
{
public:
  using Index = typename GridGeometry<D>::Index;

  /** All must outlive this object. */
  Places(const Components<D>& components, const LabelImage<D>& image, const Elements& elements)
    : Extent(components.Extent())
    , Image(image)
    , All(elements)
  {
  }

  /**
   * Calls visit with the voxel that contains the centroid of an element. If components are those of
   * frames: with the voxels that contain the centroid of its cut at each frame.
   */
  template <typename Visit>
  void ForEachOf(std::size_t element, const Visit& visit) const
  {
    if (this->Extent == D)
    {
      Point<D> centroid{};
      for (std::size_t i = 0; i <= D; ++i)
      {
        const Point<D>& p = this->All.PointOf(element, i);
        for (std::size_t a = 0; a < D; ++a)
        {
          centroid[a] += p[a] / (D + 1);
        }
      }
      visit(this->VoxelOf(this->Image.Grid().ToIndex(centroid)));
      return;
    }
    std::array<Point<D>, D + 1> corners;
    for (std::size_t i = 0; i <= D; ++i)
    {
      corners[i] = this->Image.Grid().ToIndex(this->All.PointOf(element, i));
    }
    constexpr std::size_t time = D - 1;
    const auto [first, last] = std::minmax_element(corners.begin(), corners.end(),
      [](const Point<D>& p, const Point<D>& q) { return p[time] < q[time]; });
    const auto end = std::llround(std::floor((*last)[time] + OnFrame));
    for (auto frame = std::llround(std::ceil((*first)[time] - OnFrame)); frame <= end; ++frame)
    {
      Point<D> centroid;
      if (CutCentroid(corners, static_cast<double>(frame), centroid))
      {
        visit(this->VoxelOf(centroid));
      }
    }
  }

  /** Calls visit with each voxel of the block of three voxels along each axis of a component. */
  template <typename Visit>
  void ForEachAround(const Index& centre, const Visit& visit) const
  {
    ForEachIndex(this->Shifted(centre, -1), this->Shifted(centre, 1), visit);
  }

  /** Shifted along each axis of a component. */
  Index Shifted(Index index, std::int64_t by) const
  {
    for (std::size_t a = 0; a < this->Extent; ++a)
    {
      index[a] += by;
    }
    return index;
  }

private:
  /** A point counts as lying at a frame's time if it is no farther from it, in frames. */
  static constexpr double OnFrame = 1e-9;

  /** The centroid of the corners of a cut. False if the cut has no volume. */
  static bool CutCentroid(
    const std::array<Point<D>, D + 1>& corners, double frame, Point<D>& centroid)
  {
    std::array<int, D + 1> side;
    for (std::size_t i = 0; i <= D; ++i)
    {
      const double after = corners[i][D - 1] - frame;
      side[i] = after > OnFrame ? 1 : after < -OnFrame ? -1 : 0;
    }
    centroid = {};
    std::size_t number = 0;
    const auto add = [&](const Point<D>& p)
    {
      for (std::size_t a = 0; a < D; ++a)
      {
        centroid[a] += p[a];
      }
      ++number;
    };
    for (std::size_t i = 0; i <= D; ++i)
    {
      if (side[i] == 0)
      {
        add(corners[i]);
      }
      for (std::size_t j = 0; j < i; ++j)
      {
        if (side[i] * side[j] < 0)
        {
          add(Interpolate(corners[i], corners[j],
            (frame - corners[i][D - 1]) / (corners[j][D - 1] - corners[i][D - 1])));
        }
      }
    }
    for (double& x : centroid)
    {
      x /= static_cast<double>(number);
    }
    return number >= D; // fewer corners span no volume
  }

  Index VoxelOf(const Point<D>& index) const
  {
    Index voxel;
    for (std::size_t a = 0; a < D; ++a)
    {
      voxel[a] = std::llround(index[a]) - this->Image.CropOrigin()[a];
    }
    return voxel;
  }

  const std::size_t Extent;
  const LabelImage<D>& Image;
  const Elements& All;
};

/** The voxels whose block (Places::ForEachAround) contains a voxel of some components. */
template <int D, typename Elements>
class Surroundings
{
public:
  using Index = typename GridGeometry<D>::Index;

  Surroundings(const Places<D, Elements>& places, const Index& dimensions)
    : Where(places)
    , Mask(places.Shifted(dimensions, 2))
  {
  }

  void Add(const Components<D>& components, std::uint32_t component)
  {
    components.ForEachRun(component,
      [this](const Index& first, std::int64_t length)
      {
        Index high =
          this->Where.Shifted(first, 2); // one voxel farther, in a mask that begins at -1
        high[0] += length - 1;
        ForEachIndex(first, high, [this](const Index& at) { this->Mask.Set(at); });
      });
  }

  bool Contain(const Index& voxel) const
  {
    const Index at = this->Where.Shifted(voxel, 1);
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
  const Places<D, Elements>& Where;
  BitMask<D> Mask;
};

//------------------------------------------------------------------------------------------------
/** FindLostComponents() among the elements of either kind. */
template <int D, typename Elements>
std::vector<std::uint32_t> FindLost(const Components<D>& components, const LabelImage<D>& image,
  const Elements& elements, const std::vector<bool>& wanted, unsigned threads,
  const std::stop_token& stop)
{
  using Index = typename GridGeometry<D>::Index;
  const std::vector<Component<D>>& all = components.All();
  const Places<D, Elements> places(components, image, elements);
  const auto found = std::make_unique<std::atomic<bool>[]>(all.size());
  // Most elements belong to labels whose components have all been found.
  const auto missing = std::make_unique<std::atomic<std::uint32_t>[]>(image.Values().size());
  for (std::size_t c = 0; c < all.size(); ++c)
  {
    missing[all[c].Label] += wanted[c] ? 1u : 0u;
  }
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
  /** Calls visit(element, label) for the elements of labels with components that are missing. */
  const auto forEachOfMissing = [&](auto&& visit)
  {
    constexpr std::size_t ElementsAtOnce = 4096;
    ParallelFor(
      0, elements.Size(), ElementsAtOnce, threads,
      [&](std::size_t begin, std::size_t end)
      {
        typename Elements::LabelReader labelOf(elements);
        for (std::size_t s = begin; s < end; ++s)
        {
          const LabelId label = labelOf(s);
          if (missing[label].load(std::memory_order_relaxed) != 0)
          {
            visit(s, label);
          }
        }
      },
      stop);
  };
  forEachOfMissing([&](std::size_t s, LabelId label)
    { places.ForEachOf(s, [&](const Index& voxel) { mark(voxel, label); }); });

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
  Surroundings<D, Elements> near(places, image.CropDimensions());
  for (const std::uint32_t c : seemLost)
  {
    near.Add(components, c);
  }
  forEachOfMissing(
    [&](std::size_t s, LabelId label)
    {
      places.ForEachOf(s,
        [&](const Index& centre)
        {
          if (near.Contain(centre))
          {
            places.ForEachAround(centre, [&](const Index& voxel) { mark(voxel, label); });
          }
        });
    });
  return findLost();
}

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
std::vector<std::uint32_t> FindLostComponents(const Components<D>& components,
  const LabelImage<D>& image, const SimplexMesh<D>& mesh, const std::vector<bool>& wanted,
  unsigned threads, const std::stop_token& stop)
{
  return FindLost(components, image, MeshElements<D>(mesh, image), wanted, threads, stop);
}

template <int D>
std::vector<std::uint32_t> FindLostComponents(const Components<D>& components,
  const LabelImage<D>& image, const LabelledTriangulation<D>& elements,
  const std::vector<bool>& wanted, unsigned threads, const std::stop_token& stop)
{
  return FindLost(components, image, elements, wanted, threads, stop);
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
  const MeshElements<D> candidates(mesh, image);
  const Places<D, MeshElements<D>> places(all, image, candidates);
  Surroundings<D, MeshElements<D>> near(places, image.CropDimensions());
  std::vector<bool> isWanted(image.Values().size());
  for (const std::uint32_t c : components)
  {
    near.Add(all, c);
    isWanted[all.All()[c].Label] = true;
  }
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
  typename MeshElements<D>::LabelReader labelOf(candidates);
  for (std::size_t s = 0; s < mesh.Simplices.size(); ++s)
  {
    if (!isWanted[labelOf(s)])
    {
      continue;
    }
    places.ForEachOf(s,
      [&](const auto& centre)
      {
        if (near.Contain(centre))
        {
          places.ForEachAround(
            centre, [&](const auto& voxel) { consider(static_cast<std::uint32_t>(s), voxel); });
        }
      });
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
template std::vector<std::uint32_t> FindLostComponents<3>(const Components<3>&,
  const LabelImage<3>&, const LabelledTriangulation<3>&, const std::vector<bool>&, unsigned,
  const std::stop_token&);
template std::vector<std::uint32_t> FindWitnessesOf<3>(const std::vector<std::uint32_t>&,
  const Components<3>&, const LabelImage<3>&, const SimplexMesh<3>&);
template std::vector<std::uint32_t> FindWitnessesOf<4>(const std::vector<std::uint32_t>&,
  const Components<4>&, const LabelImage<4>&, const SimplexMesh<4>&);

} // namespace voxplex
