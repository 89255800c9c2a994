// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// The .mesh file of a 4D mesh: the ASCII Gamma mesh format of libMeshb, version 2 (double
// precision), with the keyword Pentatopes. The reference of a pentatope is its label, that of a
// boundary tetrahedron the number of its pair of labels and side; comments tell which. The reference of a
// vertex of a slab is its number in the whole mesh, from 1 on; of other vertices 0.

#include "SpaceTimeMeshView.h"
#include "TextFile.h"
#include "Writers.h"

namespace voxplex::io
{
namespace
{

template <std::size_t N>
void WriteElement(TextFile& file, const std::array<vtkIdType, N>& vertices, std::int64_t reference)
{
  for (const vtkIdType vertex : vertices)
  {
    file << vertex + 1 << ' ';
  }
  file << reference << '\n';
}

void WriteSlabs(TextFile& file, const SpaceTimeMeshView& view)
{
  const std::vector<std::array<vtkIdType, 2>> pairs = view.PeriodicPairs();
  if (!pairs.empty())
  {
    file << "PeriodicVertices\n" << pairs.size() << '\n';
    for (const auto& [first, last] : pairs)
    {
      file << first + 1 << ' ' << last + 1 << '\n';
    }
  }
  const std::vector<vtkIdType> slabs = view.SlabsOfPentatopes();
  if (!slabs.empty())
  {
    file << "PrivateTable\n" << slabs.size() << '\n';
    for (const vtkIdType slab : slabs)
    {
      file << slab << '\n';
    }
  }
}

} // namespace

void WriteGMF(const SpaceTimeMeshData& mesh, const std::string& path)
{
  const SpaceTimeMeshView view(mesh);
  TextFile file(path);
  file << "MeshVersionFormatted 2\n"
       << "# Written by Voxplex. SPACE=" << mesh.Space << "; the fourth coordinate is the time.\n"
       << "# References of pentatopes are labels; those of tetrahedra, labels on both sides:\n";
  view.WritePairs(file);
  file << "Dimension 4\n";

  file << "Vertices\n" << view.NumberOfPoints() << '\n';
  for (vtkIdType i = 0; i < view.NumberOfPoints(); ++i)
  {
    const auto [x, y, z, t] = view.Point(i);
    file << x << ' ' << y << ' ' << z << ' ' << t << ' '
         << (view.IsSlab() ? view.NumberInWhole(i) + 1 : 0) << '\n';
  }

  file << "Tetrahedra\n" << view.Tetrahedra().size() << '\n';
  for (const auto& [vertices, number] : view.Tetrahedra())
  {
    WriteElement(file, vertices, number);
  }

  file << "Pentatopes\n" << view.NumberOfPentatopes() << '\n';
  for (vtkIdType cell = 0; cell < view.NumberOfPentatopes(); ++cell)
  {
    WriteElement(file, view.Pentatope(cell), view.LabelOf(cell));
  }
  WriteSlabs(file, view);
  file << "End\n";
  file.Close();
}

} // namespace voxplex::io
