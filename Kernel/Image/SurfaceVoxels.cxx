// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Image/SurfaceVoxels.h"

#include "Base/GridIndex.h"
#include "Base/VectorClones.h"
#include "Parallel/ParallelFor.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace voxplex
{

namespace
{

/** Makes numbers differ from 0 where two rows differ. */
VOXPLEX_VECTOR_CLONES void AddDifferences(
  const LabelId* a, const LabelId* b, std::size_t length, LabelId* numbers)
{
  for (std::size_t i = 0; i < length; ++i)
  {
    numbers[i] |= a[i] ^ b[i];
  }
}

/** A bit for each of 64 ids that is not 0. In most words none is set. */
VOXPLEX_VECTOR_CLONES std::uint64_t WordOf(const LabelId* ids)
{
  LabelId any = 0;
  for (std::size_t i = 0; i < 64; ++i)
  {
    any |= ids[i];
  }
  if (any == 0)
  {
    return 0;
  }
  std::array<std::uint8_t, 64> flags;
  for (std::size_t i = 0; i < 64; ++i)
  {
    flags[i] = ids[i] != 0;
  }
  std::uint64_t word = 0;
  for (std::size_t byte = 0; byte < 8; ++byte)
  {
    std::uint64_t eight = 0;
    std::memcpy(&eight, flags.data() + byte * 8, 8);
    // Gathers the lowest bits of eight bytes (little-endian) in the top byte.
    word |= ((eight * 0x0102040810204080u) >> 56) << (8 * byte);
  }
  return word;
}

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
BitMask<D> FindSurfaceVoxels(
  const LabelImage<D>& image, unsigned threads, const std::stop_token& stop)
{
  using Index = typename GridGeometry<D>::Index;
  const Index& crop = image.CropDimensions();
  Index lattice = crop;
  for (std::int64_t& n : lattice)
  {
    n += 2;
  }
  BitMask<D> sites(lattice);
  const auto n = static_cast<std::size_t>(crop[0]);
  const std::vector<LabelId> background(n, LabelId{ 0 });

  // The ids of a row, by its lattice index; background if the row is outside the crop.
  const auto rowAt = [&](Index index)
  {
    ClampToCut(image, index);
    std::int64_t at = 0;
    for (std::size_t a = D; a-- > 1;)
    {
      if (index[a] < 1 || index[a] > crop[a])
      {
        return background.data();
      }
      at = at * crop[a] + index[a] - 1;
    }
    return image.Ids().data() + at * crop[0];
  };
  ParallelFor(
    0, sites.NumberOfRows(), 64, threads,
    [&](std::size_t begin, std::size_t end)
    {
      std::vector<LabelId> differs(sites.WordsPerRow() * 64, LabelId{ 0 }); // by lattice index
      LabelId* const inCrop = differs.data() + 1;
      for (std::size_t row = begin; row < end; ++row)
      {
        const Index index = IndexAt(row * static_cast<std::size_t>(lattice[0]), lattice);
        const LabelId* own = rowAt(index);
        std::fill(inCrop, inCrop + n, LabelId{ 0 });
        for (std::size_t a = 1; a < D; ++a)
        {
          Index neighbour = index;
          --neighbour[a];
          AddDifferences(own, rowAt(neighbour), n, inCrop);
          neighbour[a] += 2;
          AddDifferences(own, rowAt(neighbour), n, inCrop);
        }
        AddDifferences(own, own + 1, n - 1, inCrop);
        AddDifferences(own + 1, own, n - 1, inCrop + 1);
        // Along x, the voxels beyond the crop's two ends are background. They may be sites, too.
        inCrop[0] |= own[0];
        inCrop[n - 1] |= own[n - 1];
        differs[0] = own[0];
        differs[n + 1] = own[n - 1];
        const std::span<std::uint64_t> words = sites.Row(row);
        for (std::size_t w = 0; w < words.size(); ++w)
        {
          words[w] = WordOf(differs.data() + w * 64);
        }
      }
    },
    stop);
  return sites;
}

template BitMask<3> FindSurfaceVoxels(const LabelImage<3>&, unsigned, const std::stop_token&);
template BitMask<4> FindSurfaceVoxels(const LabelImage<4>&, unsigned, const std::stop_token&);

} // namespace voxplex
