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
 * Points are inserted in rounds of eight times as many, each in the order of a Hilbert curve (a biased
 * randomised insertion order, Amenta, Choi and Rote 2003): points on surfaces that come in
 * spatial order alone would give cavities of many simplices. In the last round all threads take pieces of the curve, begin
 * at a vertex of the rounds before, and walk to where a point belongs with the vertices of every simplex that
 * they pass locked. What meets another thread is left to one thread at the end, so nobody ever waits.
 *
 * The triangulation is a function of the points, though the numbers of its vertices and simplices are not.
 */
class SampleTriangulation
{
public:
  /**
   * @param sample points, at least one; one that is there twice becomes one vertex
   * @param margin how far the corners of the box are from the points' bounding box along each axis, at least; positive
   * @param threads 0 means all cores
   * @throws Cancelled, std::bad_alloc
   */
  SampleTriangulation(const std::vector<Point<3>>& sample, double margin, unsigned threads,
    const std::stop_token& stop);

  const Triangulation<3>& Mesh() const { return this->Triangulated; }

private:
  /** A point, its place along the curve, and its vertex if it has been inserted. */
  struct Entry
  {
    std::uint64_t Key;
    Point<3> Position;
    VertexId Vertex = None;
  };
  using Worker = Triangulation<3>::Worker;

  void InsertAlone(const std::vector<Entry>& entries, std::vector<Entry>* inserted);
  void InsertTogether(const std::vector<Entry>& entries, unsigned threads);
  void InsertPiece(Worker& worker, const Entry* begin, const Entry* end);
  SimplexId LockNear(Worker& worker, const Entry& entry);
  SimplexId WalkLocking(Worker& worker, const Point<3>& p, SimplexId from);

  Triangulation<3> Triangulated;
  std::stop_token Stop;
  std::vector<Entry> Before; ///< of the rounds before, sorted by key
  std::mutex Mutex;          ///< of Left
  std::vector<Entry> Left;   ///< to be inserted by one thread
};

} // namespace voxplex

#endif
