// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Quality/LostComponents.h"

#include "Base/GridIndex.h"
#include "Image/BitMask.h"
#include "Mesh/LabelledCells.h"
#include "Mesh/MeshElements.h"
#include "Parallel/ParallelFor.h"
#include "Quality/ElementVoxels.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <memory>

namespace voxplex
{

namespace
{

/** The voxels whose block (ElementVoxels::ForEachAround) contains a voxel of some components. */
template <int D>
class Surroundings
{
public:
  using Index = typename GridGeometry<D>::Index;

  Surroundings(const ElementVoxels<D>& voxels, const Index& dimensions)
    : Voxels(voxels)
    , Mask(voxels.Shifted(dimensions, 2))
  {
  }

  void Add(const Components<D>& components, std::uint32_t component)
  {
    components.ForEachRun(component,
      [this](const Index& first, std::int64_t length)
      {
        Index high =
          this->Voxels.Shifted(first, 2); // one voxel farther, in a mask that begins at -1
        high[0] += length - 1;
        ForEachIndex(first, high, [this](const Index& at) { this->Mask.Set(at); });
      });
  }

  bool Contain(const Index& voxel) const
  {
    const Index at = this->Voxels.Shifted(voxel, 1);
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
  const ElementVoxels<D>& Voxels;
  BitMask<D> Mask;
};

/** Makes a number that threads share the smaller one. @return whether it was None */
bool Lower(std::atomic<std::uint32_t>& number, std::uint32_t to)
{
  std::uint32_t old = number.load(std::memory_order_relaxed); // None is the largest number
  while (to < old && !number.compare_exchange_weak(old, to, std::memory_order_relaxed))
  {
  }
  return old == None;
}

//------------------------------------------------------------------------------------------------
/** Finds elements that keep components from being lost. */
template <int D, typename Elements>
class WitnessSearch
{
public:
  using Index = typename GridGeometry<D>::Index;

  /** @param wantsFirst whether the witness of a component is its first one; otherwise it is any */
  WitnessSearch(const Components<D>& components, const LabelImage<D>& image,
    const Elements& elements, const std::vector<bool>& wanted, bool wantsFirst, unsigned threads,
    const std::stop_token& stop)
    : All(components)
    , Image(image)
    , Of(elements)
    , Wanted(wanted)
    , WantsFirst(wantsFirst)
    , Threads(threads)
    , Stop(stop)
    , Voxels(components, image)
    , Witnesses(std::make_unique<std::atomic<std::uint32_t>[]>(components.All().size()))
    , Missing(std::make_unique<std::atomic<std::uint32_t>[]>(image.Values().size()))
  {
    for (std::size_t c = 0; c < components.All().size(); ++c)
    {
      this->Witnesses[c] = None;
      this->Missing[components.All()[c].Label] += wanted[c] ? 1u : 0u;
    }
  }

  /** A witness of each component; None if it is lost or not wanted. */
  std::vector<std::uint32_t> Find()
  {
    this->ForEachOfMissing(
      [&](std::size_t s, LabelId label)
      {
        this->Voxels.ForEachVoxel(
          this->Of.PointsOf(s), [&](const Index& voxel) { this->Mark(voxel, label, s); });
      });
    std::vector<std::uint32_t> found = this->Copy();
    Surroundings<D> near(this->Voxels, this->Image.CropDimensions());
    bool anyLost = false;
    for (std::uint32_t c = 0; c < found.size(); ++c)
    {
      if (this->Wanted[c] && found[c] == None)
      {
        near.Add(this->All, c);
        anyLost = true;
      }
    }
    if (!anyLost)
    {
      return found;
    }
    this->ForEachOfMissing(
      [&](std::size_t s, LabelId label)
      {
        this->Voxels.ForEachVoxel(this->Of.PointsOf(s),
          [&](const Index& centre)
          {
            if (near.Contain(centre))
            {
              this->Voxels.ForEachAround(
                centre, [&](const Index& voxel) { this->Mark(voxel, label, s); });
            }
          });
      });
    const std::vector<std::uint32_t> around = this->Copy();
    for (std::size_t c = 0; c < found.size(); ++c)
    {
      found[c] = found[c] == None ? around[c] : found[c];
    }
    return found;
  }

private:
  void Mark(const Index& voxel, LabelId label, std::size_t element)
  {
    const std::uint32_t c = this->All.At(voxel);
    if (c != None && this->Wanted[c] && this->All.All()[c].Label == label &&
      Lower(this->Witnesses[c], static_cast<std::uint32_t>(element)))
    {
      this->Missing[label].fetch_sub(1, std::memory_order_relaxed);
    }
  }

