// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Image/JunctionCurves.h"

#include "Parallel/ParallelFor.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <set>
#include <span>
#include <utility>

namespace voxplex
{

namespace
{

using Index = GridGeometry<3>::Index;

/** Points of the fine lattice to a voxel along each axis. */
constexpr std::int64_t Fine = 2;
constexpr unsigned FineSide = Fine + 1;

/** Axes in the six orders in which a tetrahedron of Freudenthal's subdivision goes from corner to corner. */
constexpr std::array<std::array<unsigned, 3>, 6> Orders{ { { 0, 1, 2 }, { 0, 2, 1 }, { 1, 0, 2 },
  { 1, 2, 0 }, { 2, 0, 1 }, { 2, 1, 0 } } };

/** Where a point of a curve is: a triangle or a tetrahedron of the subdivision. */
struct Place
{
  std::array<std::int64_t, 3> Base; ///< first corner, on the fine lattice
  std::uint8_t Second;              ///< steps from the first corner to the second, one bit an axis
  std::uint8_t Third;               ///< the same to the third
  bool IsCorner;                    ///< a tetrahedron; Second and Third tell which
};

/** Places as numbers, to sort and compare. */
class Numbering
{
public:
  using Number = std::uint64_t;

  explicit Numbering(const Index& lattice)
    : Side{ static_cast<std::uint64_t>(Fine * lattice[0]),
      static_cast<std::uint64_t>(Fine * lattice[1]) }
  {
  }

  Number NumberOf(const Place& place) const
  {
    const auto x = [&](unsigned a) { return static_cast<std::uint64_t>(place.Base[a]); };
    const std::uint64_t base = (x(2) * this->Side[1] + x(1)) * this->Side[0] + x(0);
    return base << 7 | static_cast<std::uint64_t>(place.Third) << 4 |
      static_cast<std::uint64_t>(place.Second) << 1 | (place.IsCorner ? 1 : 0);
  }
  Place PlaceOf(Number number) const
  {
    const std::uint64_t base = number >> 7;
    const std::uint64_t row = base / this->Side[0];
    return { { static_cast<std::int64_t>(base % this->Side[0]),
               static_cast<std::int64_t>(row % this->Side[1]),
               static_cast<std::int64_t>(row / this->Side[1]) },
      static_cast<std::uint8_t>((number >> 1) & 7), static_cast<std::uint8_t>((number >> 4) & 7),
      IsCorner(number) };
  }
  static bool IsCorner(Number number) { return number & 1; }

private:
  std::array<std::uint64_t, 2> Side;
};

/** The numbers of the places that it joins. */
using Segment = std::array<Numbering::Number, 2>;

//------------------------------------------------------------------------------------------------
/**
 * The labels of the lattice, and behind each of the faces where the image cuts the object another one: so the edges
 * of these faces are junctions, too.
 */
template <typename Field>
class LabelledSpace
{
public:
  LabelledSpace(const LabelImage<3>& image, const Field& field)
    : Image(image)
    , Interior(field)
    , FirstOutside(static_cast<LabelId>(image.NumberOfLabels() + 1))
  {
  }

  const Index& LatticeDimensions() const { return this->Interior.LatticeDimensions(); }
  Point<3> ToFrame(const Point<3>& x) const { return this->Interior.ToFrame(x); }

  bool IsOutside(LabelId id) const { return id >= this->FirstOutside; }
  /** Whether three different labels make a junction; those of the outside and background alone do not. */
  bool IsJunction(const std::array<LabelId, 3>& l) const
  {
    return l[0] != l[1] && l[0] != l[2] && l[1] != l[2] &&
      (this->IsForeground(l[0]) || this->IsForeground(l[1]) || this->IsForeground(l[2]));
  }

  LabelId VoxelId(const Index& lattice) const
  {
    Point<3> x;
    for (std::size_t a = 0; a < 3; ++a)
    {
      x[a] = static_cast<double>(lattice[a]);
    }
    const LabelId behind = this->LabelBehind(x);
    return behind != 0 ? behind : this->Image.AtLattice(lattice);
  }

