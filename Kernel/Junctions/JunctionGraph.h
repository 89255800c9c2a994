// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file JunctionGraph.h
 * @brief Internal to JunctionCurves: the points of all curves, and the curves from end to end.
 */
#ifndef voxplex_JunctionGraph_h
#define voxplex_JunctionGraph_h

#include "Junctions/JunctionCurves.h"
#include "Junctions/JunctionLattice.h"
#include "Parallel/ParallelFor.h"
#include "Parallel/ParallelSort.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <stop_token>
#include <utility>
#include <vector>

namespace voxplex::junctions
{

/** Margins of three labels at points of the fine lattice, with a cache of the latest queries. */
template <typename Field>
class KnownMargins
{
public:
  explicit KnownMargins(const LabelledSpace<Field>& space)
    : Space(space)
    , Entries(NumberOfEntries)
  {
  }

  std::array<double, 3> At(const Index& fine, const std::array<LabelId, 3>& labels)
  {
    std::array<double, 3> margins;
    Entry& entry = this->Entries[Hash(fine)];
    if (entry.Fine == fine && entry.Find(labels, margins))
    {
      return margins;
    }
    margins = this->Space.MarginsAt(LabelledSpace<Field>::OfFine(fine), labels);
    entry = { fine, labels, margins };
    return margins;
  }

private:
  static constexpr std::size_t NumberOfEntries = 4096; ///< a power of two

  struct Entry
  {
    Index Fine{ -1, -1, -1 };
    std::array<LabelId, 3> Labels{};
    std::array<double, 3> Margins{};

    /** False if the entry lacks one of the labels. */
    bool Find(const std::array<LabelId, 3>& labels, std::array<double, 3>& margins) const
    {
      for (unsigned i = 0; i < 3; ++i)
      {
        const auto found = std::find(this->Labels.begin(), this->Labels.end(), labels[i]);
        if (found == this->Labels.end())
        {
          return false;
        }
        margins[i] = this->Margins[static_cast<std::size_t>(found - this->Labels.begin())];
      }
      return true;
    }
  };

  /** Neighbours have different hash values. */
  static std::size_t Hash(const Index& fine)
  {
    return static_cast<std::size_t>(fine[0] + 97 * fine[1] + 1031 * fine[2]) &
      (NumberOfEntries - 1);
  }

  const LabelledSpace<Field>& Space;
  std::vector<Entry> Entries;
};

//------------------------------------------------------------------------------------------------
/** Computes the positions of points of curves. */
template <typename Field>
class Locator
{
public:
  explicit Locator(const LabelledSpace<Field>& space)
    : Space(space)
    , Margins(space)
  {
  }

  /** Lattice coordinates of the point of a triangle where the labels of its corners are equal. */
  Point<3> Locate(const Place& place, const std::array<LabelId, 3>& labels)
  {
    const std::array<Index, 3> corners = CornersOf(place);
    std::array<Point<3>, 3> x;
    std::transform(corners.begin(), corners.end(), x.begin(), LabelledSpace<Field>::OfFine);
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
      return x[inside[0]]; // on the edge between two faces
    }
    if (count == 2)
    {
      // On a face: a point of the line between the two corners. Not both values are 0: of tied
      // labels the smallest wins, at either end.
      const auto [i, j] = std::pair{ inside[0], inside[1] };
      const double ahead = -this->Space.MarginAt(x[i], labels[j]);
      const double behind = -this->Space.MarginAt(x[j], labels[i]);
      return Interpolate(x[i], x[j], ahead / (ahead + behind));
    }
    // ahead[i][l]: by how much label l is ahead of the label of corner i, at corner i.
    std::array<std::array<double, 3>, 3> ahead;
    for (unsigned i = 0; i < 3; ++i)
    {
      ahead[i] = this->Margins.At(corners[i], labels);
      ahead[i][i] = 0.0;
    }
    // Weights with sum 1 for which label 0 equals labels 1 and 2: the cross product of the two
    // rows.
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
  static std::array<Index, 3> CornersOf(const Place& place)
  {
    std::array<Index, 3> corners;
    for (unsigned a = 0; a < 3; ++a)
    {
      const auto coordinate = [&](unsigned steps) { return place.Base[a] + ((steps >> a) & 1); };
      corners[0][a] = coordinate(0);
      corners[1][a] = coordinate(place.Second);
      corners[2][a] = coordinate(place.Third);
    }
    return corners;
  }

