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

#include <vtkSmartPointer.h>
#include <vtkType.h>

class vtkDataArray;
class vtkUnstructuredGrid;

namespace voxplex::io
{

struct SpaceTimeMeshData;
class TextFile;
struct PlaneFacet;

/**
 * @brief A mesh, or a slab of it. Points, elements (pentatopes) and facets (tetrahedra) are numbered from 0.
 *
 * Facets are those of the boundary, then the facets on time planes inside of labels. Numbers of pairs and sides
 * are those of the whole mesh, so a facet has the same number in the files of both slabs that share it.
 */
class SpaceTimeMeshView
{
public:
  /** Keeps pointers into mesh. @throws FileError if a label does not fit into 31 bits */
  explicit SpaceTimeMeshView(const SpaceTimeMeshData& mesh);

  vtkIdType NumberOfPoints() const;
  std::array<double, 4> Point(vtkIdType i) const; ///< x, y, z, t
  /** Of a slab: the number of the point in the whole mesh. */
  vtkIdType NumberInWhole(vtkIdType i) const;
  bool IsSlab() const { return this->Slab >= 0; }

  vtkIdType NumberOfElements() const;
  std::array<vtkIdType, 5> Element(vtkIdType i) const; ///< positively oriented in (x, y, z, t)
  std::int64_t LabelOf(vtkIdType i) const;             ///< of element i

  vtkIdType NumberOfFacets() const { return static_cast<vtkIdType>(this->Facets.size()); }
  std::array<vtkIdType, 4> Facet(vtkIdType i) const
  {
    return this->Facets[static_cast<std::size_t>(i)].Vertices;
  }
  /** Of its pair of labels and its side. */
  std::int64_t FacetNumber(vtkIdType i) const
  {
    return this->Facets[static_cast<std::size_t>(i)].Number;
  }

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
  /** Pairs and sides of the whole mesh. */
  void NumberFacets(vtkUnstructuredGrid* whole, const std::vector<SidedPair>& pairs,
    const std::vector<PlaneFacet>& onPlanes);
  bool IsInSlab(const std::array<vtkIdType, 4>& facet, vtkUnstructuredGrid* whole) const;

  struct NumberedFacet
  {
    std::array<vtkIdType, 4> Vertices;
    std::int64_t Number;
  };

  const int Slab; ///< -1: all of the mesh
  const vtkSmartPointer<vtkUnstructuredGrid> Pentatopes;
  vtkDataArray* const Times;
  vtkDataArray* const Labels;
  const std::vector<double> Planes;
  std::vector<NumberedFacet> Facets;
  std::map<SidedPair, std::int64_t> PairNumber; ///< see NumberSidedPairs()
};

} // namespace voxplex::io

#endif
