// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TimeSlice.h
 * @brief The exact cut of a mesh of space-time at one time.
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
 * @brief A mesh of space-time in memory that somebody else owns.
 *
 * Cells have five points (pentatopes) or four (tetrahedra of space-time, the boundary of a pentatope
 * mesh). Indices are long long, as in VTK, so that its memory is read in place.
 */
struct SpaceTimeMesh
{
  std::span<const double> Points;     ///< x, y, z of each point
  std::span<const double> Times;      ///< of each point
  std::span<const long long> Offsets; ///< cell i has the points from place Offsets[i] of
                                      ///< Connectivity up to place Offsets[i + 1]; empty, or as
                                      ///< many as cells and one more
  std::span<const long long> Connectivity; ///< indices of points
};

/** The values are VTK's cell types, and so is the order of corners. */
enum class SliceCellType : unsigned char
{
  Triangle = 5,
  Quad = 9,
  Tetrahedron = 10,
  Wedge = 13,
  Pyramid = 14
};

/** Where a point of a slice lies in the mesh: A + Weight (B - A). */
struct CutPoint
{
  long long A;   ///< a point of the mesh
  long long B;   ///< larger than A; or A again, where the slice goes through a point of the mesh
  double Weight; ///< 0 < Weight < 1; 0 if A and B are the same
};

/** A mesh of space; each point occurs once and is used. */
struct TimeSlice
{
  std::vector<Point<3>> Points;
  std::vector<CutPoint> Origins; ///< of each point; sorted by A, then B
  std::vector<SliceCellType> Types;
  std::vector<long long> Offsets; ///< as in SpaceTimeMesh, but never empty
  std::vector<long long> Connectivity;
  std::vector<long long>
    Sources; ///< of each cell the cell of the mesh that it is cut from; ascending
};

/**
 * @brief Borders a mesh of space-time at any number of times.
 *
 * The points of a simplex that lie before the time T of the slice are below, the others above; the slice
 * has a corner on each edge from one to the other.
 *
 *     pentatope    1 | 4  tetrahedron      2 | 3  wedge: an edge below, a triangle above, or vice versa
 *     tetrahedron  1 | 3  triangle         2 | 2  quadrilateral
 *
 * **Conforming.** A corner is a function of its edge and T alone. A face that two simplices share is cut
 * in one way, so neighbours in the slice share all corners of the common face: triangles meet triangles
 * and quadrilaterals, all of them plane, meet quadrilaterals. No cell is split, so nothing has to be
 * agreed on.
 *
 * **Points at T.** What happens at a time where points of the mesh lie is decided by a limit: the
 * slice is the limit of those shortly before T, except at the mesh's first time, where it is the limit
 * of those shortly after. Parts of the mesh that lie flat at T are thus never cut twice, and at the first
 * and the last time the slice is the flat end of the mesh. In the limit the corners on all edges that
 * end in a point at T become that point. A wedge of which one edge vanishes is a pyramid, one that loses
 * two edges or a triangle is a tetrahedron; cells without volume are dropped (polygons without area
 * likewise). This is done by looking at points, not at edges or at positions, so all cells agree on it.
 * Where a pentatope between two interfaces is dropped, these meet: polygons of both stay, one upon the
 * other.
 *
 * A point counts as lying at T if it does so within GetTolerance(): times of frames that are computed in
 * two ways differ by roundings.
 *
 * **Orientation.** Pentatopes with det(p_1 - p_0, ..., p_4 - p_0) > 0, the columns in the order x, y, z,
 * t, give cells of positive volume, up to the rounding of corners, in VTK's order of corners. (For a
 * wedge: the right-hand normal of the first triangle points away from the second; for a pyramid: that of
 * the base points to the apex.) Tetrahedra (p_0, ..., p_3) such that (q, p_0, ..., p_3) is positive for q
 * on their inner side, which is how SimplexMesh::Facets are, give polygons whose right-hand normal points
 * outwards. Where the mesh is oriented the other way, so is the slice.
 *
 * Only const members may be called from several threads at once. The mesh's memory must outlive the
 * slicer and stay as it is.
 */
class TimeSlicer
{
public:
  /**
   * Sorts the cells by time. O(n log n) time; 32 bytes for each cell.
   *
   * @throws InputError if a cell has neither four nor five points, an index is out of range, a time is
   *   not finite, or there are not three coordinates for each time
   * @throws std::bad_alloc
   */
  explicit TimeSlicer(const SpaceTimeMesh& mesh);

  /** Whether there are no cells. */
  bool IsEmpty() const { return this->Cells.empty(); }

  ///@{
  /** The first and the last time of the mesh: of the points that cells use. 0 without cells. */
  double GetFirstTime() const { return this->First; }
  double GetLastTime() const { return this->Last; }
  ///@}

  /**
   * How near to T the time of a point must be for it to count as lying at T: 1e-12 of the mesh's
   * duration, or four roundings of its largest time if that is more.
   */
  double GetTolerance() const { return this->Tolerance; }

  /**
   * The cut at a time; empty outside the mesh's times, and if the time is not a number. O(k log n)
   * for k cells with points on both sides.
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
    double Latest; ///< the largest End in the range of which this is the root
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