  /** At lattice coordinates. What lies on a face belongs to the inside. */
  LabelId LabelAt(const Point<3>& x) const
  {
    const LabelId behind = this->LabelBehind(x);
    return behind != 0 ? behind : this->Interior.ExtendedLabelAt(x);
  }
  double MarginAt(const Point<3>& x, LabelId label) const
  {
    return this->Interior.ExtendedMarginAt(x, label);
  }

private:
  bool IsForeground(LabelId id) const { return id != 0 && !this->IsOutside(id); }

  /** That of the first face that x lies beyond; background if it lies beyond none. */
  LabelId LabelBehind(const Point<3>& x) const
  {
    if (this->Interior.IsCut())
    {
      for (unsigned face = 0; face < 6; ++face)
      {
        if (this->Interior.IsBeyondCutFace(x, face))
        {
          return static_cast<LabelId>(this->FirstOutside + face);
        }
      }
    }
    return 0;
  }

  const LabelImage<3>& Image;
  const Field& Interior;
  const LabelId FirstOutside;
};

/** A tetrahedron of the subdivision with the labels of its corners. */
struct FineTetrahedron
{
  std::array<std::array<std::int64_t, 3>, 4> Corners;
  std::array<std::uint8_t, 4> Steps; ///< from the first corner
  std::array<LabelId, 4> Labels;

  /** Its facet without corner i. */
  Place Facet(unsigned i) const
  {
    const unsigned first = i == 0 ? 1 : 0;
    const unsigned second = i <= 1 ? 2 : 1;
    const unsigned third = i <= 2 ? 3 : 2;
    const auto step = [&](unsigned k)
    { return static_cast<std::uint8_t>(this->Steps[k] & ~this->Steps[first]); };
    return { this->Corners[first], step(second), step(third), false };
  }
  /** The labels of its facet without corner i. */
  std::array<LabelId, 3> FacetLabels(unsigned facet) const
  {
    std::array<LabelId, 3> labels;
    for (unsigned i = 0, m = 0; i < 4; ++i)
    {
      if (i != facet)
      {
        labels[m++] = this->Labels[i];
      }
    }
    return labels;
  }
};

unsigned CountDistinct(LabelId* begin, LabelId* end)
{
  std::sort(begin, end);
  return static_cast<unsigned>(std::unique(begin, end) - begin);
}

//------------------------------------------------------------------------------------------------
/** Finds the segments in cells of the lattice. */
template <typename Field>
class Tracer
{
public:
  Tracer(const LabelledSpace<Field>& space, const BitMask<3>& sites)
    : Space(space)
    , Sites(sites)
    , Numbers(space.LatticeDimensions())
  {
  }

  /** In the cells with voxels of three labels between layers k and k + 1. */
  void TraceLayer(std::int64_t k, std::vector<Segment>& segments) const
  {
    const Index& n = this->Space.LatticeDimensions();
    const std::size_t words = this->Sites.WordsPerRow();
    FineLabels labels;
    for (std::int64_t j = 0; j + 1 < n[1]; ++j)
    {
      std::array<std::span<const std::uint64_t>, 4> rows;
      for (unsigned r = 0; r < 4; ++r)
      {
        rows[r] = this->Sites.Row(this->Sites.RowOf({ 0, j + (r & 1), k + (r >> 1) }));
      }
      const auto any = [&](std::size_t w)
      { return w < words ? rows[0][w] | rows[1][w] | rows[2][w] | rows[3][w] : 0; };
      for (std::size_t w = 0; w < words; ++w)
      {
        const std::uint64_t here = any(w);
        std::uint64_t cells = here | (here >> 1) | (any(w + 1) << 63);
        for (; cells != 0; cells &= cells - 1)
        {
          const auto i = static_cast<std::int64_t>(64 * w) + std::countr_zero(cells);
          if (i + 1 < n[0] && this->HasThreeLabels({ i, j, k }))
          {
            this->TraceCell({ i, j, k }, labels, segments);
          }
        }
      }
    }
  }

