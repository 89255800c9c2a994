// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LabelledTriangulation.h
 * @brief The elements of a mesh before it is made.
 */
#ifndef voxplex_LabelledTriangulation_h
#define voxplex_LabelledTriangulation_h

#include "Delaunay/Triangulation.h"
#include "Image/LabelImage.h"

#include <cstddef>
#include <span>

namespace voxplex
{

/**
 * @brief The simplices of a triangulation with their labels: the elements of the mesh. Their numbers are
 * the simplex ids.
 */
template <int D>
class LabelledTriangulation
{
public:
  static constexpr int Dimension = D;

  /**
   * All must outlive this object.
   * @param labels of each simplex id; 0 for simplices that are outside or do not exist
   */
  LabelledTriangulation(const Triangulation<D>& triangulation, std::span<const LabelId> labels)
    : Source(triangulation)
    , Labels(labels)
  {
  }

  const Triangulation<D>& GetTriangulation() const { return this->Source; }
  std::span<const LabelId> GetLabels() const { return this->Labels; }
  std::size_t Size() const { return this->Labels.size(); }
  const auto& NeighboursOf(std::size_t element) const
  {
    return this->Source.GetSimplex(static_cast<SimplexId>(element)).N;
  }

  /** The points of an element that has a label. */
  auto PointsOf(std::size_t element) const
  {
    return this->Source.Points(this->Source.GetSimplex(static_cast<SimplexId>(element)).V);
  }

private:
  const Triangulation<D>& Source;
  const std::span<const LabelId> Labels;
};

} // namespace voxplex

#endif
