// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TimeSlice.h
 * @brief The exact cut of a space-time mesh at one time.
 */
#ifndef voxplex_TimeSlice_h
#define voxplex_TimeSlice_h

#include "Geometry/Point.h"

#include <array>
#include <span>
#include <vector>

namespace voxplex
{

/**
 * @brief A space-time mesh in memory that another object owns.
 *
 * Cells have five points (pentatopes) or four (tetrahedra of space-time, the boundary of a
 * pentatope mesh). Indices are long long, as in VTK, so that VTK's memory is read in place.
 */
struct SpaceTimeMesh
{
  std::span<const double> Points; ///< x, y, z of each point
  std::span<const double> Times;  ///< of each point
  /**
   * The points of cell i begin at Connectivity[Offsets[i]] and end before
   * Connectivity[Offsets[i + 1]]. Offsets is empty, or has one entry more than there are cells.
   */
  std::span<const long long> Offsets;
  std::span<const long long> Connectivity; ///< indices of points
};

/** The position of a point of a slice in the mesh: A + Weight (B - A). */
struct CutPoint
{
  long long A;   ///< a point of the mesh
  long long B;   ///< larger than A; or equal to A if the slice goes through this point of the mesh
  double Weight; ///< 0 < Weight < 1; 0 if A equals B
};

/** A mesh of tetrahedra and triangles in space. Each point occurs once and is used by a cell. */
struct TimeSlice
{
  std::vector<Point<3>> Points;
  std::vector<CutPoint> Origins;  ///< of each point; sorted by A, then B
  std::vector<long long> Offsets; ///< as in SpaceTimeMesh, but never empty
  std::vector<long long> Connectivity;
  /** For each cell, the cell of the space-time mesh from which it was cut; ascending. */
  std::vector<long long> Sources;
};

/**
 * @brief Cuts a space-time mesh at any number of times.
 *
 * The points of a simplex before the time T of the slice are below, the others above. The slice has
 * a corner on each edge between a point below and a point above.
 *
 *     pentatope    1 | 4  tetrahedron      2 | 3  wedge: three tetrahedra
 *     tetrahedron  1 | 3  triangle         2 | 2  quadrilateral: two triangles
 *
 * **Conforming.** A corner is a function of its edge and T alone. A face that two simplices share
 * is cut in one way, so neighbours in the slice share all corners of the common face. Each
 * quadrilateral is plane, and is split by the diagonal of its smallest point, so neighbours agree
 * (Dompierre et al. 1999, "How to subdivide pyramids, prisms and hexahedra into tetrahedra"). So
 * do the slices of two meshes if the points of one are points of the other, in the same order.
 *
 * **Points at T.** If points of the mesh lie at T, the slice is a limit: of the slices shortly
 * before T, or, at the mesh's first time, of the slices shortly after. So a part of the mesh that
 * lies flat at T is never cut twice, and at the first and the last time the slice is the flat end
 * of the mesh. In the limit, if an edge ends in a point at T, its corner becomes that point. Cells
 * of which two corners become one are dropped. This depends on points alone, and not on positions,
 * so all cells agree. If all of a pentatope between two interfaces is dropped, the interfaces meet:
 * the triangles of both stay and coincide.
 *
 * A point counts as lying at T if its time differs by no more than 1e-12 of the mesh's duration, or
 * four roundings of its largest time if that is more: times of frames that are computed in two ways
 * differ by roundings.
 *
 * **Orientation.** Let the columns of a determinant be in the order x, y, z, t. A pentatope with
 * det(p_1 - p_0, ..., p_4 - p_0) > 0 gives tetrahedra of positive volume, up to the rounding of
 * corners. Take a tetrahedron (p_0, ..., p_3) for which (q, p_0, ..., p_3) is positive if q is on its inner side,
 * as for SimplexMesh::Facets. It gives triangles whose right-hand normal points outwards. If the
 * mesh has the opposite orientation, so has the slice.
 *
 * Several threads may call const members at once, but no others. The mesh's memory must outlive the
 * slicer and must not change.
 */
class TimeSlicer
{
public:
  /**
   * Sorts the cells by time. O(n log n) time; 32 bytes for each cell.
   *
   * @throws InputError if a cell has neither four nor five points, an index is out of range, a time
   *   is not finite, or there are not three coordinates for each time
   * @throws std::bad_alloc
   */
  explicit TimeSlicer(const SpaceTimeMesh& mesh);

  /** Whether there are no cells. */
  bool IsEmpty() const { return this->Cells.empty(); }

  ///@{
  /** The first and the last time of the points that cells use. 0 if there are no cells. */
  double GetFirstTime() const { return this->First; }
  double GetLastTime() const { return this->Last; }
  ///@}

  /**
   * The cut at a time. It is empty if the time is outside the mesh's times or is not a number. O(k
   * log n) for k cells with points on both sides.
   *
   * @throws std::bad_alloc
   */
  TimeSlice Slice(double time) const;

private:
  /** A cell's times. The array is also a balanced tree: the root of a range is its middle. */
  struct Interval
  {
    double Begin; ///< the array is sorted by it
    double End;
    double Latest; ///< the largest End in the range with this root
    long long Cell;
  };

  Interval IntervalOf(long long cell) const;
  double LinkTree(std::size_t first, std::size_t last);
  void FindCells(
    std::size_t first, std::size_t last, double time, std::vector<long long>& found) const;

  SpaceTimeMesh Mesh;
  std::vector<Interval> Cells;
  double First = 0.0;
  double Last = 0.0;
  double Tolerance = 0.0;
};

} // namespace voxplex

#endif