  /**
   * Calls visit(element, label) for the elements of labels with wanted components; unless the first
   * witness is wanted, no more for those whose components have all been found. Those are most.
   */
  template <typename Visit>
  void ForEachOfMissing(const Visit& visit)
  {
    std::vector<bool> isWanted(this->Image.Values().size());
    for (std::size_t label = 0; label < isWanted.size(); ++label)
    {
      isWanted[label] = this->Missing[label] != 0;
    }
    constexpr std::size_t ElementsAtOnce = 4096;
    ParallelFor(
      0, this->Of.Size(), ElementsAtOnce, this->Threads,
      [&](std::size_t begin, std::size_t end)
      {
        const std::span<const LabelId> labels = this->Of.GetLabels();
        for (std::size_t s = begin; s < end; ++s)
        {
          const LabelId label = labels[s];
          if (isWanted[label] &&
            (this->WantsFirst || this->Missing[label].load(std::memory_order_relaxed) != 0))
          {
            visit(s, label);
          }
        }
      },
      this->Stop);
  }

  std::vector<std::uint32_t> Copy() const
  {
    return std::vector<std::uint32_t>(
      this->Witnesses.get(), this->Witnesses.get() + this->All.All().size());
  }

  const Components<D>& All;
  const LabelImage<D>& Image;
  const Elements& Of;
  const std::vector<bool>& Wanted;
  const bool WantsFirst;
  const unsigned Threads;
  const std::stop_token& Stop;
  const ElementVoxels<D> Voxels;
  std::unique_ptr<std::atomic<std::uint32_t>[]> Witnesses; ///< by component
  std::unique_ptr<std::atomic<std::uint32_t>[]> Missing;   ///< wanted components by label
};

} // namespace

//------------------------------------------------------------------------------------------------
template <int D, typename Elements>
std::vector<std::uint32_t> FindLostComponents(const Components<D>& components,
  const LabelImage<D>& image, const Elements& elements, const std::vector<bool>& wanted,
  unsigned threads, const std::stop_token& stop)
{
  const std::vector<std::uint32_t> witnesses =
    WitnessSearch<D, Elements>(components, image, elements, wanted, false, threads, stop).Find();
  std::vector<std::uint32_t> lost;
  for (std::uint32_t c = 0; c < witnesses.size(); ++c)
  {
    if (wanted[c] && witnesses[c] == None)
    {
      lost.push_back(c);
    }
  }
  return lost;
}

template <int D>
std::vector<std::uint32_t> FindLostComponents(const Components<D>& components,
  const LabelImage<D>& image, const SimplexMesh<D>& mesh, const std::vector<bool>& wanted,
  unsigned threads, const std::stop_token& stop)
{
  return FindLostComponents(components, image, MeshElements<D>(mesh, image), wanted, threads, stop);
}

//------------------------------------------------------------------------------------------------
template <int D, typename Elements>
std::vector<std::uint32_t> FindFirstWitnesses(const Components<D>& components,
  const LabelImage<D>& image, const Elements& elements, const std::vector<bool>& wanted,
  unsigned threads, const std::stop_token& stop)
{
  return WitnessSearch<D, Elements>(components, image, elements, wanted, true, threads, stop)
    .Find();
}

template std::vector<std::uint32_t> FindLostComponents(const Components<3>&, const LabelImage<3>&,
  const SimplexMesh<3>&, const std::vector<bool>&, unsigned, const std::stop_token&);
template std::vector<std::uint32_t> FindLostComponents(const Components<3>&, const LabelImage<3>&,
  const LabelledTriangulation<3>&, const std::vector<bool>&, unsigned, const std::stop_token&);
template std::vector<std::uint32_t> FindLostComponents(const Components<3>&, const LabelImage<3>&,
  const LabelledCells<3>&, const std::vector<bool>&, unsigned, const std::stop_token&);
template std::vector<std::uint32_t> FindLostComponents(const Components<4>&, const LabelImage<4>&,
  const SimplexMesh<4>&, const std::vector<bool>&, unsigned, const std::stop_token&);
template std::vector<std::uint32_t> FindLostComponents(const Components<4>&, const LabelImage<4>&,
  const LabelledTriangulation<4>&, const std::vector<bool>&, unsigned, const std::stop_token&);
template std::vector<std::uint32_t> FindLostComponents(const Components<4>&, const LabelImage<4>&,
  const LabelledCells<4>&, const std::vector<bool>&, unsigned, const std::stop_token&);
template std::vector<std::uint32_t> FindFirstWitnesses(const Components<3>&, const LabelImage<3>&,
  const LabelledCells<3>&, const std::vector<bool>&, unsigned, const std::stop_token&);
template std::vector<std::uint32_t> FindFirstWitnesses(const Components<4>&, const LabelImage<4>&,
  const LabelledCells<4>&, const std::vector<bool>&, unsigned, const std::stop_token&);

} // namespace voxplex
