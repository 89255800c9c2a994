// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Conformity/EdgeSpindles.h"

#include "Delaunay/VertexStar.h"
#include "Geometry/SimplexQuality.h"
#include "Parallel/ParallelFor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>

namespace voxplex
{

namespace
{

using Corners = std::array<VertexId, 4>;

/**
 * Distances of new vertices from the midpoint of the edge, as fractions of the distance to the
 * vertices around it, or of the edge's length if these vertices are farther away.
 */
constexpr std::array<double, 5> Widths{ 0.25, 1.0 / 3.0, 0.5, 2.0 / 3.0, 0.75 };

/**
 * Shapes with these values count as equally good: angles of tetrahedra and of interfaces in
 * degrees, and the radius-edge ratio.
 */
constexpr double GoodDihedralAngle = 9.0;
constexpr double GoodFacetAngle = 20.0;
constexpr double GoodRadiusEdgeRatio = 2.5;

/**
 * Scores are the sine of an angle over that of a good angle, or a good ratio over a ratio. A
 * smaller score may be due to rounding.
 */
constexpr double SmallestScore = 1e-6;

/** A tetrahedron around an edge ab, or its piece at the edge: abrs, positively oriented. */
struct Sector
{
  SimplexId Owner;
  Corners Whole; ///< its vertices as they are stored
  VertexId R;
  VertexId S; ///< R of the next sector
  LabelId Label;
};

/** The sectors around an edge, in cyclic order. */
struct Ring
{
  std::array<VertexId, 2> Ends;
  std::vector<Sector> Sectors;

  std::size_t Next(std::size_t k) const { return k + 1 < this->Sectors.size() ? k + 1 : 0; }
  std::size_t Previous(std::size_t k) const { return (k > 0 ? k : this->Sectors.size()) - 1; }
};

/** The sectors whose part at the edge gets a label. */
struct Filling
{
  LabelId Label = 0;
  std::vector<std::uint8_t> Gives; ///< by sector, 1 if its part gets the label
  double Width = 0.0;
};

/** Whether each label of a cyclic sequence has one run. Background may have more. */
bool HasOneRunOfEach(std::span<const LabelId> labels)
{
  std::vector<LabelId> begun;
  for (std::size_t k = 0; k < labels.size(); ++k)
  {
    const LabelId before = labels[(k > 0 ? k : labels.size()) - 1];
    if (labels[k] != 0 && labels[k] != before)
    {
      if (std::find(begun.begin(), begun.end(), labels[k]) != begun.end())
      {
        return false;
      }
      begun.push_back(labels[k]);
    }
  }
  return true;
}

//------------------------------------------------------------------------------------------------
class SpindleMaker
{
public:
  SpindleMaker(
    const Triangulation<3>& triangulation, const Domain<3>& domain, std::span<const LabelId> labels)
    : Source(triangulation)
    , Image(domain)
    , Labels(labels)
  {
  }

  /** @return false if it cannot */
  bool Open(const InterfaceEdge& edge)
  {
    const std::optional<Ring> ring = this->RingOf(edge.Ends);
    if (!ring)
    {
      return false;
    }
    const std::optional<Filling> best = this->BestFilling(*ring);
    if (!best)
    {
      return false;
    }
    const std::vector<VertexId> onFacets = this->AddPointsOnFacets(*ring, *best);
    for (std::size_t k = 0; k < ring->Sectors.size(); ++k)
    {
      const std::vector<Piece> pieces = this->PiecesOf(*ring, *best, k, onFacets);
      if (!pieces.empty())
      {
        this->Replace(ring->Sectors[k], pieces);
      }
    }
    return true;
  }

  Subdivision Result()
  {
    for (auto& [owner, pieces] : this->Pieces)
    {
      this->Parts.Replaced.push_back(owner);
      this->Parts.Pieces.insert(this->Parts.Pieces.end(), pieces.begin(), pieces.end());
    }
    return std::move(this->Parts);
  }

private:
  const Point<3>& Position(VertexId v) const
  {
    const VertexId end = this->Source.VertexIdEnd();
    return v < end ? this->Source.Position(v) : this->Parts.Points[v - end];
  }