  /** Goes on into cells where curves leave those between voxels of three labels. */
  void FollowOpenEnds(std::vector<Segment>& segments) const
  {
    using Number = Numbering::Number;
    std::vector<Number> places;
    for (const Segment& segment : segments)
    {
      places.insert(places.end(), segment.begin(), segment.end());
    }
    std::sort(places.begin(), places.end());
    std::set<Number> open; // triangles with a segment on one side only
    for (std::size_t i = 0; i < places.size(); ++i)
    {
      const bool again = (i > 0 && places[i] == places[i - 1]) ||
        (i + 1 < places.size() && places[i] == places[i + 1]);
      if (!again && !Numbering::IsCorner(places[i]))
      {
        open.insert(places[i]);
      }
    }
    std::set<Index> followed;
    std::vector<Number> todo(open.begin(), open.end());
    while (!todo.empty())
    {
      const Number place = todo.back();
      todo.pop_back();
      Index cell;
      if (!open.contains(place) ||
        !this->FindUntracedCell(this->Numbers.PlaceOf(place), followed, cell))
      {
        continue;
      }
      followed.insert(cell);
      const std::size_t before = segments.size();
      FineLabels labels;
      this->TraceCell(cell, labels, segments);
      for (std::size_t i = before; i < segments.size(); ++i)
      {
        for (const Number end : segments[i])
        {
          if (!Numbering::IsCorner(end) && open.erase(end) == 0)
          {
            open.insert(end);
            todo.push_back(end);
          }
        }
      }
    }
  }

private:
  bool HasThreeLabels(const Index& cell) const
  {
    const LabelId first = this->Space.VoxelId(cell);
    LabelId second = first;
    for (unsigned c = 1; c < 8; ++c)
    {
      const LabelId id =
        this->Space.VoxelId({ cell[0] + (c & 1), cell[1] + ((c >> 1) & 1), cell[2] + (c >> 2) });
      if (id != first && id != second)
      {
        if (second != first)
        {
          return true;
        }
        second = id;
      }
    }
    return false;
  }

  /** Of the two cells that share a triangle, the one that was not looked at. */
  bool FindUntracedCell(const Place& place, const std::set<Index>& followed, Index& cell) const
  {
    for (unsigned side = 0; side < 2; ++side)
    {
      bool exists = true;
      for (unsigned a = 0; a < 3; ++a)
      {
        const bool moves = ((place.Second | place.Third) >> a) & 1;
        cell[a] = place.Base[a] / Fine;
        if (!moves && place.Base[a] % Fine == 0)
        {
          cell[a] -= side;
        }
        exists &= cell[a] >= 0 && cell[a] + 1 < this->Space.LatticeDimensions()[a];
      }
      if (exists && !this->HasThreeLabels(cell) && !followed.contains(cell))
      {
        return true;
      }
    }
    return false;
  }

  /** Labels of the points of the fine lattice in a cell. */
  struct FineLabels
  {
    Index Cell{ -2, -2, -2 };
    std::array<LabelId, FineSide * FineSide * FineSide> Labels;

    LabelId& At(std::int64_t x, std::int64_t y, std::int64_t z)
    {
      return this->Labels[static_cast<std::size_t>((z * FineSide + y) * FineSide + x)];
    }
  };

