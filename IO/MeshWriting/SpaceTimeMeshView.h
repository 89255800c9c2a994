// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SpaceTimeMeshView.h
 * @brief Pentatopes and boundary tetrahedra over one set of points of space-time.
 *
 * What the formats of 4D meshes need.
 */
#ifndef voxplex_io_SpaceTimeMeshView_h
#define voxplex_io_SpaceTimeMeshView_h

#include "LabelPairs.h"

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <vtkType.h>

class vtkDataArray;
class vtkUnstructuredGrid;

namespace voxplex::io
{

struct SpaceTimeMeshData;
class TextFile;

/**
 * @brief A mesh, or a slab of it. Points, pentatopes and tetrahedra are numbered from 0.
 *
 * Tetrahedra are those of the boundary, then the facets on time planes inside of labels. Numbers of pairs and sides
 * are those of the whole mesh, so a facet has the same number in the files of both slabs that share it.
 */
class SpaceTimeMeshView
{
public:
  /** Keeps pointers into mesh. @throws FileError if a label does not fit into 31 bits */
  explicit SpaceTimeMeshView(const SpaceTimeMeshData& mesh);

  vtkIdType NumberOfPoints() const { return static_cast<vtkIdType>(this->Points.size()); }
  std::array<double, 4> Point(vtkIdType i) const; ///< x, y, z, t
  /** Of a slab: the number of the point in the whole mesh. */
  vtkIdType NumberInWhole(vtkIdType i) const { return this->Points[static_cast<std::size_t>(i)]; }
  bool IsSlab() const { return this->Slab >= 0; }

  vtkIdType NumberOfPentatopes() const { return static_cast<vtkIdType>(this->Cells.size()); }
  std::array<vtkIdType, 5> Pentatope(vtkIdType i) const; ///< positively oriented in (x, y, z, t)
  std::int64_t LabelOf(vtkIdType i) const;               ///< of pentatope i

  struct Tetrahedron
  {
    std::array<vtkIdType, 4> Vertices;
    std::int64_t Number; ///< of its pair of labels and its side
  };
  const std::vector<Tetrahedron>& Tetrahedra() const { return this->Facets; }

  /** The slab of each pentatope; empty if there are no time planes. */
  std::vector<vtkIdType> SlabsOfPentatopes() const;
  /** Points at the first time and their twins at the last; of a whole mesh only. */
  std::vector<std::array<vtkIdType, 2>> PeriodicPairs() const;

  /**
   * A comment for each pair and side: "#   8: 7 3", "#   9: 3 0 initial", "#   11: 3 0 final", "#   13: 3 3
   * plane 1". Before it, the times of the planes, if there are any.
   */
  void WritePairs(TextFile& file) const;

private:
  void ChooseCells();
  void ChoosePoints();
  void GatherFacets(const SpaceTimeMeshData& mesh);
  bool IsInSlab(const std::array<vtkIdType, 4>& facet) const;

  const int Slab; ///< -1: all of the mesh
  vtkUnstructuredGrid* const Pentatopes;
  vtkDataArray* const Times;
  vtkDataArray* const Labels;
  const std::vector<double> Planes;
  std::vector<vtkIdType> Cells;   ///< ids in Pentatopes
  std::vector<vtkIdType> Points;  ///< ids in Pentatopes
  std::vector<vtkIdType> LocalId; ///< of each point of Pentatopes, or -1
  std::vector<Tetrahedron> Facets;
  std::map<SidedPair, std::int64_t> PairNumber; ///< see NumberSidedPairs()
};

} // namespace voxplex::io

#endif
