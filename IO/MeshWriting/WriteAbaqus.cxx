// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// The .inp file: Abaqus, and CalculiX, which reads a part of its language. A block of C3D4 elements
// and an element set for each label; for each pair of labels a surface of element faces, to put
// loads on, and a set of nodes, to put boundary conditions on.

#include "FileError.h"
#include "MeshView.h"
#include "SetNames.h"
#include "TextFile.h"
#include "Writers.h"

#include <algorithm>
#include <charconv>
#include <map>

namespace voxplex::io
{
namespace
{

using Vertices = std::array<vtkIdType, 3>;

Vertices Sorted(Vertices v)
{
  std::sort(v.begin(), v.end());
  return v;
}

/** An element and its vertex, 0 to 3, that the face does not have. */
struct ElementFace
{
  std::size_t Tetrahedron;
  std::size_t OppositeVertex;
};

/**
 * For each triangle the tetrahedron with the first, larger label of its pair. Its normal points out of that.
 *
 * @throws FileError: a triangle is no face of such a tetrahedron, so these are not the interfaces of this mesh
 */
std::vector<ElementFace> FindElementFaces(const MeshView& view)
{
  std::map<Vertices, std::size_t> triangles;
  for (std::size_t i = 0; i < view.Triangles.size(); ++i)
  {
    triangles.emplace(Sorted(view.Triangles[i]), i);
  }
  constexpr std::size_t none = 4;
  std::vector<ElementFace> faces(view.Triangles.size(), ElementFace{ 0, none });
  for (std::size_t cell = 0; cell < view.Tetrahedra.size(); ++cell)
  {
    for (std::size_t vertex = 0; vertex < 4; ++vertex)
    {
      const auto& all = view.Tetrahedra[cell];
      const auto found = triangles.find(
        Sorted({ all[(vertex + 1) % 4], all[(vertex + 2) % 4], all[(vertex + 3) % 4] }));
      if (found != triangles.end() &&
        view.PairOfTriangle[found->second].first == view.LabelOfTetrahedron[cell])
      {
        faces[found->second] = { cell, vertex };
      }
    }
  }
  for (const ElementFace& face : faces)
  {
    RefuseIf(face.OppositeVertex == none,
      "the interfaces are not those of this mesh: one of their triangles is no face of a "
      "tetrahedron with its label");
  }
  return faces;
}

/** Both programs read 20 characters of a number: what is longer would lose digits, or its exponent. */
std::string Coordinate(double value)
{
  std::array<char, 32> text;
  char* const last = text.data() + text.size();
  char* end = std::to_chars(text.data(), last, value).ptr;
  for (int digits = 16; end - text.data() > 20; --digits)
  {
    end = std::to_chars(text.data(), last, value, std::chars_format::general, digits).ptr;
  }
  return { text.data(), end };
}

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

/** Faces of C3D4: S1 has the nodes 1, 2, 3, S2 1, 4, 2, S3 2, 4, 3 and S4 3, 4, 1. */
const char* NameOf(const ElementFace& face)
{
  constexpr std::array names{ "S3", "S4", "S2", "S1" };
  return names[face.OppositeVertex];
}

void WriteHeading(
  TextFile& file, const MeshView& view, const SetNames& names, const std::string& space)
{
  file << "*HEADING\nWritten by Voxplex. SPACE=" << space << "\n** Element sets are labels:\n";
  WriteLabelNames(file, view, names, "**");
  file << "** Surfaces, and node sets of the same names, lie between labels:\n";
  WritePairNames(file, view, names, "**");
}

void WriteElements(TextFile& file, const MeshView& view, const SetNames& names)
{
  for (const auto& [label, cells] : view.TetrahedraOfLabel)
  {
    file << "*ELEMENT, TYPE=C3D4, ELSET=" << names.OfLabel(label) << '\n';
    for (const vtkIdType cell : cells)
    {
      const auto& [a, b, c, d] = view.Tetrahedra[static_cast<std::size_t>(cell)];
      file << cell + 1 << ", " << a + 1 << ", " << b + 1 << ", " << c + 1 << ", " << d + 1 << '\n';
    }
  }
}

void WriteSurfaces(TextFile& file, const MeshView& view, const SetNames& names)
{
  const std::vector<ElementFace> faces = FindElementFaces(view);
  for (const auto& [pair, cells] : view.TrianglesOfPair)
  {
    file << "*NSET, NSET=" << names.OfPair(pair) << '\n';
    WriteSet(file, NodesOf(view, cells));
    file << "*SURFACE, TYPE=ELEMENT, NAME=" << names.OfPair(pair) << '\n';
    for (const vtkIdType cell : cells)
    {
      const ElementFace& face = faces[static_cast<std::size_t>(cell)];
      file << face.Tetrahedron + 1 << ", " << NameOf(face) << '\n';
    }
  }
}

} // namespace

void WriteAbaqus(const MeshData& mesh, const std::string& path)
{
  const MeshView view(mesh);
  const SetNames names(view, AbaqusNames);
  TextFile file(path);
  WriteHeading(file, view, names, mesh.Space);
  file << "*NODE\n";
  for (vtkIdType i = 0; i < view.NumberOfPoints(); ++i)
  {
    const auto [x, y, z] = view.Point(i);
    file << i + 1 << ", " << Coordinate(x) << ", " << Coordinate(y) << ", " << Coordinate(z)
         << '\n';
  }
  WriteElements(file, view, names);
  WriteSurfaces(file, view, names);
  file.Close();
}

} // namespace voxplex::io
