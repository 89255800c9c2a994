// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LabelledCells.h
 * @brief The elements of a mesh as optimisation has them.
 */
#ifndef voxplex_LabelledCells_h
#define voxplex_LabelledCells_h

#include "Geometry/Point.h"
#include "Image/LabelImage.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace voxplex
{

/** A simplex that knows its neighbours. */
template <int D>
struct Cell
{
  using Corners = std::array<std::uint32_t, static_cast<std::size_t>(D + 1)>;

  Corners V; ///< vertices, positively oriented
  Corners N; ///< N[i] is the neighbour across the facet opposite to V[i], or None
};

/** @brief Cells with their labels, as LabelledTriangulation has simplices. All must outlive this. */
template <int D>
class LabelledCells
{
public:
  static constexpr int Dimension = D;

  /** @param labels of each cell; 0 for those that are outside. All cells exist. */
  LabelledCells(std::span<const Point<D>> points, std::span<const Cell<D>> cells,
    std::span<const LabelId> labels)
    : Points(points)
    , Cells(cells)
    , Labels(labels)
  {
  }

  std::span<const LabelId> GetLabels() const { return this->Labels; }
  std::size_t Size() const { return this->Cells.size(); }
  const auto& NeighboursOf(std::size_t element) const { return this->Cells[element].N; }

  auto PointsOf(std::size_t element) const
  {
    std::array<const Point<D>*, static_cast<std::size_t>(D + 1)> points;
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      points[i] = &this->Points[this->Cells[element].V[i]];
    }
    return points;
  }

private:
  const std::span<const Point<D>> Points;
  const std::span<const Cell<D>> Cells;
  const std::span<const LabelId> Labels;
};

} // namespace voxplex

#endif
