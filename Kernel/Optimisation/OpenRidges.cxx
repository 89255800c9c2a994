// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Optimisation/OpenRidges.h"

#include "Optimisation/Patch.h"
#include "Optimisation/PieceShapes.h"
#include "Parallel/ParallelFor.h"
#include "Refinement/Rules/PlaneLabels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

namespace voxplex
{

namespace
{

using namespace opening;

/**
 * Distances of new vertices from the centroid of the ridge, as fractions of the distance to the
 * vertices around it, or of the ridge's longest edge if these vertices are farther away.
 */
constexpr std::array<double, 5> Widths{ 0.25, 1.0 / 3.0, 0.5, 2.0 / 3.0, 0.75 };

/** The vertices of a ridge: an edge in 3D, a triangle in 4D. */
template <int D>
using RidgeVertices = std::array<std::uint32_t, static_cast<std::size_t>(D - 1)>;

/** A cell around a ridge: the ridge, r and s, positively oriented. */
template <int D>
struct Sector
{
  std::uint32_t Owner; ///< the cell; None: this sector stands for what lies beyond the box
  typename Complex<D>::Vertices Whole; ///< its vertices as they are stored
  std::uint32_t R;
  std::uint32_t S; ///< R of the next sector
  LabelId Label;
};

/** The sectors around a ridge, in cyclic order. */
template <int D>
struct Ring
{
  RidgeVertices<D> Ridge;
  std::vector<Sector<D>> Sectors;

  std::size_t Next(std::size_t k) const { return k + 1 < this->Sectors.size() ? k + 1 : 0; }
  std::size_t Previous(std::size_t k) const { return (k > 0 ? k : this->Sectors.size()) - 1; }
};

/** The sectors whose part at the ridge gets a label. */
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
template <int D>
class RidgeOpener
{
public:
  RidgeOpener(Complex<D>& complex, const Domain<D>& domain, const OpeningContext<D>& context)
    : Mesh(complex)
    , Target(complex, {}, 0)
    , Image(domain)
    , Context(context)
  {
  }

  /** @return false if it cannot */
  bool Open(const InterfaceRidge<D>& ridge)
  {
    const std::optional<Ring<D>> ring = this->RingOf(ridge.Vertices);
    if (!ring)
    {
      return false;
    }
    const std::optional<Filling> best = this->BestFilling(*ring);
    if (!best)
    {
      return false;
    }
    const std::vector<std::uint32_t> onFacets = this->AddPointsOnFacets(*ring, *best);
    std::vector<std::uint32_t> old;
    std::vector<NewCell<D>> pieces;
    for (std::size_t k = 0; k < ring->Sectors.size(); ++k)
    {
      const std::vector<NewCell<D>> some = this->PiecesOf(*ring, *best, k, onFacets);
      if (!some.empty())
      {
        old.push_back(ring->Sectors[k].Owner);
        pieces.insert(pieces.end(), some.begin(), some.end());
      }
    }
    const std::size_t points = this->Mesh.Points.size();
    this->Mesh.AddVertices(this->Points.size());
    std::copy(this->Points.begin(), this->Points.end(),
      this->Mesh.Points.begin() + static_cast<std::ptrdiff_t>(points));
    this->Points.clear();
    this->Target.NeedSlots(pieces.size());
    return this->Target.Replace(old, pieces);
  }

private:
  static constexpr unsigned InRidge = D - 1; ///< vertices; r and s follow them
  static constexpr unsigned N = D + 1;
  using Corners = typename Complex<D>::Vertices;

  const Point<D>& Position(std::uint32_t v) const
  {
    const std::size_t end = this->Mesh.Points.size();
    return v < end ? this->Mesh.Points[v] : this->Points[v - end];
  }

  std::uint32_t AddPoint(const Point<D>& p)
  {
    this->Points.push_back(p);
    return static_cast<std::uint32_t>(this->Mesh.Points.size() + this->Points.size() - 1);
  }

  /** The vertices of a cell that are not in a ridge of it: r and s of its sector. */
  static std::array<std::uint32_t, 2> OthersOf(const RidgeVertices<D>& ridge, const Corners& v)
  {
    std::array<unsigned, N> places{}; // in v: of the ridge's vertices, then of the others
    unsigned found = 0;
    for (unsigned i = 0; i < N; ++i)
    {
      const auto k =
        static_cast<unsigned>(std::find(ridge.begin(), ridge.end(), v[i]) - ridge.begin());
      places[k < InRidge ? k : InRidge + found++] = i;
    }
    unsigned inversions = 0;
    for (unsigned i = 0; i < N; ++i)
    {
      for (unsigned j = 0; j < i; ++j)
      {
        inversions += places[j] > places[i] ? 1 : 0;
      }
    }
    const std::array others{ v[places[InRidge]], v[places[InRidge + 1]] };
    return inversions % 2 == 1 ? std::array{ others[1], others[0] } : others;
  }