  /** @param labels of the cell that was traced before, if any; receives those of this one */
  void TraceCell(const Index& cell, FineLabels& labels, std::vector<Segment>& segments) const
  {
    const bool isNext = labels.Cell == Index{ cell[0] - 1, cell[1], cell[2] };
    const auto label = [&](std::int64_t x, std::int64_t y, std::int64_t z) -> LabelId&
    { return labels.At(x, y, z); };
    labels.Cell = cell;
    for (std::int64_t z = 0; z <= Fine; ++z)
    {
      for (std::int64_t y = 0; y <= Fine; ++y)
      {
        label(0, y, z) = isNext ? label(Fine, y, z) : LabelId(0);
        for (std::int64_t x = isNext ? 1 : 0; x <= Fine; ++x)
        {
          label(x, y, z) =
            this->Space.LabelAt({ static_cast<double>(cell[0]) + static_cast<double>(x) / Fine,
              static_cast<double>(cell[1]) + static_cast<double>(y) / Fine,
              static_cast<double>(cell[2]) + static_cast<double>(z) / Fine });
        }
      }
    }
    for (std::int64_t z = 0; z < Fine; ++z)
    {
      for (std::int64_t y = 0; y < Fine; ++y)
      {
        for (std::int64_t x = 0; x < Fine; ++x)
        {
          for (const auto& order : Orders)
          {
            FineTetrahedron t;
            std::array<std::int64_t, 3> at{ x, y, z };
            std::uint8_t steps = 0;
            for (unsigned i = 0; i < 4; ++i)
            {
              t.Corners[i] = { Fine * cell[0] + at[0], Fine * cell[1] + at[1],
                Fine * cell[2] + at[2] };
              t.Steps[i] = steps;
              t.Labels[i] = label(at[0], at[1], at[2]);
              if (i < 3)
              {
                ++at[order[i]];
                steps = static_cast<std::uint8_t>(steps | (1u << order[i]));
              }
            }
            this->Trace(t, segments);
          }
        }
      }
    }
  }

  void Trace(const FineTetrahedron& t, std::vector<Segment>& segments) const
  {
    std::array<LabelId, 4> labels = t.Labels;
    const unsigned distinct = CountDistinct(labels.data(), labels.data() + 4);
    if (distinct < 3)
    {
      return;
    }
    const Numbering::Number corner =
      this->Numbers.NumberOf({ t.Corners[0], t.Steps[1], t.Steps[2], true });
    Segment ends;
    unsigned found = 0;
    for (unsigned i = 0; i < 4; ++i)
    {
      if (!this->Space.IsJunction(t.FacetLabels(i)))
      {
        continue;
      }
      if (distinct == 4)
      {
        segments.push_back({ corner, this->Numbers.NumberOf(t.Facet(i)) });
      }
      else
      {
        ends[found++] = this->Numbers.NumberOf(t.Facet(i));
      }
    }
    if (found == 2)
    {
      segments.push_back(ends);
    }
  }

  const LabelledSpace<Field>& Space;
  const BitMask<3>& Sites;
  const Numbering Numbers;
};

//------------------------------------------------------------------------------------------------
/** Where points of curves are. */
template <typename Field>
class Locator
{
public:
  explicit Locator(const LabelledSpace<Field>& space)
    : Space(space)
  {
  }

  /** The labels at the corners of a triangle. */
  std::array<LabelId, 3> LabelsOf(const Place& place) const
  {
    const std::array<Point<3>, 3> x = CornersOf(place);
    std::array<LabelId, 3> labels;
    for (unsigned i = 0; i < 3; ++i)
    {
      labels[i] = this->Space.LabelAt(x[i]);
    }
    return labels;
  }

