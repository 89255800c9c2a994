// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// The .mfem file: 'MFEM mesh v1.0' with dimension 4, as MFEM's branch 4d_dev reads it. The attribute
// of a pentatope is its label, that of a boundary tetrahedron the number of its pair of labels;
// comments tell which.

#include "SpaceTimeMeshView.h"
#include "TextFile.h"
#include "Writers.h"

namespace voxplex::cli
{
namespace
{

/** mfem::Geometry::Type. */
constexpr int Tetrahedron = 4;
constexpr int Pentatope = 8;

/** "attribute geometry vertices". */
template <std::size_t N>
void WriteElement(
  TextFile& file, std::int64_t attribute, int geometry, const std::array<vtkIdType, N>& vertices)
{
  file << attribute << ' ' << geometry;
  for (const vtkIdType vertex : vertices)
  {
    file << ' ' << vertex;
  }
  file << '\n';
}

} // namespace

void WriteMFEM(const SpaceTimeMeshData& mesh, const std::string& path)
{
  const SpaceTimeMeshView view(mesh);
  TextFile file(path);
  file << "MFEM mesh v1.0\n\n"
       << "# Written by Voxplex. SPACE=" << mesh.Space << "; the fourth coordinate is the time.\n"
       << "# Attributes of elements are labels; those of the boundary, labels on both sides:\n";
  view.WritePairs(file);

  file << "\ndimension\n4\n\nelements\n" << view.NumberOfPentatopes() << '\n';
  for (vtkIdType cell = 0; cell < view.NumberOfPentatopes(); ++cell)
  {
    WriteElement(file, view.LabelOf(cell), Pentatope, view.Pentatope(cell));
  }

  file << "\nboundary\n" << view.NumberOfTetrahedra() << '\n';
  for (vtkIdType cell = 0; cell < view.NumberOfTetrahedra(); ++cell)
  {
    WriteElement(file, view.NumberOf(cell), Tetrahedron, view.Tetrahedron(cell));
  }

  file << "\nvertices\n" << view.NumberOfPoints() << "\n4\n";
  for (vtkIdType i = 0; i < view.NumberOfPoints(); ++i)
  {
    const auto [x, y, z, t] = view.Point(i);
    file << x << ' ' << y << ' ' << z << ' ' << t << '\n';
  }
  file.Close();
}

} // namespace voxplex::cli
