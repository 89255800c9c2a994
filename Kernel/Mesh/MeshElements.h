// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshElements.h
 * @brief The elements of a mesh with the label ids of its image.
 */
#ifndef voxplex_MeshElements_h
#define voxplex_MeshElements_h

#include "Image/LabelImage.h"
#include "Mesh/SimplexMesh.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace voxplex
{

/** The id of a label value of an image; 0 if the image does not have it. */
template <int D>
LabelId LabelIdOf(std::int64_t value, const LabelImage<D>& image)
{
  const auto values = image.Values();
  const auto at = std::lower_bound(values.begin() + 1, values.end(), value); // after background
  return at != values.end() && *at == value ? static_cast<LabelId>(at - values.begin())
                                            : LabelId{ 0 };
}

/** @brief The elements of a mesh, as LabelledTriangulation has them. */
template <int D>
class MeshElements
{
public:
  static constexpr int Dimension = D;

  /** Both must outlive this object. */
  MeshElements(const SimplexMesh<D>& mesh, const LabelImage<D>& image)
    : Mesh(mesh)
    , Image(image)
  {
  }

  std::size_t Size() const { return this->Mesh.Simplices.size(); }

  auto PointsOf(std::size_t element) const { return this->Mesh.PointsOf(element); }

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
        this->Label = LabelIdOf(this->Value, this->Of.Image);
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
  const LabelImage<D>& Image;
};

} // namespace voxplex

#endif
