// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshView.h
 * @brief Tetrahedra and interface triangles over one set of points, grouped by label.
 *
 * What the formats with references, entities and sets need. Labels and pairs of labels are in
 * increasing order.
 */
#ifndef voxplex_io_MeshView_h
#define voxplex_io_MeshView_h

#include "LabelPairs.h"
#include "LabelTable.h"

#include <array>
#include <vector>

#include <vtkType.h>

class vtkPoints;

namespace voxplex::io
{

struct MeshData;

class MeshView
{
public:
  using LabelPair = io::LabelPair;
  using CellIds = std::vector<vtkIdType>;

  /** Keeps pointers into mesh. @throws FileError if a label does not fit into 31 bits */
  explicit MeshView(const MeshData& mesh);

  vtkIdType NumberOfPoints() const;
  std::array<double, 3> Point(vtkIdType id) const;

  ///@{
  /** As SpaceTimeMeshView has them: elements are tetrahedra with labels, facets triangles with numbers of pairs. */
  vtkIdType NumberOfElements() const { return static_cast<vtkIdType>(this->Tetrahedra.size()); }
  std::array<vtkIdType, 4> Element(vtkIdType i) const { return this->Tetrahedra[At(i)]; }
  std::int64_t LabelOf(vtkIdType i) const { return this->LabelOfTetrahedron[At(i)]; }
  vtkIdType NumberOfFacets() const { return static_cast<vtkIdType>(this->Triangles.size()); }
  std::array<vtkIdType, 3> Facet(vtkIdType i) const { return this->Triangles[At(i)]; }
  std::int64_t FacetNumber(vtkIdType i) const
  {
    return this->PairNumber.at(this->PairOfTriangle[At(i)]);
  }
  ///@}

  std::vector<std::array<vtkIdType, 4>> Tetrahedra; ///< vertices, in VTK's order
  std::vector<std::array<vtkIdType, 3>> Triangles;  ///< vertices, as ids of the tetrahedra's points
  std::vector<std::int64_t> LabelOfTetrahedron;
  std::vector<LabelPair> PairOfTriangle;
  std::map<std::int64_t, CellIds> TetrahedraOfLabel;
  std::map<LabelPair, CellIds> TrianglesOfPair;

  std::map<LabelPair, std::int64_t> PairNumber; ///< see NumberPairs()
  LabelTable Table;                             ///< names of labels, from the mesh's field data

private:
  static std::size_t At(vtkIdType i) { return static_cast<std::size_t>(i); }

  vtkPoints* Points;
};

} // namespace voxplex::io

#endif