  VertexId AddPoint(const Point<3>& p)
  {
    this->Parts.Points.push_back(p);
    return this->Source.VertexIdEnd() + static_cast<VertexId>(this->Parts.Points.size() - 1);
  }

  /** Nothing if the triangulation ends at the edge. */
  std::optional<Ring> RingOf(const std::array<VertexId, 2>& ends) const
  {
    std::map<VertexId, Sector> byFirst;
    const auto add = [&](SimplexId owner, const Corners& v, LabelId label)
    {
      const auto at = [&](VertexId end)
      { return static_cast<unsigned>(std::find(v.begin(), v.end(), end) - v.begin()); };
      const unsigned a = at(ends[0]);
      const unsigned b = at(ends[1]);
      if (a == 4 || b == 4)
      {
        return;
      }
      // Let i, j, k, l be a tetrahedron's vertices with i < j and k < l. They are an even
      // permutation if j - i is odd. If it is even, exchange i and j.
      std::array<VertexId, 2> others{};
      std::size_t n = 0;
      for (unsigned i = 0; i < 4; ++i)
      {
        if (i != a && i != b)
        {
          others[n++] = v[i];
        }
      }
      const bool isEven = (((a < b ? b - a : a - b) % 2) == 1) == (a < b);
      byFirst[others[isEven ? 0 : 1]] = { owner, v, others[isEven ? 0 : 1], others[isEven ? 1 : 0],
        label };
    };
    for (const SimplexId t :
      StarOf(this->Source, ends[0], this->Source.GetVertex(ends[0]).Incident))
    {
      const auto pieces = this->Pieces.find(t);
      if (pieces == this->Pieces.end())
      {
        add(t, this->Source.GetSimplex(t).V, this->Labels[t]);
        continue;
      }
      for (const Piece& piece : pieces->second)
      {
        add(t, piece.V, piece.Label);
      }
    }
    Ring ring{ ends, {} };
    for (auto at = byFirst.begin(); at != byFirst.end() && ring.Sectors.size() < byFirst.size();
         at = byFirst.find(at->second.S))
    {
      ring.Sectors.push_back(at->second);
    }
    const bool isClosed = ring.Sectors.size() == byFirst.size() && !ring.Sectors.empty() &&
      ring.Sectors.back().S == ring.Sectors.front().R;
    return isClosed ? std::optional<Ring>(std::move(ring)) : std::nullopt;
  }

  /** The first sector of each run of a label. */
  static std::vector<std::size_t> RunsOf(const Ring& ring)
  {
    std::vector<std::size_t> runs;
    for (std::size_t k = 0; k < ring.Sectors.size(); ++k)
    {
      if (ring.Sectors[k].Label != ring.Sectors[ring.Previous(k)].Label)
      {
        runs.push_back(k);
      }
    }
    return runs;
  }

  /** A filling that leaves each label one run, and its rating. */
  struct Candidate
  {
    Filling How;
    bool DentsBorder = true;
    double Score = SmallestScore;

    bool IsBetterThan(const Candidate& other) const
    {
      return this->Score > SmallestScore &&
        (this->DentsBorder != other.DentsBorder ? other.DentsBorder : this->Score > other.Score);
    }
  };

  /** Nothing if every filling makes a flat tetrahedron or facet. */
  std::optional<Filling> BestFilling(const Ring& ring)
  {
    const std::vector<std::size_t> runs = RunsOf(ring);
    std::vector<LabelId> labels;
    labels.reserve(runs.size());
    for (const std::size_t k : runs)
    {
      labels.push_back(ring.Sectors[k].Label);
    }
    std::sort(labels.begin(), labels.end());
    labels.erase(std::unique(labels.begin(), labels.end()), labels.end());
    Candidate best;
    for (const LabelId label : labels)
    {
      for (std::size_t first = 0; first < runs.size(); ++first)
      {
        if (ring.Sectors[runs[first]].Label != label)
        {
          this->TryFrom(ring, runs, first, label, best);
        }
      }
    }
    return best.Score > SmallestScore ? std::optional<Filling>(std::move(best.How)) : std::nullopt;
  }

