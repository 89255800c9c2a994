// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// A mesh of space-time that owns its memory, and what must hold of slices of it.
#ifndef voxplex_TimeSliceChecks_h
#define voxplex_TimeSliceChecks_h

#include "Geometry/Determinants.h"
#include "Mesh/TimeSlice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>
#include <vector>

namespace voxplex::checks
{

/** A mesh that owns its memory. */
struct Mesh
{
  std::vector<double> Points;
  std::vector<double> Times;
  std::vector<long long> Offsets = { 0 };
  std::vector<long long> Connectivity;
  std::vector<long long> Labels;
  std::vector<long long> Others; ///< of boundary cells: the label outside

  void AddPoint(const Point<4>& p)
  {
    this->Points.insert(this->Points.end(), p.begin(), p.begin() + 3);
    this->Times.push_back(p[3]);
  }
  template <typename Ids>
  void AddCell(const Ids& ids, long long label = 1, long long other = 0)
  {
    this->Connectivity.insert(this->Connectivity.end(), ids.begin(), ids.end());
    this->Offsets.push_back(static_cast<long long>(this->Connectivity.size()));
    this->Labels.push_back(label);
    this->Others.push_back(other);
  }
  Point<4> At(long long id) const
  {
    const auto i = static_cast<std::size_t>(id);
    return { this->Points[3 * i], this->Points[3 * i + 1], this->Points[3 * i + 2],
      this->Times[i] };
  }
  SpaceTimeMesh View() const
  {
    return { this->Points, this->Times, this->Offsets, this->Connectivity };
  }
};

inline double Orientation(const Mesh& mesh, const std::array<long long, 5>& ids)
{
  std::array<Point<4>, 4> rows;
  for (std::size_t i = 0; i < 4; ++i)
  {
    rows[i] = Subtract(mesh.At(ids[i + 1]), mesh.At(ids[0]));
  }
  return Determinant(rows);
}

using Corners = std::vector<long long>;

inline Corners CellOf(const TimeSlice& slice, std::size_t cell)
{
  return { slice.Connectivity.begin() + slice.Offsets[cell],
    slice.Connectivity.begin() + slice.Offsets[cell + 1] };
}

/** The faces of a tetrahedron, normals outwards if its volume is positive. */
inline std::vector<Corners> FacesOf(const TimeSlice& slice, std::size_t cell)
{
  const Corners v = CellOf(slice, cell);
  return { { v[0], v[1], v[3] }, { v[1], v[2], v[3] }, { v[2], v[0], v[3] }, { v[0], v[2], v[1] } };
}

inline Point<3> PointOf(const TimeSlice& slice, long long id)
{
  return slice.Points[static_cast<std::size_t>(id)];
}

inline double VolumeOf(const TimeSlice& slice, std::size_t cell)
{
  const Corners corners = CellOf(slice, cell);
  std::array<Point<3>, 3> rows;
  for (std::size_t i = 0; i < 3; ++i)
  {
    rows[i] = Subtract(PointOf(slice, corners[i + 1]), PointOf(slice, corners[0]));
  }
  return Determinant(rows) / 6.0;
}

struct Volumes
{
  double All = 0.0;
  double Smallest = std::numeric_limits<double>::infinity();
  std::map<long long, double> OfLabel;
};

inline Volumes Measure(const TimeSlice& slice, const Mesh& mesh)
{
  Volumes volumes;
  for (std::size_t c = 0; c < slice.Sources.size(); ++c)
  {
    const double volume = VolumeOf(slice, c);
    volumes.Smallest = std::min(volumes.Smallest, volume);
    volumes.All += volume;
    volumes.OfLabel[mesh.Labels[static_cast<std::size_t>(slice.Sources[c])]] += volume;
  }
  return volumes;
}

/** The same cycle, beginning with its smallest number. */
template <typename T>
std::vector<T> Cycle(std::vector<T> cycle)
{
  std::rotate(cycle.begin(), std::min_element(cycle.begin(), cycle.end()), cycle.end());
  return cycle;
}

template <typename T>
std::vector<T> Reversed(std::vector<T> cycle)
{
  std::reverse(cycle.begin(), cycle.end());
  return Cycle(cycle);
}

/**
 * Checks what holds for every slice that fills a box: a face is that of one cell, and then lies on the
 * box, or of two that see it from both sides; no cell is inverted, and there is no gap.
 */
inline void ExpectToFillBox(const TimeSlice& slice, const Mesh& mesh, double size)
{
  std::map<Corners, long long> faces; // cycles, with their cells
  for (std::size_t c = 0; c < slice.Sources.size(); ++c)
  {
    for (const Corners& face : FacesOf(slice, c))
    {
      EXPECT_TRUE(faces.emplace(Cycle(face), static_cast<long long>(c)).second)
        << "two cells on one side of a face";
    }
  }
  for (const auto& [face, cell] : faces)
  {
    if (faces.contains(Reversed(face)))
    {
      continue;
    }
    bool onBox = false;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      for (const double plane : { 0.0, size })
      {
        onBox = onBox ||
          std::all_of(face.begin(), face.end(),
            [&](long long id)
            { return std::abs(PointOf(slice, id)[axis] - plane) < 1e-12 * size; });
      }
    }
    EXPECT_TRUE(onBox) << "a face inside the box has one cell only, cell " << cell;
  }
  const Volumes volumes = Measure(slice, mesh);
  EXPECT_NEAR(volumes.All, size * size * size, 1e-10 * size * size * size);
  EXPECT_GT(volumes.Smallest, 0.0);
}