  /**
   * The sectors around a ridge: a circle from the smallest r on. If the triangulation ends at the ridge, the last
   * sector, of background, stands for what lies beyond. Nothing if no cell has the ridge.
   */
  std::optional<Ring<D>> RingOf(const RidgeVertices<D>& ridge) const
  {
    VertexStar<D> star;
    this->Mesh.GatherStar(ridge[0], star, [](std::uint32_t) { return true; });
    const auto first = std::find_if(star.Cells.begin(), star.Cells.end(),
      [&](std::uint32_t t)
      {
        const Corners& v = this->Mesh.Cells[t].V;
        return std::all_of(ridge.begin(), ridge.end(),
          [&v](std::uint32_t x) { return std::find(v.begin(), v.end(), x) != v.end(); });
      });
    if (first == star.Cells.end())
    {
      return std::nullopt;
    }
    const auto [r, s] = OthersOf(ridge, this->Mesh.Cells[*first].V);
    RidgeRing around;
    GatherRing(
      *first, r, s, [this](std::uint32_t t) -> const auto& { return this->Mesh.Cells[t]; },
      [](std::uint32_t) { return true; }, around);
    Ring<D> ring{ ridge, {} };
    for (std::size_t k = 0; k < around.Cells.size(); ++k)
    {
      const std::uint32_t t = around.Cells[k];
      ring.Sectors.push_back({ t, this->Mesh.Cells[t].V, around.Link[k],
        around.Link[(k + 1) % around.Link.size()], this->Mesh.Labels[t] });
    }
    if (around.Closed)
    {
      std::rotate(ring.Sectors.begin(),
        std::min_element(ring.Sectors.begin(), ring.Sectors.end(),
          [](const Sector<D>& a, const Sector<D>& b) { return a.R < b.R; }),
        ring.Sectors.end());
    }
    else
    {
      ring.Sectors.push_back({ None, {}, around.Link.back(), around.Link.front(), LabelId{ 0 } });
    }
    return ring;
  }

  /** The first sector of each run of a label. */
  static std::vector<std::size_t> RunsOf(const Ring<D>& ring)
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
    bool MakesContact = true;
    bool DentsBorder = true;
    double Score = SmallestScore<D>;

    bool IsBetterThan(const Candidate& other) const
    {
      return this->Score > SmallestScore<D> &&
        (this->MakesContact != other.MakesContact    ? other.MakesContact
            : this->DentsBorder != other.DentsBorder ? other.DentsBorder
                                                     : this->Score > other.Score);
    }
  };

  /** Nothing if every filling makes a flat tetrahedron or facet. */
  std::optional<Filling> BestFilling(const Ring<D>& ring)
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
    return best.Score > SmallestScore<D> ? std::optional<Filling>(std::move(best.How))
                                         : std::nullopt;
  }

  /** Fills runs from `first` on, as few as possible, and keeps the best candidate. */
  void TryFrom(const Ring<D>& ring, std::span<const std::size_t> runs, std::size_t first,
    LabelId label, Candidate& best)
  {
    bool found = false;
    for (std::size_t number = 1; number <= runs.size() && !found; ++number)
    {
      Candidate next;
      next.How = this->Fill(ring, runs, label, first, number);
      if (!IsManifold(ring, next.How))
      {
        continue;
      }
      next.MakesContact = this->Context.Contacts &&
        (this->MakesContact(ring, next.How) || this->Joins(ring, next.How));
      next.DentsBorder = this->DentsBorder(ring, next.How);
      for (const double width : Widths)
      {
        next.How.Width = width;
        next.Score = this->ScoreOf(ring, next.How);
        found = found || next.Score > SmallestScore<D>;
        if (next.IsBetterThan(best))
        {
          best = next;
        }
      }
    }
  }

