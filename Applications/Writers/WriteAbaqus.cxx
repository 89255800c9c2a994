// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// The .inp file: Abaqus, one block of C3D4 elements and one element set a label, and one set of
// nodes for each pair of labels, to put boundary conditions on.

#include "MeshView.h"
#include "TextFile.h"
#include "Writers.h"

#include <algorithm>

namespace voxplex::cli
{
namespace
{

/** Data lines of a set hold at most 16 numbers. */
void WriteSet(TextFile& file, const std::vector<vtkIdType>& ids)
{
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    const bool last = i + 1 == ids.size() || i % 16 == 15;
    file << ids[i] + 1 << (last ? "\n" : ", ");
  }
}

std::vector<vtkIdType> NodesOf(const MeshView& view, const MeshView::CellIds& triangles)
{
  std::vector<vtkIdType> nodes;
  nodes.reserve(3 * triangles.size());
  for (const vtkIdType cell : triangles)
  {
    const auto& vertices = view.Triangles[static_cast<std::size_t>(cell)];
    nodes.insert(nodes.end(), vertices.begin(), vertices.end());
  }
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

} // namespace

void WriteAbaqus(const MeshData& mesh, const std::string& path)
{
  const MeshView view(mesh);
  TextFile file(path);
  file << "*HEADING\nWritten by Voxplex. SPACE=" << mesh.Space << "\n*NODE\n";
  for (vtkIdType i = 0; i < view.NumberOfPoints(); ++i)
  {
    const auto [x, y, z] = view.Point(i);
    file << i + 1 << ", " << x << ", " << y << ", " << z << '\n';
  }
  for (const auto& [label, cells] : view.TetrahedraOfLabel)
  {
    file << "*ELEMENT, TYPE=C3D4, ELSET=LABEL_" << label << '\n';
    for (const vtkIdType cell : cells)
    {
      const auto& [a, b, c, d] = view.Tetrahedra[static_cast<std::size_t>(cell)];
      file << cell + 1 << ", " << a + 1 << ", " << b + 1 << ", " << c + 1 << ", " << d + 1 << '\n';
    }
  }
  for (const auto& [pair, cells] : view.TrianglesOfPair)
  {
    file << "*NSET, NSET=INTERFACE_" << pair.first << '_' << pair.second << '\n';
    WriteSet(file, NodesOf(view, cells));
  }
  file.Close();
}

} // namespace voxplex::cli