/** What TimeSlice promises of its arrays. */
inline void ExpectGoodArrays(const TimeSlice& slice, const Mesh& mesh, double time)
{
  ASSERT_EQ(slice.Points.size(), slice.Origins.size());
  ASSERT_EQ(slice.Sources.size() + 1, slice.Offsets.size());
  ASSERT_EQ(slice.Offsets.back(), static_cast<long long>(slice.Connectivity.size()));
  EXPECT_TRUE(std::is_sorted(slice.Sources.begin(), slice.Sources.end()));
  std::set<long long> used(slice.Connectivity.begin(), slice.Connectivity.end());
  EXPECT_EQ(used.size(), slice.Points.size());
  for (std::size_t c = 0; c < slice.Sources.size(); ++c)
  {
    const Corners corners = CellOf(slice, c);
    EXPECT_EQ(std::set<long long>(corners.begin(), corners.end()).size(), corners.size());
  }
  std::pair<long long, long long> before = { -1, -1 };
  for (std::size_t i = 0; i < slice.Points.size(); ++i)
  {
    const CutPoint& origin = slice.Origins[i];
    const std::pair now(origin.A, origin.B);
    EXPECT_LT(before, now);
    before = now;
    EXPECT_LE(origin.A, origin.B);
    EXPECT_EQ(origin.A == origin.B, origin.Weight == 0.0);
    EXPECT_LT(origin.Weight, 1.0);
    const Point<4> p = Interpolate(mesh.At(origin.A), mesh.At(origin.B), origin.Weight);
    EXPECT_NEAR(p[3], time, 1e-12);
    EXPECT_EQ(slice.Points[i], (Point<3>{ p[0], p[1], p[2] }));
  }
}

using NamedFace = std::vector<std::pair<long long, long long>>;

inline NamedFace Named(const TimeSlice& slice, const Corners& face)
{
  NamedFace named;
  for (const long long id : face)
  {
    const CutPoint& origin = slice.Origins[static_cast<std::size_t>(id)];
    named.emplace_back(origin.A, origin.B);
  }
  return Cycle(named);
}

/** For each label and face how often its region has the face on its boundary, from inside. */
class Boundaries
{
public:
  /** The same face seen from both sides is no boundary. */
  void Add(long long label, const NamedFace& face, int times)
  {
    const NamedFace back = Reversed(face);
    const bool swap = back < face;
    int& count = this->Counts[{ label, swap ? back : face }];
    count += swap ? -times : times;
    if (count == 0)
    {
      this->Counts.erase({ label, swap ? back : face });
    }
  }
  bool operator==(const Boundaries&) const = default;

private:
  std::map<std::pair<long long, NamedFace>, int> Counts;
};

/**
 * The slice of the boundary is the boundary of the slice, and normals point outwards. Where points lie
 * at the time, a pentatope between two interfaces may lose its volume: they meet and cancel out.
 */
inline void ExpectSameBoundary(
  const TimeSlice& slice, const Mesh& mesh, const TimeSlice& cut, const Mesh& boundary)
{
  Boundaries expected;
  for (std::size_t c = 0; c < slice.Sources.size(); ++c)
  {
    const long long label = mesh.Labels[static_cast<std::size_t>(slice.Sources[c])];
    for (const Corners& face : FacesOf(slice, c))
    {
      expected.Add(label, Named(slice, face), 1);
    }
  }
  Boundaries found;
  for (std::size_t c = 0; c < cut.Sources.size(); ++c)
  {
    const Corners corners = CellOf(cut, c);
    EXPECT_EQ(corners.size(), 3u);
    const auto source = static_cast<std::size_t>(cut.Sources[c]);
    found.Add(boundary.Labels[source], Named(cut, corners), 1);
    if (boundary.Others[source] != 0)
    {
      found.Add(boundary.Others[source], Named(cut, corners), -1);
    }
  }
  EXPECT_GT(cut.Sources.size(), 0u);
  EXPECT_TRUE(found == expected);
}

} // namespace voxplex::checks

#endif