  /** Fills `number` consecutive runs from `first` on. Sectors that already have the label stay. */
  Filling Fill(const Ring<D>& ring, std::span<const std::size_t> runs, LabelId label,
    std::size_t first, std::size_t number) const
  {
    Filling filling{ label, std::vector<std::uint8_t>(ring.Sectors.size(), 0), 0.0 };
    std::size_t k = runs[first];
    const std::size_t end = runs[(first + number) % runs.size()];
    do
    {
      const Sector<D>& sector = ring.Sectors[k];
      const bool isCut =
        sector.Owner != None && sector.Label != label && !this->KeepsItsLabel(sector);
      filling.Gives[k] = isCut ? 1 : 0;
      k = ring.Next(k);
    } while (k != end);
    return filling;
  }

  /** Whether a sector has a facet on a time plane, or on an end of a periodic mesh. */
  bool KeepsItsLabel(const Sector<D>& sector) const
  {
    if constexpr (D == 4)
    {
      const TimePlanes& planes = this->Context.Planes;
      return planes.Exist() &&
        FacetOnPlane(
          sector.Whole, [this](std::uint32_t v) { return this->Position(v)[3]; },
          [&planes](double time) { return planes.HaveFacetsAt(time); })
          .has_value();
    }
    return false;
  }

  static bool IsManifold(const Ring<D>& ring, const Filling& filling)
  {
    std::vector<LabelId> labels;
    for (std::size_t k = 0; k < ring.Sectors.size(); ++k)
    {
      labels.push_back(filling.Gives[k] != 0 ? filling.Label : ring.Sectors[k].Label);
    }
    return HasOneRunOfEach(labels);
  }

  /** Whether the filling gets beside a label that its own does not touch there in the image. */
  bool MakesContact(const Ring<D>& ring, const Filling& filling) const
  {
    for (std::size_t k = 0; k < ring.Sectors.size(); ++k)
    {
      if (filling.Gives[k] == 0)
      {
        continue;
      }
      const Sector<D>& sector = ring.Sectors[k];
      std::array<const Point<D>*, D> corners;
      for (unsigned i = 0; i < InRidge; ++i)
      {
        corners[i] = &this->Position(ring.Ridge[i]);
      }
      const auto touches = [&](std::uint32_t beside, LabelId label)
      {
        corners[InRidge] = &this->Position(beside);
        return label == filling.Label ||
          this->Context.Contacts->TouchNear(corners, filling.Label, label);
      };
      const std::size_t next = ring.Next(k);
      const std::size_t before = ring.Previous(k);
      if (!touches(sector.R, sector.Label) ||
        (filling.Gives[before] == 0 && !touches(sector.R, ring.Sectors[before].Label)) ||
        (filling.Gives[next] == 0 && !touches(sector.S, ring.Sectors[next].Label)))
      {
        return true;
      }
    }
    return false;
  }

  /** Whether the filling joins sectors of its label that the image does not connect. */
  bool Joins(const Ring<D>& ring, const Filling& filling) const
  {
    const auto centroidOf = [&](const Sector<D>& sector)
    {
      std::array<const Point<D>*, N> points;
      for (unsigned i = 0; i < N; ++i)
      {
        points[i] = &this->Position(sector.Whole[i]);
      }
      return Centroid(points);
    };
    const Sector<D>* last = nullptr; // that has the label; null: another one follows it
    for (std::size_t k = 0; k < 2 * ring.Sectors.size(); ++k) // beyond the first one again
    {
      const std::size_t at = k % ring.Sectors.size();
      const Sector<D>& sector = ring.Sectors[at];
      const bool isOf = sector.Label == filling.Label && sector.Owner != None;
      if (isOf && last && filling.Gives[ring.Previous(at)] != 0 &&
        !this->Context.Contacts->AreConnected(centroidOf(*last), centroidOf(sector), filling.Label))
      {
        return true;
      }
      last = isOf ? &sector : filling.Gives[at] != 0 ? last : nullptr;
    }
    return false;
  }

  /**
   * Whether there is a new vertex on the facet before a sector. There is none if the label
   * continues beyond the facet.
   */
  static bool HasPointBefore(const Ring<D>& ring, const Filling& filling, std::size_t k)
  {
    const auto isOf = [&](std::size_t sector)
    { return filling.Gives[sector] == 0 && ring.Sectors[sector].Label == filling.Label; };
    const std::size_t before = ring.Previous(k);
    return (filling.Gives[k] != 0 || filling.Gives[before] != 0) && !isOf(k) && !isOf(before);
  }