  /** Lattice coordinates of where the labels of the corners of a triangle are equal. */
  Point<3> Locate(const Place& place) const
  {
    const std::array<Point<3>, 3> x = CornersOf(place);
    const std::array<LabelId, 3> labels = this->LabelsOf(place);
    std::array<unsigned, 3> inside;
    unsigned count = 0;
    for (unsigned i = 0; i < 3; ++i)
    {
      if (!this->Space.IsOutside(labels[i]))
      {
        inside[count++] = i;
      }
    }
    if (count == 1)
    {
      return x[inside[0]]; // on the edge of two faces
    }
    if (count == 2)
    {
      // On a face, on the line between the two.
      const auto [i, j] = std::pair{ inside[0], inside[1] };
      const double ahead = -this->Space.MarginAt(x[i], labels[j]);
      const double behind = -this->Space.MarginAt(x[j], labels[i]);
      return Interpolate(x[i], x[j], ahead + behind > 0.0 ? ahead / (ahead + behind) : 0.5);
    }
    // By how much label l is ahead of that of corner i, there.
    std::array<std::array<double, 3>, 3> ahead;
    for (unsigned i = 0; i < 3; ++i)
    {
      for (unsigned l = 0; l < 3; ++l)
      {
        ahead[i][l] = l == i ? 0.0 : this->Space.MarginAt(x[i], labels[l]);
      }
    }
    // Weights with sum 1 such that label 0 is as good as 1 and as 2: the cross product of the two rows.
    std::array<Point<3>, 2> rows;
    for (unsigned i = 0; i < 3; ++i)
    {
      rows[0][i] = ahead[i][0] - ahead[i][1];
      rows[1][i] = ahead[i][0] - ahead[i][2];
    }
    Point<3> weights{ rows[0][1] * rows[1][2] - rows[0][2] * rows[1][1],
      rows[0][2] * rows[1][0] - rows[0][0] * rows[1][2],
      rows[0][0] * rows[1][1] - rows[0][1] * rows[1][0] };
    const double sign = weights[0] + weights[1] + weights[2] < 0.0 ? -1.0 : 1.0;
    double sum = 0.0;
    for (double& w : weights)
    {
      w = std::max(sign * w, 0.0);
      sum += w;
    }
    Point<3> located{};
    for (unsigned i = 0; i < 3; ++i)
    {
      const double w = sum > 0.0 ? weights[i] / sum : 1.0 / 3.0;
      for (unsigned a = 0; a < 3; ++a)
      {
        located[a] += w * x[i][a];
      }
    }
    return located;
  }

private:
  static std::array<Point<3>, 3> CornersOf(const Place& place)
  {
    std::array<Point<3>, 3> x;
    for (unsigned a = 0; a < 3; ++a)
    {
      const auto coordinate = [&](unsigned steps)
      { return static_cast<double>(place.Base[a] + ((steps >> a) & 1)) / Fine; };
      x[0][a] = coordinate(0);
      x[1][a] = coordinate(place.Second);
      x[2][a] = coordinate(place.Third);
    }
    return x;
  }

  const LabelledSpace<Field>& Space;
};

//------------------------------------------------------------------------------------------------
/** The points of all curves and what is joined to what. */
template <typename Field>
class Graph
{
public:
  static constexpr std::uint32_t Nobody = 0xffffffffu;

  Graph(const std::vector<Segment>& segments, const LabelledSpace<Field>& space)
    : Space(space)
    , Where(space)
    , Numbers(space.LatticeDimensions())
  {
    for (const Segment& segment : segments)
    {
      this->Places.insert(this->Places.end(), segment.begin(), segment.end());
    }
    std::sort(this->Places.begin(), this->Places.end());
    this->Places.erase(std::unique(this->Places.begin(), this->Places.end()), this->Places.end());
    this->Neighbours.assign(this->Places.size(), { Nobody, Nobody, Nobody, Nobody });
    for (const Segment& segment : segments)
    {
      const std::uint32_t a = this->PositionOf(segment[0]);
      const std::uint32_t b = this->PositionOf(segment[1]);
      this->Join(a, b);
      this->Join(b, a);
    }
    this->Positions.resize(this->Places.size());
    for (std::uint32_t n = 0; n < this->Places.size(); ++n)
    {
      if (!this->IsCorner(n))
      {
        this->Positions[n] =
          space.ToFrame(this->Where.Locate(this->Numbers.PlaceOf(this->Places[n])));
      }
    }
    for (std::uint32_t n = 0; n < this->Places.size(); ++n)
    {
      if (!this->IsCorner(n))
      {
        continue;
      }
      const auto ways = std::count_if(this->Neighbours[n].begin(), this->Neighbours[n].end(),
        [](std::uint32_t other) { return other != Nobody; });
      for (unsigned i = 0; i < ways; ++i)
      {
        for (unsigned a = 0; a < 3; ++a)
        {
          this->Positions[n][a] +=
            this->Positions[this->Neighbours[n][i]][a] / static_cast<double>(ways);
        }
      }
    }
  }

  std::size_t NumberOfCorners() const
  {
    return static_cast<std::size_t>(
      std::count_if(this->Places.begin(), this->Places.end(), Numbering::IsCorner));
  }

