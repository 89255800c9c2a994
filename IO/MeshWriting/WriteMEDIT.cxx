// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// The .mesh file: MEDIT's ASCII format, which is the Gamma mesh format of libMeshb, version 2 (double precision). The
// reference of an element is its label, that of a facet the number of its pair of labels and, in 4D, its side; comments
// tell which. 4D meshes have the keyword Pentatopes. The reference of a vertex of a slab is its number in the whole
// mesh, from 1 on; of other vertices 0.

#include "MeshView.h"
#include "SetNames.h"
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

/** The order of the cells is kept, so that cell i is cell i of the other formats. */
template <typename TView>
void WriteCells(TextFile& file, const TView& view, const char* facets, const char* elements)
{
  file << facets << '\n' << view.NumberOfFacets() << '\n';
  for (vtkIdType i = 0; i < view.NumberOfFacets(); ++i)
  {
    WriteElement(file, view.Facet(i), view.FacetNumber(i));
  }
  file << elements << '\n' << view.NumberOfElements() << '\n';
  for (vtkIdType i = 0; i < view.NumberOfElements(); ++i)
  {
    WriteElement(file, view.Element(i), view.LabelOf(i));
  }
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

void WriteMEDIT(const MeshData& mesh, const std::string& path)
{
  const MeshView view(mesh);
  const SetNames names(view, QuotedNames);
  TextFile file(path);
  file << "MeshVersionFormatted 2\n"
       << "# Written by Voxplex. SPACE=" << mesh.Space << '\n'
       << "# References of tetrahedra are labels:\n";
  WriteLabelNames(file, view, names, "#");
  file << "# References of triangles, labels on both sides:\n";
  WritePairNames(file, view, names, "#");
  file << "Dimension 3\nVertices\n" << view.NumberOfPoints() << '\n';
  for (vtkIdType i = 0; i < view.NumberOfPoints(); ++i)
  {
    const auto [x, y, z] = view.Point(i);
    file << x << ' ' << y << ' ' << z << " 0\n";
  }
  WriteCells(file, view, "Triangles", "Tetrahedra");
  file << "End\n";
  file.Close();
}

void WriteGMF(const SpaceTimeMeshData& mesh, const std::string& path)
{
  const SpaceTimeMeshView view(mesh);
  TextFile file(path);
  file << "MeshVersionFormatted 2\n"
       << "# Written by Voxplex. SPACE=" << mesh.Space << "; the fourth coordinate is the time.\n"
       << "# References of pentatopes are labels; those of tetrahedra, labels on both sides:\n";
  view.WritePairs(file);
  file << "Dimension 4\nVertices\n" << view.NumberOfPoints() << '\n';
  for (vtkIdType i = 0; i < view.NumberOfPoints(); ++i)
  {
    const auto [x, y, z, t] = view.Point(i);
    file << x << ' ' << y << ' ' << z << ' ' << t << ' '
         << (view.IsSlab() ? view.NumberInWhole(i) + 1 : 0) << '\n';
  }
  WriteCells(file, view, "Tetrahedra", "Pentatopes");
  WriteSlabs(file, view);
  file << "End\n";
  file.Close();
}

} // namespace voxplex::io
