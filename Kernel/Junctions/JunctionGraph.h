// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file JunctionGraph.h
 * @brief Internal to JunctionCurves: the points of all curves, and the curves from end to end.
 */
#ifndef voxplex_JunctionGraph_h
#define voxplex_JunctionGraph_h

#include "Base/UninitialisedVector.h"
#include "Junctions/JunctionCurves.h"
#include "Junctions/JunctionLattice.h"
#include "Parallel/ChunkCounts.h"
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
    CachedMargins& entry = this->Entries[Hash(fine)];
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

  struct CachedMargins
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
  std::vector<CachedMargins> Entries;
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
  Point<3> Locate(const LatticeSimplex& place, const std::array<LabelId, 3>& labels)
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
  static std::array<Index, 3> CornersOf(const LatticeSimplex& place)
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

  Graph(std::span<const Segment> segments, const LabelledSpace<Field>& space, unsigned threads,
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
  void JoinEnds(std::span<const Segment> segments, unsigned threads, const std::stop_token& stop)
  {
    struct End
    {
      Numbering::Number Place;
      std::uint32_t Segment; ///< twice the number of the segment, plus 0 or 1 for the end
    };
    const std::size_t count = 2 * segments.size();
    const auto forChunks = [&](auto&& function)
    { ParallelFor(0, count, ChunkCounts::Grain, threads, function, stop); };
    UninitialisedVector<End> memory(2 * count);
    forChunks(
      [&](std::size_t first, std::size_t last)
      {
        for (std::size_t e = first; e < last; ++e)
        {
          memory[e] = { segments[e / 2].Ends[e % 2], static_cast<std::uint32_t>(e) };
        }
      });
    const std::span<End> all(memory);
    // Ends with the same place keep their order.
    const std::span<const End> ends = ParallelRadixSort(
      all.first(count), all.last(count), this->Numbers.Bits(),
      [](const End& end) { return end.Place; }, threads, stop);

    const auto isFirst = [&](std::size_t i) // of a place
    { return i == 0 || ends[i].Place != ends[i - 1].Place; };
    ChunkCounts places(count);
    forChunks(
      [&](std::size_t first, std::size_t last)
      {
        std::size_t number = 0;
        for (std::size_t i = first; i < last; ++i)
        {
          number += isFirst(i) ? 1 : 0;
        }
        places.OfChunk(first) = number;
      });
    const std::size_t number = places.TurnIntoPlaces();
    this->Places.resize(number);
    this->Labels.resize(number);
    this->Neighbours.resize(number);
    UninitialisedVector<std::uint32_t> positions(count); // index of each end's place
    forChunks(
      [&](std::size_t first, std::size_t last)
      {
        std::size_t n = places.OfChunk(first) - 1; // of the place that began before
        for (std::size_t i = first; i < last; ++i)
        {
          const End& end = ends[i];
          if (isFirst(i))
          {
            ++n;
            this->Places[n] = end.Place;
            this->Labels[n] = segments[end.Segment / 2].Labels[end.Segment % 2];
          }
          positions[end.Segment] = static_cast<std::uint32_t>(n);
        }
      });
    forChunks(
      [&](std::size_t first, std::size_t last)
      {
        for (std::size_t i = first; i < last; ++i)
        {
          if (isFirst(i))
          {
            auto& neighbours = this->Neighbours[positions[ends[i].Segment]];
            neighbours.fill(Nobody);
            std::size_t ways = 0;
            for (std::size_t k = i; k < count && ends[k].Place == ends[i].Place; ++k)
            {
              neighbours[ways++] = positions[ends[k].Segment ^ 1u]; // at the segment's other end
            }
          }
        }
      });
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
              locator.Locate(this->Numbers.Decode(this->Places[n]), this->Labels[n]));
          }
        }
      },
      stop);
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
  UninitialisedVector<Numbering::Number> Places; ///< ascending
  /** The labels of their triangles; at a corner, three of its four labels. */
  UninitialisedVector<std::array<LabelId, 3>> Labels;
  /** Two of each point; up to four of a corner; one of an open end. */
  UninitialisedVector<std::array<std::uint32_t, 4>> Neighbours;
  std::vector<Point<3>> Positions;
};

} // namespace voxplex::junctions

#endif
