// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/TimeSlice.h"

#include "Base/Error.h"

#include <algorithm>
#include <cmath>
#include <compare>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>

namespace voxplex
{

namespace
{

/** The edge on which a corner of the slice lies, A < B; A = B for a point of the mesh at T. */
struct Edge
{
  long long A;
  long long B;
  auto operator<=>(const Edge&) const = default; ///< as the slice's points are numbered
};

using Wedge = std::array<Edge, 6>;

/** The wedge turned so that its smallest corner comes first. */
Wedge Turned(const Wedge& w)
{
  static constexpr std::array<std::array<std::size_t, 6>, 6> turns = { { { 0, 1, 2, 3, 4, 5 },
    { 1, 2, 0, 4, 5, 3 }, { 2, 0, 1, 5, 3, 4 }, { 3, 5, 4, 0, 2, 1 }, { 4, 3, 5, 1, 0, 2 },
    { 5, 4, 3, 2, 1, 0 } } };
  const auto& turn =
    turns[static_cast<std::size_t>(std::min_element(w.begin(), w.end()) - w.begin())];
  Wedge turned;
  std::transform(turn.begin(), turn.end(), turned.begin(), [&w](std::size_t i) { return w[i]; });
  return turned;
}

/** Makes the cells of one slice. Corners are identified by edges. */
class Cutter
{
public:
  Cutter(const SpaceTimeMesh& mesh, double time, double tolerance, bool fromAbove)
    : Mesh(mesh)
    , Time(time)
    , Tolerance(tolerance)
    , FromAbove(fromAbove)
  {
    this->Slice.Offsets.push_back(0);
  }

  void Cut(long long cell)
  {
    const auto c = static_cast<std::size_t>(cell);
    const auto first = static_cast<std::size_t>(this->Mesh.Offsets[c]);
    const auto last = static_cast<std::size_t>(this->Mesh.Offsets[c + 1]);
    this->Source = cell;
    if (last - first == 5)
    {
      this->CutPentatope(this->Classify<5>(this->Mesh.Connectivity.subspan(first, 5)));
    }
    else
    {
      this->CutTetrahedron(this->Classify<4>(this->Mesh.Connectivity.subspan(first, 4)));
    }
  }

  /** Numbers the corners and makes the points. */
  TimeSlice Finish()
  {
    struct NumberedCorner
    {
      Edge E;
      std::size_t Corner;
    };
    std::vector<NumberedCorner> places(this->Corners.size());
    for (std::size_t i = 0; i < places.size(); ++i)
    {
      places[i] = { this->Corners[i], i };
    }
    std::sort(places.begin(), places.end(),
      [](const NumberedCorner& p, const NumberedCorner& q) { return p.E < q.E; });

    this->Slice.Connectivity.resize(places.size());
    for (std::size_t i = 0; i < places.size(); ++i)
    {
      const Edge& edge = places[i].E;
      if (i == 0 || edge != places[i - 1].E)
      {
        this->AddPoint(edge);
      }
      this->Slice.Connectivity[places[i].Corner] =
        static_cast<long long>(this->Slice.Points.size()) - 1;
    }
    return std::move(this->Slice);
  }

private:
  /** A point of a simplex. */
  struct Corner
  {
    long long Id;
    bool At; ///< the point lies at T
  };

  /** The points of a simplex, those of the smaller side first. */
  template <std::size_t N>
  struct Sides
  {
    std::array<Corner, N> Points;
    unsigned Fewer;  ///< number of points on the smaller side; 0: there is nothing to cut
    bool FewerBelow; ///< the smaller side is below
    bool Even;       ///< Points is an even permutation of the simplex's points

    /** Makes the permutation even or odd. The larger side has at least two points. */
    void Permute(bool even)
    {
      if (this->Even != even)
      {
        std::swap(this->Points[N - 1], this->Points[N - 2]);
        this->Even = even;
      }
    }
  };

  double TimeOf(long long id) const { return this->Mesh.Times[static_cast<std::size_t>(id)]; }

  template <std::size_t N>
  Sides<N> Classify(std::span<const long long> ids) const
  {
    std::array<Corner, N> corners;
    std::array<bool, N> below;
    unsigned count = 0;
    for (std::size_t i = 0; i < N; ++i)
    {
      const double t = this->TimeOf(ids[i]);
      corners[i] = { ids[i], std::abs(t - this->Time) <= this->Tolerance };
      below[i] = corners[i].At ? this->FromAbove : t < this->Time;
      count += below[i] ? 1 : 0;
    }
    Sides<N> sides;
    sides.FewerBelow = 2 * count <= N; // of two equal sides, the one below
    sides.Fewer = sides.FewerBelow ? count : static_cast<unsigned>(N) - count;
    // Each move brings a point to the front of the points of the other side before it.
    unsigned moves = 0;
    std::size_t fewer = 0;
    std::size_t more = sides.Fewer;
    for (std::size_t i = 0; i < N; ++i)
    {
      if (below[i] == sides.FewerBelow)
      {
        moves += static_cast<unsigned>(more - sides.Fewer);
        sides.Points[fewer++] = corners[i];
      }
      else
      {
        sides.Points[more++] = corners[i];
      }
    }
    sides.Even = moves % 2 == 0;
    return sides;
  }

