// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LabelledTriangulation.h
 * @brief The elements of a mesh before it is extracted.
 */
#ifndef voxplex_LabelledTriangulation_h
#define voxplex_LabelledTriangulation_h

#include "Delaunay/Triangulation.h"
#include "Mesh/Subdivision.h"

#include <cstddef>
#include <span>

namespace voxplex
{

/**
 * @brief The simplices of a triangulation with their labels, some of them replaced by pieces: the
 * elements that ExtractMesh() and Subdivide() make of them, in another order.
 *
 * Elements 0 ... SimplexIdEnd() - 1 are the simplices by their ids; then come the pieces.
 */
template <int D>
class LabelledTriangulation
{
public:
  /**
   * All must outlive this object.
   * @param labels of each simplex id; 0 for simplices that are outside or do not exist
   */
  LabelledTriangulation(const Triangulation<D>& triangulation, std::span<const LabelId> labels,
    const Subdivision<D>& parts)
    : Source(triangulation)
    , Labels(labels)
    , Parts(parts)
    , VertexEnd(triangulation.VertexIdEnd())
  {
  }

  const Triangulation<D>& GetTriangulation() const { return this->Source; }

  /** The label of each simplex id, also of those that are replaced by pieces. */
  std::span<const LabelId> GetLabels() const { return this->Labels; }

  const Subdivision<D>& GetParts() const { return this->Parts; }

  std::size_t Size() const { return this->Labels.size() + this->Parts.Pieces.size(); }

  /** Point i of an element that has a label. */
  const Point<D>& PointOf(std::size_t element, std::size_t i) const
  {
    if (element < this->Labels.size())
    {
      return this->Source.Position(this->Source.GetSimplex(static_cast<SimplexId>(element)).V[i]);
    }
    const VertexId v = this->Parts.Pieces[element - this->Labels.size()].V[i];
    return v < this->VertexEnd ? this->Source.Position(v) : this->Parts.Points[v - this->VertexEnd];
  }

  /** Tells the labels of elements that are asked for in ascending order; 0 if not in the mesh. */
  class LabelReader
  {
  public:
    explicit LabelReader(const LabelledTriangulation& elements)
      : Of(elements)
    {
    }

    LabelId operator()(std::size_t element)
    {
      if (element >= this->Of.Labels.size())
      {
        return this->Of.Parts.Pieces[element - this->Of.Labels.size()].Label;
      }
      const auto& replaced = this->Of.Parts.Replaced;
      while (this->NextReplaced < replaced.size() && replaced[this->NextReplaced] < element)
      {
        ++this->NextReplaced;
      }
      const bool isReplaced =
        this->NextReplaced < replaced.size() && replaced[this->NextReplaced] == element;
      return isReplaced ? LabelId{ 0 } : this->Of.Labels[element];
    }

  private:
    const LabelledTriangulation& Of;
    std::size_t NextReplaced = 0;
  };

private:
  const Triangulation<D>& Source;
  const std::span<const LabelId> Labels;
  const Subdivision<D>& Parts;
  const VertexId VertexEnd;
};

} // namespace voxplex

#endif