  /** Fills runs from `first` on, as few as possible, and keeps the best candidate. */
  void TryFrom(const Ring& ring, std::span<const std::size_t> runs, std::size_t first,
    LabelId label, Candidate& best)
  {
    bool found = false;
    for (std::size_t number = 1; number <= runs.size() && !found; ++number)
    {
      Candidate next;
      next.How = Fill(ring, runs, label, first, number);
      if (!IsManifold(ring, next.How))
      {
        continue;
      }
      next.DentsBorder = this->DentsBorder(ring, next.How);
      for (const double width : Widths)
      {
        next.How.Width = width;
        next.Score = this->ScoreOf(ring, next.How);
        found = found || next.Score > SmallestScore;
        if (next.IsBetterThan(best))
        {
          best = next;
        }
      }
    }
  }

  /** Fills `number` consecutive runs from `first` on. Sectors that already have the label stay. */
  static Filling Fill(const Ring& ring, std::span<const std::size_t> runs, LabelId label,
    std::size_t first, std::size_t number)
  {
    Filling filling{ label, std::vector<std::uint8_t>(ring.Sectors.size(), 0), 0.0 };
    std::size_t k = runs[first];
    const std::size_t end = runs[(first + number) % runs.size()];
    do
    {
      filling.Gives[k] = ring.Sectors[k].Label != label ? 1 : 0;
      k = ring.Next(k);
    } while (k != end);
    return filling;
  }

  static bool IsManifold(const Ring& ring, const Filling& filling)
  {
    std::vector<LabelId> labels;
    for (std::size_t k = 0; k < ring.Sectors.size(); ++k)
    {
      labels.push_back(filling.Gives[k] != 0 ? filling.Label : ring.Sectors[k].Label);
    }
    return HasOneRunOfEach(labels);
  }

  /**
   * Whether there is a new vertex on the facet before a sector. There is none if the label
   * continues beyond the facet.
   */
  static bool HasPointBefore(const Ring& ring, const Filling& filling, std::size_t k)
  {
    const auto isOf = [&](std::size_t sector)
    { return filling.Gives[sector] == 0 && ring.Sectors[sector].Label == filling.Label; };
    const std::size_t before = ring.Previous(k);
    return (filling.Gives[k] != 0 || filling.Gives[before] != 0) && !isOf(k) && !isOf(before);
  }

  /** The new vertex on the facet before each sector; None if there is none. */
  std::vector<VertexId> AddPointsOnFacets(const Ring& ring, const Filling& filling)
  {
    std::vector<VertexId> points(ring.Sectors.size(), None);
    for (std::size_t k = 0; k < points.size(); ++k)
    {
      if (HasPointBefore(ring, filling, k))
      {
        points[k] =
          this->AddPointBeside(ring.Ends, this->Position(ring.Sectors[k].R), filling.Width);
      }
    }
    return points;
  }

  VertexId AddPointBeside(const std::array<VertexId, 2>& ends, const Point<3>& to, double width)
  {
    const Point<3> middle = this->MiddleOf(ends);
    const double length = Distance(this->Position(ends[0]), this->Position(ends[1]));
    const double part = width * std::min(1.0, length / Distance(middle, to));
    return this->AddPoint(Interpolate(middle, to, part));
  }

  Point<3> MiddleOf(const std::array<VertexId, 2>& ends) const
  {
    return Interpolate(this->Position(ends[0]), this->Position(ends[1]), 0.5);
  }