  /**
   * Let p_0 alone be below. Shorten the rows of det(p_1 - p_0, ..., p_4 - p_0) so that they end at
   * T. Then they are the corners of the slice, with a last column of equal positive numbers.
   * Subtracting the first row from the others shows that the tetrahedron of the four corners has
   * the opposite sign. If p_0 alone is above, the numbers are negative and the signs agree. The
   * sign of a wedge cannot change while two points are below. The example T = 0 and p_0, ..., p_4 =
   * (0 0 0 -1), (0 0 1 -1), (1 0 0 1), (0 1 0 1), (0 0 0 1), whose sign is positive, shows the same
   * for it.
   */
  void CutPentatope(Sides<5> sides)
  {
    sides.Permute(!sides.FewerBelow);
    const auto& p = sides.Points;
    if (sides.Fewer == 1)
    {
      this->Add<4>({ On(p[0], p[1]), On(p[0], p[2]), On(p[0], p[3]), On(p[0], p[4]) });
    }
    else if (sides.Fewer == 2)
    {
      this->AddWedge({ On(p[0], p[2]), On(p[0], p[4]), On(p[0], p[3]), On(p[1], p[2]),
        On(p[1], p[4]), On(p[1], p[3]) });
    }
  }

  /**
   * Splits a wedge, the right-hand normal of whose first triangle points to the second one. Both
   * quadrilaterals at its smallest corner are split there, the third one as its smallest corner
   * says. If corners of the wedge coincide, what is left are the tetrahedra without such corners.
   */
  void AddWedge(const Wedge& wedge)
  {
    const Wedge v = Turned(wedge);
    if (std::min(v[1], v[5]) < std::min(v[2], v[4]))
    {
      this->Add<4>({ v[0], v[1], v[2], v[5] });
      this->Add<4>({ v[0], v[1], v[5], v[4] });
    }
    else
    {
      this->Add<4>({ v[0], v[1], v[2], v[4] });
      this->Add<4>({ v[0], v[4], v[2], v[5] });
    }
    this->Add<4>({ v[0], v[4], v[5], v[3] });
  }

  /** Cuts a face of a pentatope whose other point lies inside. */
  void CutTetrahedron(Sides<4> sides)
  {
    const auto& p = sides.Points;
    if (sides.Fewer == 1)
    {
      sides.Permute(sides.FewerBelow);
      this->Add<3>({ On(p[0], p[1]), On(p[0], p[2]), On(p[0], p[3]) });
    }
    else if (sides.Fewer == 2)
    {
      sides.Permute(true);
      const std::array<Edge, 4> quad = { On(p[0], p[3]), On(p[1], p[3]), On(p[1], p[2]),
        On(p[0], p[2]) };
      const auto first =
        static_cast<std::size_t>(std::min_element(quad.begin(), quad.end()) - quad.begin());
      const Edge& opposite = quad[(first + 2) % 4];
      this->Add<3>({ quad[first], quad[(first + 1) % 4], opposite });
      this->Add<3>({ quad[first], opposite, quad[(first + 3) % 4] });
    }
  }

  static Edge On(const Corner& p, const Corner& q)
  {
    if (p.At || q.At)
    {
      const long long id = p.At ? p.Id : q.Id;
      return { id, id };
    }
    return { std::min(p.Id, q.Id), std::max(p.Id, q.Id) };
  }

  /** Adds a cell unless two of its corners are the same. */
  template <std::size_t N>
  void Add(const std::array<Edge, N>& corners)
  {
    for (std::size_t i = 1; i < N; ++i)
    {
      if (std::count(corners.begin(), corners.begin() + i, corners[i]) > 0)
      {
        return;
      }
    }
    this->Corners.insert(this->Corners.end(), corners.begin(), corners.end());
    this->Slice.Offsets.push_back(static_cast<long long>(this->Corners.size()));
    this->Slice.Sources.push_back(this->Source);
  }

  void AddPoint(const Edge& edge)
  {
    const Point<3> a = this->Position(edge.A);
    if (edge.A == edge.B)
    {
      this->Slice.Points.push_back(a);
      this->Slice.Origins.push_back({ edge.A, edge.B, 0.0 });
      return;
    }
    const double before = this->TimeOf(edge.A);
    const double weight = (this->Time - before) / (this->TimeOf(edge.B) - before);
    this->Slice.Points.push_back(Interpolate(a, this->Position(edge.B), weight));
    this->Slice.Origins.push_back({ edge.A, edge.B, weight });
  }

  Point<3> Position(long long id) const
  {
    const auto i = 3 * static_cast<std::size_t>(id);
    return { this->Mesh.Points[i], this->Mesh.Points[i + 1], this->Mesh.Points[i + 2] };
  }

