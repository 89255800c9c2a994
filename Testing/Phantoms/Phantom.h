// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// What an image of a known shape is made of.
#ifndef voxplex_Phantom_h
#define voxplex_Phantom_h

#include "Base/GridIndex.h"
#include "Image/GridGeometry.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace voxplex::phantoms
{

/** A grid, and what label each point of its frame has. */
template <int D>
struct PhantomOf
{
  GridGeometry<D> Grid;
  std::function<std::uint8_t(const Point<D>&)> Label;

  /** Labels of all voxels: x varies fastest, then y, z, t. */
  std::vector<std::uint8_t> Scalars() const
  {
    std::vector<std::uint8_t> scalars(CountCells(this->Grid.Dimensions));
    for (std::size_t k = 0; k < scalars.size(); ++k)
    {
      const auto index = IndexAt(k, this->Grid.Dimensions);
      Point<D> at;
      std::copy(index.begin(), index.end(), at.begin());
      scalars[k] = this->Label(this->Grid.ToFrame(at));
    }
    return scalars;
  }
};

} // namespace voxplex::phantoms

#endif
