// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// The .msh file: Gmsh 4.1, ASCII. Each label is a volume entity and a physical group, each pair of
// labels a surface entity and a physical group. A node belongs to the first surface that uses it,
// else to the volume of its elements.

#include "MeshView.h"
#include "SetNames.h"
#include "TextFile.h"
#include "Writers.h"

#include <algorithm>
#include <limits>

namespace voxplex::io
{
namespace
{

constexpr int SurfaceDimension = 2;
constexpr int VolumeDimension = 3;
constexpr int TriangleType = 2;
constexpr int TetrahedronType = 4;

struct Bounds
{
  std::array<double, 3> Min{ Infinity, Infinity, Infinity };
  std::array<double, 3> Max{ -Infinity, -Infinity, -Infinity };
  static constexpr double Infinity = std::numeric_limits<double>::infinity();

  void Include(const std::array<double, 3>& x)
  {
    for (std::size_t i = 0; i < 3; ++i)
    {
      this->Min[i] = std::min(this->Min[i], x[i]);
      this->Max[i] = std::max(this->Max[i], x[i]);
    }
  }
};

template <typename TCells>
Bounds BoundsOf(const MeshView& view, const TCells& vertices, const MeshView::CellIds& cells)
{
  Bounds bounds;
  for (const vtkIdType cell : cells)
  {
    for (const vtkIdType vertex : vertices[static_cast<std::size_t>(cell)])
    {
      bounds.Include(view.Point(vertex));
    }
  }
  return bounds;
}

TextFile& operator<<(TextFile& file, const Bounds& b)
{
  return file << b.Min[0] << ' ' << b.Min[1] << ' ' << b.Min[2] << ' ' << b.Max[0] << ' '
              << b.Max[1] << ' ' << b.Max[2];
}

void WritePhysicalNames(TextFile& file, const MeshView& view, const SetNames& names)
{
  file << "$PhysicalNames\n" << view.PairNumber.size() + view.TetrahedraOfLabel.size() << '\n';
  for (const auto& [pair, number] : view.PairNumber)
  {
    file << SurfaceDimension << ' ' << number << " \"" << names.OfPair(pair) << "\"\n";
  }
  for (const auto& [label, cells] : view.TetrahedraOfLabel)
  {
    file << VolumeDimension << ' ' << label << " \"" << names.OfLabel(label) << "\"\n";
  }
  file << "$EndPhysicalNames\n";
}

void WriteEntities(TextFile& file, const MeshView& view)
{
  file << "$Entities\n0 0 " << view.PairNumber.size() << ' ' << view.TetrahedraOfLabel.size()
       << '\n';
  for (const auto& [pair, number] : view.PairNumber)
  {
    // tag, box, one physical group, no bounding curves
    file << number << ' ' << BoundsOf(view, view.Triangles, view.TrianglesOfPair.at(pair)) << " 1 "
         << number << " 0\n";
  }
  for (const auto& [label, cells] : view.TetrahedraOfLabel)
  {
    std::vector<std::int64_t> surfaces; // positive where the normal points outwards
    for (const auto& [pair, number] : view.PairNumber)
    {
      if (pair.first == label || pair.second == label)
      {
        surfaces.push_back(pair.first == label ? number : -number);
      }
    }
    file << label << ' ' << BoundsOf(view, view.Tetrahedra, cells) << " 1 " << label << ' '
         << surfaces.size();
    for (const std::int64_t surface : surfaces)
    {
      file << ' ' << surface;
    }
    file << '\n';
  }
  file << "$EndEntities\n";
}

/** The nodes of one entity, as the format wants them: first all numbers, then all coordinates. */
struct NodeBlock
{
  int Dimension;
  std::int64_t Entity;
  std::vector<vtkIdType> Nodes;
};

std::vector<NodeBlock> AssignNodes(const MeshView& view)
{
  std::vector<bool> assigned(static_cast<std::size_t>(view.NumberOfPoints()), false);
  std::vector<NodeBlock> blocks;
  const auto addBlock =
    [&](int dimension, std::int64_t entity, const auto& vertices, const MeshView::CellIds& cells)
  {
    NodeBlock block{ dimension, entity, {} };
    for (const vtkIdType cell : cells)
    {
      for (const vtkIdType vertex : vertices[static_cast<std::size_t>(cell)])
      {
        if (!assigned[static_cast<std::size_t>(vertex)])
        {
          assigned[static_cast<std::size_t>(vertex)] = true;
          block.Nodes.push_back(vertex);
        }
      }
    }
    if (!block.Nodes.empty())
    {
      std::sort(block.Nodes.begin(), block.Nodes.end());
      blocks.push_back(std::move(block));
    }
  };
  for (const auto& [pair, cells] : view.TrianglesOfPair)
  {
    addBlock(SurfaceDimension, view.PairNumber.at(pair), view.Triangles, cells);
  }
  for (const auto& [label, cells] : view.TetrahedraOfLabel)
  {
    addBlock(VolumeDimension, label, view.Tetrahedra, cells);
  }
  return blocks;
}

void WriteNodes(TextFile& file, const MeshView& view)
{
  const std::vector<NodeBlock> blocks = AssignNodes(view);
  const vtkIdType count = view.NumberOfPoints();
  file << "$Nodes\n" << blocks.size() << ' ' << count << " 1 " << count << '\n';
  for (const NodeBlock& block : blocks)
  {
    file << block.Dimension << ' ' << block.Entity << " 0 " << block.Nodes.size() << '\n';
    for (const vtkIdType node : block.Nodes)
    {
      file << node + 1 << '\n';
    }
    for (const vtkIdType node : block.Nodes)
    {
      const auto [x, y, z] = view.Point(node);
      file << x << ' ' << y << ' ' << z << '\n';
    }
  }
  file << "$EndNodes\n";
}

/** Tetrahedron i is element i + 1; the triangles follow. */
void WriteElements(TextFile& file, const MeshView& view)
{
  const auto writeBlock = [&file](int dimension, std::int64_t entity, int type,
                            std::size_t firstTag, const auto& vertices,
                            const MeshView::CellIds& cells)
  {
    file << dimension << ' ' << entity << ' ' << type << ' ' << cells.size() << '\n';
    for (const vtkIdType cell : cells)
    {
      file << static_cast<std::size_t>(cell) + firstTag;
      for (const vtkIdType vertex : vertices[static_cast<std::size_t>(cell)])
      {
        file << ' ' << vertex + 1;
      }
      file << '\n';
    }
  };
  const std::size_t count = view.Tetrahedra.size() + view.Triangles.size();
  file << "$Elements\n"
       << view.TrianglesOfPair.size() + view.TetrahedraOfLabel.size() << ' ' << count << " 1 "
       << count << '\n';
  for (const auto& [pair, cells] : view.TrianglesOfPair)
  {
    writeBlock(SurfaceDimension, view.PairNumber.at(pair), TriangleType, view.Tetrahedra.size() + 1,
      view.Triangles, cells);
  }
  for (const auto& [label, cells] : view.TetrahedraOfLabel)
  {
    writeBlock(VolumeDimension, label, TetrahedronType, 1, view.Tetrahedra, cells);
  }
  file << "$EndElements\n";
}

} // namespace

void WriteGmsh(const MeshData& mesh, const std::string& path)
{
  const MeshView view(mesh);
  const SetNames names(view, QuotedNames);
  TextFile file(path);
  file << "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"
       << "$Comments\nWritten by Voxplex. SPACE=" << mesh.Space << "\nVolumes are labels:\n";
  WriteLabelNames(file, view, names, "");
  file << "Surfaces lie between labels:\n";
  WritePairNames(file, view, names, "");
  file << "$EndComments\n";
  WritePhysicalNames(file, view, names);
  WriteEntities(file, view);
  WriteNodes(file, view);
  WriteElements(file, view);
  file.Close();
}

} // namespace voxplex::io
