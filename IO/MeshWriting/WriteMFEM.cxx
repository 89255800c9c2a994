// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// The .mfem file. Of 3D meshes 'MFEM mesh v1.3', which names sets of attributes; of 4D meshes
// 'MFEM mesh v1.0' with dimension 4, as MFEM's branch 4d_dev reads it. The attribute of an element is
// its label, that of a boundary element the number of its pair of labels (and, in 4D, of the side of
// the mesh); comments tell which. In 4D sections follow the vertices. MFEM's reader of version 1.0 stops
// before them.

#include "MeshView.h"
#include "SetNames.h"
#include "SpaceTimeMeshView.h"
#include "TextFile.h"
#include "Writers.h"

namespace voxplex::io
{
namespace
{

/** mfem::Geometry::Type. */
constexpr int Triangle = 2;
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

template <typename TView>
void WriteVertices(TextFile& file, const TView& view)
{
  constexpr std::size_t dimension = std::tuple_size_v<decltype(view.Point(0))>;
  file << "\nvertices\n" << view.NumberOfPoints() << '\n' << dimension << '\n';
  for (vtkIdType i = 0; i < view.NumberOfPoints(); ++i)
  {
    const auto x = view.Point(i);
    for (std::size_t k = 0; k < dimension; ++k)
    {
      file << x[k] << (k + 1 < dimension ? ' ' : '\n');
    }
  }
}

/** The slabs and pairs of a whole mesh, or where a slab's vertices are in it. */
void WriteSlabs(TextFile& file, const SpaceTimeMeshView& view)
{
  const std::vector<vtkIdType> slabs = view.SlabsOfPentatopes();
  if (!slabs.empty())
  {
    file << "\nslabs\n" << slabs.size() << '\n';
    for (const vtkIdType slab : slabs)
    {
      file << slab << '\n';
    }
  }
  const std::vector<std::array<vtkIdType, 2>> pairs = view.PeriodicPairs();
  if (!pairs.empty())
  {
    file << "\nperiodic_pairs\n" << pairs.size() << '\n';
    for (const auto& [first, last] : pairs)
    {
      file << first << ' ' << last << '\n';
    }
  }
  if (view.IsSlab())
  {
    file << "\nglobal_vertices\n" << view.NumberOfPoints() << '\n';
    for (vtkIdType i = 0; i < view.NumberOfPoints(); ++i)
    {
      file << view.NumberInWhole(i) << '\n';
    }
  }
}

/** A set of one attribute for each label or pair. */
void WriteAttributeSet(TextFile& file, const std::string& name, std::int64_t attribute)
{
  file << '"' << name << "\" 1 " << attribute << '\n';
}

template <typename TView>
void WriteElements(TextFile& file, const TView& view, int geometry)
{
  file << "\nelements\n" << view.NumberOfElements() << '\n';
  for (vtkIdType i = 0; i < view.NumberOfElements(); ++i)
  {
    WriteElement(file, view.LabelOf(i), geometry, view.Element(i));
  }
}

template <typename TView>
void WriteBoundary(TextFile& file, const TView& view, int geometry)
{
  file << "\nboundary\n" << view.NumberOfFacets() << '\n';
  for (vtkIdType i = 0; i < view.NumberOfFacets(); ++i)
  {
    WriteElement(file, view.FacetNumber(i), geometry, view.Facet(i));
  }
}

} // namespace

void WriteMFEM(const MeshData& mesh, const std::string& path)
{
  const MeshView view(mesh);
  const SetNames names(view, QuotedNames);
  TextFile file(path);
  file << "MFEM mesh v1.3\n\n# Written by Voxplex. SPACE=" << mesh.Space << '\n'
       << "# Attributes of elements are labels:\n";
  WriteLabelNames(file, view, names, "#");
  file << "# Attributes of the boundary, labels on both sides:\n";
  WritePairNames(file, view, names, "#");
  file << "\ndimension\n3\n";
  WriteElements(file, view, Tetrahedron);
  file << "\nattribute_sets\n" << view.TetrahedraOfLabel.size() << '\n';
  for (const auto& [label, cells] : view.TetrahedraOfLabel)
  {
    WriteAttributeSet(file, names.OfLabel(label), label);
  }
  WriteBoundary(file, view, Triangle);
  file << "\nbdr_attribute_sets\n" << view.PairNumber.size() << '\n';
  for (const auto& [pair, number] : view.PairNumber)
  {
    WriteAttributeSet(file, names.OfPair(pair), number);
  }
  WriteVertices(file, view);
  file << "\nmfem_mesh_end\n";
  file.Close();
}

void WriteSpaceTimeMFEM(const SpaceTimeMeshData& mesh, const std::string& path)
{
  const SpaceTimeMeshView view(mesh);
  TextFile file(path);
  file << "MFEM mesh v1.0\n\n"
       << "# Written by Voxplex. SPACE=" << mesh.Space << "; the fourth coordinate is the time.\n"
       << "# Attributes of elements are labels; those of the boundary, labels on both sides:\n";
  view.WritePairs(file);

  file << "\ndimension\n4\n";
  WriteElements(file, view, Pentatope);
  WriteBoundary(file, view, Tetrahedron);
  WriteVertices(file, view);
  WriteSlabs(file, view);
  file.Close();
}

} // namespace voxplex::io
