// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SpaceTimeMeshView.h
 * @brief Pentatopes and boundary tetrahedra over one set of points of space-time.
 *
 * What the formats of 4D meshes need. Vertices are ids of the pentatope mesh's points.
 */
#ifndef voxplex_io_SpaceTimeMeshView_h
#define voxplex_io_SpaceTimeMeshView_h

#include "LabelPairs.h"

#include <array>
#include <cstdint>
#include <map>
#include <string>

#include <vtkType.h>

class vtkDataArray;
class vtkUnstructuredGrid;

namespace voxplex::io
{

struct SpaceTimeMeshData;
class TextFile;

class SpaceTimeMeshView
{
public:
  /** Keeps pointers into mesh. @throws FileError if a label does not fit into 31 bits */
  explicit SpaceTimeMeshView(const SpaceTimeMeshData& mesh);

  vtkIdType NumberOfPoints() const;
  std::array<double, 4> Point(vtkIdType id) const; ///< x, y, z, t

  vtkIdType NumberOfPentatopes() const;
  std::array<vtkIdType, 5> Pentatope(vtkIdType cell) const; ///< positively oriented in (x, y, z, t)
  std::int64_t LabelOf(vtkIdType pentatope) const;

  vtkIdType NumberOfTetrahedra() const;
  std::array<vtkIdType, 4> Tetrahedron(vtkIdType cell) const;
  std::int64_t NumberOf(vtkIdType tetrahedron) const; ///< of its pair of labels and its side

  /** A comment for each pair and side: "#   8: 7 3", "#   9: 3 0 initial", "#   11: 3 0 final". */
  void WritePairs(TextFile& file) const;

private:
  SidedPair PairOf(vtkIdType tetrahedron) const;

  vtkUnstructuredGrid* Pentatopes;
  vtkUnstructuredGrid* Boundary;
  vtkDataArray* Times;
  vtkDataArray* Labels;
  vtkDataArray* Pairs;
  vtkDataArray* Sides; ///< nullptr: all are lateral
  vtkDataArray* PointIds;
  std::map<SidedPair, std::int64_t> PairNumber; ///< see NumberSidedPairs()
};

} // namespace voxplex::io

#endif