  /** The new vertex on the facet before each sector; None if there is none. */
  std::vector<std::uint32_t> AddPointsOnFacets(const Ring<D>& ring, const Filling& filling)
  {
    std::vector<std::uint32_t> points(ring.Sectors.size(), None);
    for (std::size_t k = 0; k < points.size(); ++k)
    {
      if (HasPointBefore(ring, filling, k))
      {
        points[k] =
          this->AddPointBeside(ring.Ridge, this->Position(ring.Sectors[k].R), filling.Width);
      }
    }
    return points;
  }

  std::uint32_t AddPointBeside(const RidgeVertices<D>& ridge, const Point<D>& to, double width)
  {
    const Point<D> middle = this->MiddleOf(ridge);
    double length = 0.0; // of the longest edge
    for (std::size_t i = 0; i < ridge.size(); ++i)
    {
      for (std::size_t j = 0; j < i; ++j)
      {
        length = std::max(length, Distance(this->Position(ridge[j]), this->Position(ridge[i])));
      }
    }
    const double part = width * std::min(1.0, length / Distance(middle, to));
    return this->AddPoint(Interpolate(middle, to, part));
  }

  /** The centroid. If all vertices have the same coordinate, it has this coordinate exactly. */
  Point<D> MiddleOf(std::span<const std::uint32_t> face) const
  {
    Point<D> middle = this->Position(face[0]);
    Point<D> sum{};
    for (const std::uint32_t v : face)
    {
      for (std::size_t a = 0; a < middle.size(); ++a)
      {
        sum[a] += this->Position(v)[a] - middle[a];
      }
    }
    for (std::size_t a = 0; a < middle.size(); ++a)
    {
      middle[a] += sum[a] / static_cast<double>(face.size());
    }
    return middle;
  }

  Point<D> MiddleOfOthers(const Sector<D>& sector) const
  {
    return this->MiddleOf(std::array{ sector.R, sector.S });
  }

  /** The ridge, then others. */
  static Corners CornersOf(const RidgeVertices<D>& ridge, std::uint32_t r, std::uint32_t s)
  {
    Corners corners{};
    std::copy(ridge.begin(), ridge.end(), corners.begin());
    corners[InRidge] = r;
    corners[InRidge + 1] = s;
    return corners;
  }

  /** The pieces of a sector; empty if it stays whole. May add a point. */
  std::vector<NewCell<D>> PiecesOf(const Ring<D>& ring, const Filling& filling, std::size_t k,
    std::span<const std::uint32_t> onFacets)
  {
    const Sector<D>& sector = ring.Sectors[k];
    if (sector.Owner == None)
    {
      return {};
    }
    const Corners whole = CornersOf(ring.Ridge, sector.R, sector.S);
    const std::uint32_t p = onFacets[k];
    const std::uint32_t q = onFacets[ring.Next(k)];
    const LabelId own = sector.Label;
    const LabelId atRidge = filling.Gives[k] != 0 ? filling.Label : own;
    if (p == None && q == None)
    {
      return filling.Gives[k] != 0 ? this->SplitWithin(ring.Ridge, sector, atRidge, filling.Width)
                                   : std::vector<NewCell<D>>();
    }
    std::vector<NewCell<D>> pieces;
    if (p != None && q != None)
    {
      std::vector<NewCell<D>> other;
      CutOff(CutOff(whole, InRidge, p, own, pieces), InRidge + 1, q, own, pieces);
      CutOff(CutOff(whole, InRidge + 1, q, own, other), InRidge, p, own, other);
      if (this->Shapes().ShapesOf(other) > this->Shapes().ShapesOf(pieces))
      {
        pieces.swap(other);
      }
      pieces.push_back({ CornersOf(ring.Ridge, p, q), atRidge });
    }
    else
    {
      const Corners rest = p != None ? CutOff(whole, InRidge, p, own, pieces)
                                     : CutOff(whole, InRidge + 1, q, own, pieces);
      pieces.push_back({ rest, atRidge });
    }
    return pieces;
  }

  /**
   * Cuts pieces off a sector, one for each vertex of the ridge, which it lacks.
   * @param i InRidge or InRidge + 1: the number of the vertex r or s
   * @param point on the facet of the ridge and this vertex
   * @return the rest, which has the whole ridge
   */
  static Corners CutOff(const Corners& v, unsigned i, std::uint32_t point, LabelId label,
    std::vector<NewCell<D>>& pieces)
  {
    for (unsigned k = 0; k < InRidge; ++k)
    {
      pieces.push_back({ v, label });
      pieces.back().V[k] = point;
    }
    Corners rest = v;
    rest[i] = point;
    return rest;
  }