  /** First what begins or ends somewhere, then what is closed. */
  std::vector<JunctionCurves::Curve> Curves() const
  {
    std::vector<JunctionCurves::Curve> curves;
    std::vector<bool> visited(this->Places.size());
    for (const bool closed : { false, true })
    {
      for (std::uint32_t n = 0; n < this->Places.size(); ++n)
      {
        const bool isEnd = this->IsCorner(n) || this->Neighbours[n][1] == Nobody;
        if (visited[n] || isEnd == closed)
        {
          continue;
        }
        visited[n] = true;
        const unsigned ways = closed ? 1 : 4;
        for (unsigned i = 0; i < ways && this->Neighbours[n][i] != Nobody; ++i)
        {
          if (!visited[this->Neighbours[n][i]])
          {
            curves.push_back(this->Follow(n, this->Neighbours[n][i], visited));
          }
        }
      }
    }
    return curves;
  }

private:
  bool IsCorner(std::uint32_t n) const { return Numbering::IsCorner(this->Places[n]); }

  std::uint32_t PositionOf(Numbering::Number place) const
  {
    return static_cast<std::uint32_t>(
      std::lower_bound(this->Places.begin(), this->Places.end(), place) - this->Places.begin());
  }

  void Join(std::uint32_t from, std::uint32_t to)
  {
    auto& neighbours = this->Neighbours[from];
    *std::find(neighbours.begin(), neighbours.end(), Nobody) = to;
  }

  /** From `start` by way of `next` to a corner, to an open end, or back to the start. */
  JunctionCurves::Curve Follow(
    std::uint32_t start, std::uint32_t next, std::vector<bool>& visited) const
  {
    JunctionCurves::Curve curve{ { this->Positions[start] },
      this->Where.LabelsOf(this->Numbers.PlaceOf(this->Places[next])), false };
    for (LabelId& label : curve.Labels)
    {
      label = this->Space.IsOutside(label) ? LabelId{ 0 } : label;
    }
    std::sort(curve.Labels.begin(), curve.Labels.end());
    std::uint32_t previous = start;
    while (next != Nobody && (next != start || this->IsCorner(next)))
    {
      curve.Points.push_back(this->Positions[next]);
      if (this->IsCorner(next))
      {
        return curve;
      }
      visited[next] = true;
      const auto& around = this->Neighbours[next];
      const std::uint32_t beyond = around[0] == previous ? around[1] : around[0];
      previous = next;
      next = beyond;
    }
    curve.IsClosed = next == start;
    return curve;
  }

  const LabelledSpace<Field>& Space;
  const Locator<Field> Where;
  const Numbering Numbers;
  std::vector<Numbering::Number> Places; ///< ascending
  std::vector<std::array<std::uint32_t, 4>>
    Neighbours; ///< two; up to four of a corner; one of an open end
  std::vector<Point<3>> Positions;
};

} // namespace

//------------------------------------------------------------------------------------------------
template <typename Field>
JunctionCurves::JunctionCurves(const LabelImage<3>& image, const Field& field,
  const BitMask<3>& sites, unsigned threads, const std::stop_token& stop)
{
  const auto layers = static_cast<std::size_t>(field.LatticeDimensions()[2] - 1);
  std::vector<std::vector<Segment>> byLayer(layers);
  const LabelledSpace<Field> space(image, field);
  const Tracer<Field> tracer(space, sites);
  ParallelFor(
    0, layers, 1, threads,
    [&](std::size_t first, std::size_t last)
    {
      for (std::size_t k = first; k < last; ++k)
      {
        tracer.TraceLayer(static_cast<std::int64_t>(k), byLayer[k]);
      }
    },
    stop);
  std::vector<Segment> segments;
  for (const std::vector<Segment>& layer : byLayer)
  {
    segments.insert(segments.end(), layer.begin(), layer.end());
  }
  tracer.FollowOpenEnds(segments);
  ThrowIfStopped(stop);
  const Graph<Field> graph(segments, space);
  this->Corners = graph.NumberOfCorners();
  this->All = graph.Curves();
}

template JunctionCurves::JunctionCurves(
  const LabelImage<3>&, const LabelField<3>&, const BitMask<3>&, unsigned, const std::stop_token&);
template JunctionCurves::JunctionCurves(
  const LabelImage<3>&, const ScalarField<3>&, const BitMask<3>&, unsigned, const std::stop_token&);

} // namespace voxplex
