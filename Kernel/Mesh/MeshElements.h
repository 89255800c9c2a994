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
#include <span>
#include <vector>

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

  /** Labels that the image does not have are 0. @param mesh must outlive this object */
  MeshElements(const SimplexMesh<D>& mesh, const LabelImage<D>& image)
    : Mesh(mesh)
    , Labels(mesh.Labels.size())
  {
    for (std::size_t s = 0; s < this->Labels.size(); ++s)
    {
      this->Labels[s] = s > 0 && mesh.Labels[s] == mesh.Labels[s - 1]
        ? this->Labels[s - 1]
        : LabelIdOf(mesh.Labels[s], image);
    }
  }

  std::span<const LabelId> GetLabels() const { return this->Labels; }
  std::size_t Size() const { return this->Mesh.Simplices.size(); }

  auto PointsOf(std::size_t element) const { return this->Mesh.PointsOf(element); }

private:
  const SimplexMesh<D>& Mesh;
  std::vector<LabelId> Labels;
};

} // namespace voxplex

#endif
