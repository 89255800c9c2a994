// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "ElementFaces.h"

#include "FileError.h"
#include "MeshView.h"

#include <algorithm>
#include <array>
#include <unordered_map>

namespace voxplex::io
{
namespace
{

using Vertices = std::array<vtkIdType, 3>;

struct Hash
{
  std::size_t operator()(const Vertices& v) const
  {
    constexpr std::size_t prime = 0x9e3779b97f4a7c15;
    std::size_t hash = 0;
    for (const vtkIdType vertex : v)
    {
      hash = (hash ^ static_cast<std::size_t>(vertex)) * prime;
    }
    return hash ^ (hash >> 32U);
  }
};

Vertices Sorted(Vertices v)
{
  std::sort(v.begin(), v.end());
  return v;
}

Vertices FaceOpposite(const std::array<vtkIdType, 4>& tetrahedron, std::size_t vertex)
{
  return { tetrahedron[(vertex + 1) % 4], tetrahedron[(vertex + 2) % 4],
    tetrahedron[(vertex + 3) % 4] };
}

} // namespace

std::vector<ElementFace> FindElementFaces(const MeshView& view)
{
  std::unordered_map<Vertices, std::size_t, Hash> triangles;
  triangles.reserve(view.Triangles.size());
  for (std::size_t i = 0; i < view.Triangles.size(); ++i)
  {
    triangles.emplace(Sorted(view.Triangles[i]), i);
  }
  std::vector<ElementFace> faces(view.Triangles.size(), ElementFace{ -1, 0 });
  for (std::size_t cell = 0; cell < view.Tetrahedra.size(); ++cell)
  {
    for (std::size_t vertex = 0; vertex < 4; ++vertex)
    {
      const auto found = triangles.find(Sorted(FaceOpposite(view.Tetrahedra[cell], vertex)));
      if (found != triangles.end() &&
        view.PairOfTriangle[found->second].first == view.LabelOfTetrahedron[cell])
      {
        faces[found->second] = { static_cast<vtkIdType>(cell), static_cast<int>(vertex) };
      }
    }
  }
  const bool isComplete = std::all_of(
    faces.begin(), faces.end(), [](const ElementFace& face) { return face.Tetrahedron >= 0; });
  RefuseIf(!isComplete,
    "the interfaces are not those of this mesh: one of their triangles is no face "
    "of a tetrahedron with its label");
  return faces;
}

} // namespace voxplex::io