  /** The pieces of a sector; empty if it stays whole. May add a point. */
  std::vector<Piece> PiecesOf(
    const Ring& ring, const Filling& filling, std::size_t k, std::span<const VertexId> onFacets)
  {
    const Sector& sector = ring.Sectors[k];
    const Corners whole{ ring.Ends[0], ring.Ends[1], sector.R, sector.S };
    const VertexId p = onFacets[k];
    const VertexId q = onFacets[ring.Next(k)];
    const LabelId own = sector.Label;
    const LabelId atEdge = filling.Gives[k] != 0 ? filling.Label : own;
    if (p == None && q == None)
    {
      return filling.Gives[k] != 0 ? this->SplitWithin(whole, own, atEdge, filling.Width)
                                   : std::vector<Piece>();
    }
    std::vector<Piece> pieces;
    if (p != None && q != None)
    {
      std::vector<Piece> other;
      CutOff(CutOff(whole, 2, p, own, pieces), 3, q, own, pieces);
      CutOff(CutOff(whole, 3, q, own, other), 2, p, own, other);
      if (this->ShapesOf(other) > this->ShapesOf(pieces))
      {
        pieces.swap(other);
      }
      pieces.push_back({ { ring.Ends[0], ring.Ends[1], p, q }, atEdge });
    }
    else
    {
      const Corners rest =
        p != None ? CutOff(whole, 2, p, own, pieces) : CutOff(whole, 3, q, own, pieces);
      pieces.push_back({ rest, atEdge });
    }
    return pieces;
  }

  /**
   * Cuts two pieces off abrs. Neither has both a and b.
   * @param i 2 or 3: the number of the vertex r or s
   * @param point lies on the facet of a, b and vertex i, and replaces vertex i
   * @return the rest
   */
  static Corners CutOff(
    const Corners& v, unsigned i, VertexId point, LabelId label, std::vector<Piece>& pieces)
  {
    for (const unsigned end : { 0u, 1u })
    {
      pieces.push_back({ v, label });
      pieces.back().V[end] = point;
    }
    Corners rest = v;
    rest[i] = point;
    return rest;
  }

  /**
   * Splits a sector by a point inside it. Used if the label at the edge continues beyond both
   * facets.
   */
  std::vector<Piece> SplitWithin(const Corners& whole, LabelId own, LabelId atEdge, double width)
  {
    const VertexId point =
      this->AddPointBeside({ whole[0], whole[1] }, this->MiddleOf({ whole[2], whole[3] }), width);
    std::vector<Piece> pieces;
    for (unsigned i = 0; i < 4; ++i)
    {
      pieces.push_back({ whole, i < 2 ? own : atEdge });
      pieces.back().V[i] = point;
    }
    return pieces;
  }

  /** The score of the tetrahedra in the mesh; 0 if a tetrahedron is flat or inverted. */
  double ShapesOf(std::span<const Piece> pieces) const
  {
    const double goodSine = std::sin(GoodDihedralAngle / DegreesPerRadian);
    double smallest = 1.0 / goodSine;
    for (const Piece& piece : pieces)
    {
      if (piece.Label != 0)
      {
        std::array<const Point<3>*, 4> points;
        for (unsigned i = 0; i < 4; ++i)
        {
          points[i] = &this->Position(piece.V[i]);
        }
        const bool isPositive = SignedVolume<3>(points.data()) > 0.0;
        smallest = !isPositive
          ? 0.0
          : std::min({ smallest, SmallestDihedralSine(points.data()) / goodSine,
              GoodRadiusEdgeRatio / RadiusEdgeRatio<3>(points.data()) });
      }
    }
    return smallest;
  }

