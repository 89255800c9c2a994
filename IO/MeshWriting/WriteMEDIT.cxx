// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// The .mesh file: MEDIT's ASCII format, version 2 (double precision). The reference of a
// tetrahedron is its label, that of a triangle the number of its pair of labels; comments tell
// which.

#include "MeshView.h"
#include "SetNames.h"
#include "TextFile.h"
#include "Writers.h"

namespace voxplex::io
{
namespace
{

void WriteHeader(TextFile& file, const MeshView& view, const std::string& space)
{
  const SetNames names(view, QuotedNames);
  file << "MeshVersionFormatted 2\n"
       << "# Written by Voxplex. SPACE=" << space << '\n'
       << "# References of tetrahedra are labels:\n";
  WriteLabelNames(file, view, names, "#");
  file << "# References of triangles, labels on both sides:\n";
  WritePairNames(file, view, names, "#");
  file << "Dimension 3\n";
}

} // namespace

void WriteMEDIT(const MeshData& mesh, const std::string& path)
{
  const MeshView view(mesh);
  TextFile file(path);
  WriteHeader(file, view, mesh.Space);

  file << "Vertices\n" << view.NumberOfPoints() << '\n';
  for (vtkIdType i = 0; i < view.NumberOfPoints(); ++i)
  {
    const auto [x, y, z] = view.Point(i);
    file << x << ' ' << y << ' ' << z << " 0\n";
  }

  // The order of the cells is kept, so that cell i is cell i of the other formats.
  file << "Triangles\n" << view.Triangles.size() << '\n';
  for (std::size_t i = 0; i < view.Triangles.size(); ++i)
  {
    const auto& [a, b, c] = view.Triangles[i];
    file << a + 1 << ' ' << b + 1 << ' ' << c + 1 << ' '
         << view.PairNumber.at(view.PairOfTriangle[i]) << '\n';
  }

  file << "Tetrahedra\n" << view.Tetrahedra.size() << '\n';
  for (std::size_t i = 0; i < view.Tetrahedra.size(); ++i)
  {
    const auto& [a, b, c, d] = view.Tetrahedra[i];
    file << a + 1 << ' ' << b + 1 << ' ' << c + 1 << ' ' << d + 1 << ' '
         << view.LabelOfTetrahedron[i] << '\n';
  }
  file << "End\n";
  file.Close();
}

} // namespace voxplex::io