  const LabelledSpace<Field>& Space;
  KnownMargins<Field> Margins;
};

//------------------------------------------------------------------------------------------------
/** The points of all curves, and which points are joined. */
template <typename Field>
class Graph
{
public:
  static constexpr std::uint32_t Nobody = 0xffffffffu;

  Graph(const std::vector<Segment>& segments, const LabelledSpace<Field>& space, unsigned threads,
    const std::stop_token& stop)
    : Space(space)
    , Numbers(space.LatticeDimensions())
  {
    this->JoinEnds(segments, threads, stop);
    this->LocatePlaces(threads, stop);
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

  /** First the curves with ends, then the closed curves. */
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

  /** Finds the places, in ascending order, and their neighbours, in the order of the segments. */
  void JoinEnds(const std::vector<Segment>& segments, unsigned threads, const std::stop_token& stop)
  {
    struct End
    {
      Numbering::Number Place;
      std::uint32_t Segment; ///< twice the number of the segment, plus 0 or 1 for the end
    };
    const std::size_t count = 2 * segments.size();
    std::vector<End> memory(2 * count);
    for (std::uint32_t e = 0; e < count; ++e)
    {
      memory[e] = { segments[e / 2].Ends[e % 2], e };
    }
    const std::span<End> all(memory);
    const std::span<const End> ends = ParallelRadixSort(
      all.first(count), all.last(count), this->Numbers.Bits(),
      [](const End& end) { return end.Place; }, threads, stop);
    std::vector<std::uint32_t> positions(count); // index of each end's place
    for (const End& end : ends)
    {
      if (this->Places.empty() || this->Places.back() != end.Place)
      {
        this->Places.push_back(end.Place);
        this->Labels.push_back(segments[end.Segment / 2].Labels[end.Segment % 2]);
      }
      positions[end.Segment] = static_cast<std::uint32_t>(this->Places.size() - 1);
    }
    this->Neighbours.assign(this->Places.size(), { Nobody, Nobody, Nobody, Nobody });
    for (std::size_t e = 0; e < count; e += 2)
    {
      this->Join(positions[e], positions[e + 1]);
      this->Join(positions[e + 1], positions[e]);
    }
  }

  /** Computes the positions of all places but corners. */
  void LocatePlaces(unsigned threads, const std::stop_token& stop)
  {
    this->Positions.resize(this->Places.size());
    // Each chunk has a cache of its own.
    const std::size_t chunks = 4 * std::size_t{ NumberOfThreads(threads) };
    const std::size_t grain = std::max<std::size_t>(4096, this->Places.size() / chunks);
    ParallelFor(
      0, this->Places.size(), grain, threads,
      [this](std::size_t first, std::size_t last)
      {
        Locator<Field> locator(this->Space);
        for (auto n = static_cast<std::uint32_t>(first); n < last; ++n)
        {
          if (!this->IsCorner(n))
          {
            this->Positions[n] = this->Space.ToFrame(
              locator.Locate(this->Numbers.PlaceOf(this->Places[n]), this->Labels[n]));
          }
        }
      },
      stop);
  }

  void Join(std::uint32_t from, std::uint32_t to)
  {
    auto& neighbours = this->Neighbours[from];
    *std::find(neighbours.begin(), neighbours.end(), Nobody) = to;
  }

  /**
   * Follows a curve from `start` by way of `next` to a corner, to an open end, or back to the
   * start.
   */
  JunctionCurves::Curve Follow(
    std::uint32_t start, std::uint32_t next, std::vector<bool>& visited) const
  {
    JunctionCurves::Curve curve{ { this->Positions[start] }, this->Labels[next], false };
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
  const Numbering Numbers;
  std::vector<Numbering::Number> Places; ///< ascending
  /** The labels of their triangles; at a corner, three of its four labels. */
  std::vector<std::array<LabelId, 3>> Labels;
  /** Two of each point; up to four of a corner; one of an open end. */
  std::vector<std::array<std::uint32_t, 4>> Neighbours;
  std::vector<Point<3>> Positions;
};

} // namespace voxplex::junctions

#endif