  /**
   * Splits a sector by a point inside it. Used if the label at the ridge continues beyond both
   * facets.
   */
  std::vector<NewCell<D>> SplitWithin(
    const RidgeVertices<D>& ridge, const Sector<D>& sector, LabelId atRidge, double width)
  {
    const std::uint32_t point = this->AddPointBeside(ridge, this->MiddleOfOthers(sector), width);
    std::vector<NewCell<D>> pieces;
    for (unsigned i = 0; i < N; ++i)
    {
      pieces.push_back(
        { CornersOf(ridge, sector.R, sector.S), i < InRidge ? sector.Label : atRidge });
      pieces.back().V[i] = point;
    }
    return pieces;
  }

  auto Shapes() const
  {
    const auto positionOf = [this](std::uint32_t v) -> const Point<D>&
    { return this->Position(v); };
    return PieceShapes<D, decltype(positionOf)>(positionOf, this->Context.Sizing);
  }

  /** The score of all pieces of a ring. Removes the points it adds. */
  double ScoreOf(const Ring<D>& ring, const Filling& filling)
  {
    const std::size_t points = this->Points.size();
    const std::vector<std::uint32_t> onFacets = this->AddPointsOnFacets(ring, filling);
    std::vector<NewCell<D>> all;
    for (std::size_t k = 0; k < ring.Sectors.size(); ++k)
    {
      const std::vector<NewCell<D>> pieces = this->PiecesOf(ring, filling, k, onFacets);
      all.insert(all.end(), pieces.begin(), pieces.end());
    }
    double score = this->Shapes().ShapesOf(all);
    if constexpr (D == 3)
    {
      score = std::min(score, this->Shapes().FacetsOf(all));
    }
    this->Points.resize(points);
    return score;
  }

  /**
   * Whether a filling makes a dent in a cut face, on the hull of the
   * triangulation for example, or adds a piece beyond the image's border.
   */
  bool DentsBorder(const Ring<D>& ring, const Filling& filling) const
  {
    const ImageBorder<D>* const border = this->Image.Border();
    for (std::size_t k = 0; k < ring.Sectors.size(); ++k)
    {
      const Sector<D>& sector = ring.Sectors[k];
      if (filling.Gives[k] == 0)
      {
        continue;
      }
      const bool isAtHull =
        ring.Sectors[ring.Previous(k)].Owner == None || ring.Sectors[ring.Next(k)].Owner == None;
      if (filling.Label == 0 &&
        (isAtHull || (border && this->HasFacetOnBorder(*border, ring, sector))))
      {
        return true;
      }
      if (border && sector.Label == 0 &&
        border->IsBeyond(
          Interpolate(this->MiddleOf(ring.Ridge), this->MiddleOfOthers(sector), 0.5)))
      {
        return true;
      }
    }
    return false;
  }

  /** Whether a facet at the ridge is on a cut face. */
  bool HasFacetOnBorder(
    const ImageBorder<D>& border, const Ring<D>& ring, const Sector<D>& sector) const
  {
    const auto faces = [&](std::uint32_t v) { return border.FacesAt(this->Position(v)); };
    unsigned common = faces(sector.R) | faces(sector.S);
    for (const std::uint32_t v : ring.Ridge)
    {
      common &= faces(v);
    }
    return common != 0;
  }

  Complex<D>& Mesh;
  Patch<D> Target; ///< all of the mesh
  const Domain<D>& Image;
  const OpeningContext<D> Context;
  std::vector<Point<D>> Points; ///< new ones, which the mesh does not have yet
};

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
std::vector<InterfaceRidge<D>> OpenRidges(Complex<D>& complex, const Domain<D>& domain,
  const std::vector<InterfaceRidge<D>>& ridges, const OpeningContext<D>& context,
  const std::stop_token& stop)
{
  std::vector<InterfaceRidge<D>> left;
  RidgeOpener<D> opener(complex, domain, context);
  for (const InterfaceRidge<D>& ridge : ridges)
  {
    ThrowIfStopped(stop);
    if (!opener.Open(ridge))
    {
      left.push_back(ridge);
    }
  }
  return left;
}

template std::vector<InterfaceRidge<3>> OpenRidges<3>(Complex<3>&, const Domain<3>&,
  const std::vector<InterfaceRidge<3>>&, const OpeningContext<3>&, const std::stop_token&);
template std::vector<InterfaceRidge<4>> OpenRidges<4>(Complex<4>&, const Domain<4>&,
  const std::vector<InterfaceRidge<4>>&, const OpeningContext<4>&, const std::stop_token&);

} // namespace voxplex