  /** The score of the angles of interfaces between pieces. */
  double FacetsOf(std::span<const Piece> pieces) const
  {
    std::vector<std::pair<std::array<VertexId, 3>, LabelId>> facets;
    for (const Piece& piece : pieces)
    {
      for (unsigned i = 0; i < 4; ++i)
      {
        std::array<VertexId, 3> facet{ piece.V[(i + 1) % 4], piece.V[(i + 2) % 4],
          piece.V[(i + 3) % 4] };
        std::sort(facet.begin(), facet.end());
        facets.emplace_back(facet, piece.Label);
      }
    }
    std::sort(facets.begin(), facets.end());
    double smallest = 90.0;
    for (std::size_t f = 1; f < facets.size(); ++f)
    {
      const auto& v = facets[f].first;
      if (v == facets[f - 1].first && facets[f].second != facets[f - 1].second)
      {
        const std::array<double, 3> angles =
          PlanarAngles(this->Position(v[0]), this->Position(v[1]), this->Position(v[2]));
        smallest = std::min(smallest, *std::min_element(angles.begin(), angles.end()));
      }
    }
    return std::sin(smallest / DegreesPerRadian) / std::sin(GoodFacetAngle / DegreesPerRadian);
  }

  /** The score of all pieces of a ring. Removes the points it adds. */
  double ScoreOf(const Ring& ring, const Filling& filling)
  {
    const std::size_t points = this->Parts.Points.size();
    const std::vector<VertexId> onFacets = this->AddPointsOnFacets(ring, filling);
    std::vector<Piece> all;
    for (std::size_t k = 0; k < ring.Sectors.size(); ++k)
    {
      const std::vector<Piece> pieces = this->PiecesOf(ring, filling, k, onFacets);
      all.insert(all.end(), pieces.begin(), pieces.end());
    }
    const double score = std::min(this->ShapesOf(all), this->FacetsOf(all));
    this->Parts.Points.resize(points);
    return score;
  }

  /**
   * Whether a filling makes a dent in a face where the image cuts the object, or adds a piece
   * beyond the image's border.
   */
  bool DentsBorder(const Ring& ring, const Filling& filling) const
  {
    const ImageBorder<3>* const border = this->Image.Border();
    for (std::size_t k = 0; k < ring.Sectors.size() && border; ++k)
    {
      const Sector& sector = ring.Sectors[k];
      if (filling.Gives[k] == 0)
      {
        continue;
      }
      const Point<3> centre =
        Interpolate(this->MiddleOf(ring.Ends), this->MiddleOf({ sector.R, sector.S }), 0.5);
      if (sector.Label == 0 ? border->IsBeyond(centre)
                            : filling.Label == 0 && this->HasFacetOnBorder(*border, ring, sector))
      {
        return true;
      }
    }
    return false;
  }

  /** Whether a facet at the edge is on a face where the image cuts the object. */
  bool HasFacetOnBorder(const ImageBorder<3>& border, const Ring& ring, const Sector& sector) const
  {
    const auto faces = [&](VertexId v) { return border.FacesAt(this->Position(v)); };
    return (faces(ring.Ends[0]) & faces(ring.Ends[1]) & (faces(sector.R) | faces(sector.S))) != 0;
  }

  void Replace(const Sector& sector, const std::vector<Piece>& pieces)
  {
    std::vector<Piece>& all = this->Pieces[sector.Owner];
    std::erase_if(all, [&](const Piece& piece) { return piece.V == sector.Whole; });
    all.insert(all.end(), pieces.begin(), pieces.end());
  }

  const Triangulation<3>& Source;
  const Domain<3>& Image;
  const std::span<const LabelId> Labels;
  Subdivision Parts; ///< has its points now; the rest is set at the end
  std::map<SimplexId, std::vector<Piece>> Pieces; ///< of tetrahedra that were cut
};

} // namespace

//------------------------------------------------------------------------------------------------
SpindleResult MakeSpindles(const Triangulation<3>& triangulation, const Domain<3>& domain,
  std::span<const LabelId> labels, std::span<const InterfaceEdge> edges,
  const std::stop_token& stop)
{
  SpindleResult result;
  SpindleMaker maker(triangulation, domain, labels);
  for (const InterfaceEdge& edge : edges)
  {
    ThrowIfStopped(stop);
    if (!maker.Open(edge))
    {
      result.Left.push_back(edge);
    }
  }
  result.Parts = maker.Result();
  return result;
}

} // namespace voxplex