  const SpaceTimeMesh& Mesh;
  const double Time;
  const double Tolerance;
  const bool FromAbove; ///< points at T count as below
  long long Source = 0; ///< the cell that is being cut
  TimeSlice Slice;
  std::vector<Edge> Corners; ///< in the order of Slice.Connectivity
};

void CheckTimes(const SpaceTimeMesh& mesh)
{
  if (mesh.Points.size() != 3 * mesh.Times.size())
  {
    throw InputError("There are " + std::to_string(mesh.Times.size()) + " times for " +
      std::to_string(mesh.Points.size() / 3) + " points; each point needs one.");
  }
  const auto bad =
    std::find_if(mesh.Times.begin(), mesh.Times.end(), [](double t) { return !std::isfinite(t); });
  if (bad != mesh.Times.end())
  {
    throw InputError(
      "The time of point " + std::to_string(bad - mesh.Times.begin()) + " is not a finite number.");
  }
}

} // namespace

//------------------------------------------------------------------------------------------------
TimeSlicer::TimeSlicer(const SpaceTimeMesh& mesh)
  : Mesh(mesh)
{
  CheckTimes(mesh);
  const std::size_t n = mesh.Offsets.empty() ? 0 : mesh.Offsets.size() - 1;
  if (n == 0)
  {
    return;
  }
  this->Cells.resize(n);
  this->First = std::numeric_limits<double>::infinity();
  this->Last = -this->First;
  for (std::size_t c = 0; c < n; ++c)
  {
    this->Cells[c] = this->IntervalOf(static_cast<long long>(c));
    this->First = std::min(this->First, this->Cells[c].Begin);
    this->Last = std::max(this->Last, this->Cells[c].End);
  }
  constexpr double ofTimes = 4.0 * std::numeric_limits<double>::epsilon();
  constexpr double ofDuration = 1e-12;
  this->Tolerance = std::max(ofDuration * (this->Last - this->First),
    ofTimes * std::max(std::abs(this->First), std::abs(this->Last)));
  std::sort(this->Cells.begin(), this->Cells.end(),
    [](const Interval& a, const Interval& b)
    { return a.Begin != b.Begin ? a.Begin < b.Begin : a.Cell < b.Cell; });
  this->LinkTree(0, n);
}

TimeSlicer::Interval TimeSlicer::IntervalOf(long long cell) const
{
  const auto c = static_cast<std::size_t>(cell);
  const long long first = this->Mesh.Offsets[c];
  const long long last = this->Mesh.Offsets[c + 1];
  const auto points = static_cast<long long>(this->Mesh.Times.size());
  if ((last - first != 4 && last - first != 5) || first < 0 ||
    last > static_cast<long long>(this->Mesh.Connectivity.size()))
  {
    throw InputError("Cell " + std::to_string(cell) + " has " + std::to_string(last - first) +
      " points; a pentatope has 5, a tetrahedron 4.");
  }
  double begin = std::numeric_limits<double>::infinity();
  double end = -begin;
  for (long long i = first; i < last; ++i)
  {
    const long long id = this->Mesh.Connectivity[static_cast<std::size_t>(i)];
    if (id < 0 || id >= points)
    {
      throw InputError("Cell " + std::to_string(cell) + " has the point " + std::to_string(id) +
        ", but there are only " + std::to_string(points) + " points.");
    }
    const double t = this->Mesh.Times[static_cast<std::size_t>(id)];
    begin = std::min(begin, t);
    end = std::max(end, t);
  }
  return { begin, end, end, cell };
}

/** Sets Latest, and returns that of the root. */
double TimeSlicer::LinkTree(std::size_t first, std::size_t last)
{
  if (first == last)
  {
    return -std::numeric_limits<double>::infinity();
  }
  const std::size_t middle = first + (last - first) / 2;
  Interval& root = this->Cells[middle];
  root.Latest =
    std::max({ root.End, this->LinkTree(first, middle), this->LinkTree(middle + 1, last) });
  return root.Latest;
}

/** Appends the cells whose times are within the tolerance of a time. */
void TimeSlicer::FindCells(
  std::size_t first, std::size_t last, double time, std::vector<long long>& found) const
{
  while (first < last)
  {
    const std::size_t middle = first + (last - first) / 2;
    const Interval& root = this->Cells[middle];
    if (root.Latest < time - this->Tolerance)
    {
      return;
    }
    this->FindCells(first, middle, time, found);
    if (root.Begin > time + this->Tolerance)
    {
      return;
    }
    if (root.End >= time - this->Tolerance)
    {
      found.push_back(root.Cell);
    }
    first = middle + 1;
  }
}

//------------------------------------------------------------------------------------------------
TimeSlice TimeSlicer::Slice(double time) const
{
  std::vector<long long> cells;
  this->FindCells(0, this->Cells.size(), time, cells);
  std::sort(cells.begin(), cells.end());
  Cutter cutter(this->Mesh, time, this->Tolerance, time <= this->First + this->Tolerance);
  for (const long long cell : cells)
  {
    cutter.Cut(cell);
  }
  return cutter.Finish();
}

} // namespace voxplex
