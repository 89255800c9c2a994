// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SampleTriangulation.h
 * @brief The Delaunay triangulation of a given set of points, made by all threads.
 */
#ifndef voxplex_SampleTriangulation_h
#define voxplex_SampleTriangulation_h

#include "Delaunay/Triangulation.h"

#include <cstdint>
#include <mutex>
#include <stop_token>
#include <vector>

namespace voxplex
{

/**
 * @brief The second triangulation of the thesis, D(Z): all points are given beforehand.
 *
 * Points are inserted in rounds. Each round has about eight times as many points as the round
 * before, in the order of a Hilbert curve (a biased randomised insertion order, Amenta, Choi and
 * Rote 2003). If points on surfaces were inserted in spatial order alone, cavities would have many
 * simplices.
 *
 * All threads share the last round and take pieces of the curve. A thread begins at a vertex of the
 * earlier rounds and walks to the simplex that a point belongs to. It locks the vertices of every
 * simplex on its way. If it meets another thread, the point is left to one thread at the end. So no
 * thread ever waits.
 *
 * The triangulation is a function of the points alone. The numbers of its vertices and simplices
 * are not.
 */
template <int D>
class SampleTriangulation
{
public:
  /**
   * @param sample at least one point; two equal points become one vertex
   * @param margin smallest distance of the box's faces from the points' bounding box along each
   *   axis; positive
   * @param threads 0 means all cores
   * @throws Cancelled, std::bad_alloc
   */
  SampleTriangulation(const std::vector<Point<D>>& sample, double margin, unsigned threads,
    const std::stop_token& stop);

  const Triangulation<D>& Mesh() const { return this->Triangulated; }

private:
  /** A point, its position along the curve, and its vertex if it has been inserted. */
  struct CurvePoint
  {
    std::uint64_t Key;
    Point<D> Position;
    VertexId Vertex = None;
  };
  using Worker = typename Triangulation<D>::Worker;

  void InsertAlone(const std::vector<CurvePoint>& entries, std::vector<CurvePoint>* inserted);
  void InsertTogether(const std::vector<CurvePoint>& entries, unsigned threads);
  void InsertPiece(Worker& worker, const CurvePoint* begin, const CurvePoint* end);
  SimplexId LockNear(Worker& worker, const CurvePoint& entry);
  SimplexId WalkLocking(Worker& worker, const Point<D>& p, SimplexId from);

  Triangulation<D> Triangulated;
  std::stop_token Stop;
  std::vector<CurvePoint> Before; ///< the points of the earlier rounds, sorted by key
  std::mutex Mutex;               ///< guards Left
  std::vector<CurvePoint> Left;   ///< the points that one thread inserts at the end
};

extern template class SampleTriangulation<3>;
extern template class SampleTriangulation<4>;

} // namespace voxplex

#endif
