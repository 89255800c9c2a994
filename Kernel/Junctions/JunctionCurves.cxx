// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Junctions/JunctionCurves.h"

#include "Base/UninitialisedVector.h"
#include "Junctions/JunctionGraph.h"
#include "Junctions/JunctionLattice.h"
#include "Parallel/ParallelCollect.h"
#include "Parallel/ParallelFor.h"
#include "Parallel/ParallelSort.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <mutex>
#include <set>
#include <span>
#include <utility>

namespace voxplex
{

namespace
{

using namespace junctions;

/** Points of the fine lattice in a cell along each axis. */
constexpr unsigned FineSide = Fine + 1;

/**
 * The six orders of axes in which a tetrahedron of Freudenthal's subdivision goes from corner to
 * corner.
 */
constexpr std::array<std::array<unsigned, 3>, 6> Orders{ { { 0, 1, 2 }, { 0, 2, 1 }, { 1, 0, 2 },
  { 1, 2, 0 }, { 2, 0, 1 }, { 2, 1, 0 } } };

/** A tetrahedron of the subdivision with the labels of its corners. */
struct FineTetrahedron
{
  std::array<std::array<std::int64_t, 3>, 4> Corners;
  std::array<std::uint8_t, 4> Steps; ///< from the first corner
  std::array<LabelId, 4> Labels;

  /** The facet opposite to corner i. */
  LatticeSimplex Facet(unsigned i) const
  {
    const unsigned first = i == 0 ? 1 : 0;
    const unsigned second = i <= 1 ? 2 : 1;
    const unsigned third = i <= 2 ? 3 : 2;
    const auto step = [&](unsigned k)
    { return static_cast<std::uint8_t>(this->Steps[k] & ~this->Steps[first]); };
    return { this->Corners[first], step(second), step(third), false };
  }
  /** The labels of the facet opposite to corner `facet`. */
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

/** Whether there are at least three different labels. */
template <std::size_t N>
bool AreThree(const std::array<LabelId, N>& labels)
{
  const LabelId first = labels[0];
  LabelId second = first;
  for (std::size_t c = 1; c < N; ++c)
  {
    if (labels[c] != first && labels[c] != second)
    {
      if (second != first)
      {
        return true;
      }
      second = labels[c];
    }
  }
  return false;
}

unsigned CountDistinct(LabelId* begin, LabelId* end)
{
  std::sort(begin, end);
  return static_cast<unsigned>(std::unique(begin, end) - begin);
}

//------------------------------------------------------------------------------------------------
/** Finds the segments of curves in cells of the lattice. */
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

  /** Traces the cells between layers k and k + 1 that have voxels of three labels. */
  void TraceLayer(std::int64_t k, std::vector<Segment>& segments) const
  {
    const Index& n = this->Space.LatticeDimensions();
    const std::size_t words = this->Sites.WordsPerRow();
    FineLabels labels;
    labels.Faces.resize(static_cast<std::size_t>(n[0]));
    for (std::int64_t j = 0; j + 1 < n[1]; ++j)
    {
      std::array<std::span<const std::uint64_t>, 4> rows;
      std::array<const LabelId*, 4> ids;
      bool inside = true;
      for (unsigned r = 0; r < 4; ++r)
      {
        rows[r] = this->Sites.Row(this->Sites.RowOf({ 0, j + (r & 1), k + (r >> 1) }));
        ids[r] = this->Space.RowOf(j + (r & 1), k + (r >> 1));
        inside = inside && ids[r];
      }
      const auto hasThree = [&](std::int64_t i)
      {
        if (!inside || i < 1 || i + 2 >= n[0])
        {
          return this->HasThreeLabels({ i, j, k });
        }
        const auto id = [&](unsigned r, std::int64_t x) { return ids[r][x - 1]; };
        return AreThree<8>({ id(0, i), id(0, i + 1), id(1, i), id(1, i + 1), id(2, i), id(2, i + 1),
          id(3, i), id(3, i + 1) });
      };
      const auto any = [&](std::size_t w)
      { return w < words ? rows[0][w] | rows[1][w] | rows[2][w] | rows[3][w] : 0; };
      for (std::size_t w = 0; w < words; ++w)
      {
        const std::uint64_t here = any(w);
        std::uint64_t cells = here | (here >> 1) | (any(w + 1) << 63);
        for (; cells != 0; cells &= cells - 1)
        {
          const auto i = static_cast<std::int64_t>(64 * w) + std::countr_zero(cells);
          if (i + 1 < n[0] && hasThree(i))
          {
            this->TraceCell({ i, j, k }, labels, segments);
          }
        }
      }
    }
  }

  /** Traces further cells where curves leave the cells between voxels of three labels. */
  void FollowOpenEnds(
    std::vector<Segment>& segments, unsigned threads, const std::stop_token& stop) const
  {
    using Number = Numbering::Number;
    constexpr std::size_t Grain = std::size_t{ 1 } << 14;
    const std::size_t ends = 2 * segments.size();
    UninitialisedVector<Number> memory(2 * ends);
    ParallelFor(
      0, ends, Grain, threads,
      [&](std::size_t first, std::size_t last)
      {
        for (std::size_t e = first; e < last; ++e)
        {
          memory[e] = segments[e / 2].Ends[e % 2];
        }
      },
      stop);
    const std::span<Number> all(memory);
    const std::span<const Number> places = ParallelRadixSort(
      all.first(ends), all.last(ends), this->Numbers.Bits(), [](Number number) { return number; },
      threads, stop);
    std::set<Number> open; // triangles with a segment on one side only
    std::mutex mutex;      // guards it
    ParallelFor(
      0, ends, Grain, threads,
      [&](std::size_t first, std::size_t last)
      {
        for (std::size_t i = first; i < last; ++i)
        {
          const bool again =
            (i > 0 && places[i] == places[i - 1]) || (i + 1 < ends && places[i] == places[i + 1]);
          if (!again && !Numbering::IsCorner(places[i]))
          {
            const std::scoped_lock lock(mutex); // there are few
            open.insert(places[i]);
          }
        }
      },
      stop);
    std::set<Index> followed;
    std::vector<Number> todo(open.begin(), open.end());
    while (!todo.empty())
    {
      const Number place = todo.back();
      todo.pop_back();
      Index cell;
      if (!open.contains(place) ||
        !this->FindUntracedCell(this->Numbers.Decode(place), followed, cell))
      {
        continue;
      }
      followed.insert(cell);
      const std::size_t before = segments.size();
      FineLabels labels;
      this->TraceCell(cell, labels, segments);
      for (std::size_t i = before; i < segments.size(); ++i)
      {
        for (const Number end : segments[i].Ends)
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
    std::array<LabelId, 8> labels;
    for (unsigned c = 0; c < 8; ++c)
    {
      labels[c] =
        this->Space.VoxelId({ cell[0] + (c & 1), cell[1] + ((c >> 1) & 1), cell[2] + (c >> 2) });
    }
    return AreThree(labels);
  }

  /**
   * Finds the cell at a triangle that was not traced yet, among the two cells that share the
   * triangle.
   */
  bool FindUntracedCell(
    const LatticeSimplex& place, const std::set<Index>& followed, Index& cell) const
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
    /**
     * For each first coordinate of cells: the row behind the cell traced last, and the labels of
     * the face between the cell and this row.
     */
    struct Face
    {
      std::int64_t Row = -1;
      std::array<LabelId, FineSide * FineSide> Labels;
    };
    std::vector<Face> Faces;
    std::vector<Segment> OfCube; ///< scratch memory

    LabelId& At(std::int64_t x, std::int64_t y, std::int64_t z)
    {
      return this->Labels[static_cast<std::size_t>((z * FineSide + y) * FineSide + x)];
    }
  };

  /**
   * The label at a point of the fine lattice between voxels. If these voxels have one label, it is
   * that label, because indicators are linear.
   */
  LabelId LabelBetween(const Index& cell, const Index& fine, FineLabels& labels) const
  {
    const auto odd = [&](unsigned a) { return fine[a] & 1; };
    const LabelId first = labels.At(fine[0] - odd(0), fine[1] - odd(1), fine[2] - odd(2));
    for (std::int64_t z = -odd(2); z <= odd(2); z += 2)
    {
      for (std::int64_t y = -odd(1); y <= odd(1); y += 2)
      {
        for (std::int64_t x = -odd(0); x <= odd(0); x += 2)
        {
          if (labels.At(fine[0] + x, fine[1] + y, fine[2] + z) != first)
          {
            return this->Space.LabelAtFine(
              { Fine * cell[0] + fine[0], Fine * cell[1] + fine[1], Fine * cell[2] + fine[2] });
          }
        }
      }
    }
    return first;
  }

  /**
   * @param labels of cells of the layer that were traced before, if any; receives the labels of
   *   this cell
   */
  void TraceCell(const Index& cell, FineLabels& labels, std::vector<Segment>& segments) const
  {
    const bool isNext = labels.Cell == Index{ cell[0] - 1, cell[1], cell[2] };
    const auto label = [&](std::int64_t x, std::int64_t y, std::int64_t z) -> LabelId&
    { return labels.At(x, y, z); };
    labels.Cell = cell;
    typename FineLabels::Face* const face =
      labels.Faces.empty() ? nullptr : &labels.Faces[static_cast<std::size_t>(cell[0])];
    const auto* const before = face && face->Row == cell[1] ? face : nullptr;
    for (std::int64_t z = 0; z <= Fine; ++z)
    {
      for (std::int64_t y = 0; y <= Fine; ++y)
      {
        label(0, y, z) = isNext ? label(Fine, y, z) : LabelId(0);
      }
    }
    for (std::int64_t c = 0; c < 8; ++c)
    {
      const Index corner{ c & 1, (c >> 1) & 1, c >> 2 };
      label(Fine * corner[0], Fine * corner[1], Fine * corner[2]) =
        this->Space.VoxelId({ cell[0] + corner[0], cell[1] + corner[1], cell[2] + corner[2] });
    }
    for (std::int64_t z = 0; z <= Fine; ++z)
    {
      for (std::int64_t y = 0; y <= Fine; ++y)
      {
        for (std::int64_t x = isNext ? 1 : 0; x <= Fine; ++x)
        {
          if (((x | y | z) & 1) == 0)
          {
            continue;
          }
          label(x, y, z) = before && y == 0
            ? before->Labels[static_cast<std::size_t>(z * FineSide + x)]
            : this->LabelBetween(cell, { x, y, z }, labels);
        }
      }
    }
    if (face)
    {
      face->Row = cell[1] + 1;
      for (std::int64_t z = 0; z <= Fine; ++z)
      {
        for (std::int64_t x = 0; x <= Fine; ++x)
        {
          face->Labels[static_cast<std::size_t>(z * FineSide + x)] = label(x, Fine, z);
        }
      }
    }
    for (std::int64_t z = 0; z < Fine; ++z)
    {
      for (std::int64_t y = 0; y < Fine; ++y)
      {
        for (std::int64_t x = 0; x < Fine; ++x)
        {
          if (!AreThree<8>({ label(x, y, z), label(x + 1, y, z), label(x, y + 1, z),
                label(x + 1, y + 1, z), label(x, y, z + 1), label(x + 1, y, z + 1),
                label(x, y + 1, z + 1), label(x + 1, y + 1, z + 1) }))
          {
            continue;
          }
          labels.OfCube.clear();
          for (const auto& order : Orders)
          {
            FineTetrahedron t;
            std::array<std::int64_t, 3> at{ x, y, z };
            t.Labels[0] = label(x, y, z);
            for (unsigned i = 0; i < 3; ++i)
            {
              ++at[order[i]];
              t.Labels[i + 1] = label(at[0], at[1], at[2]);
            }
            if (!AreThree(t.Labels))
            {
              continue;
            }
            t.Corners[0] = { Fine * cell[0] + x, Fine * cell[1] + y, Fine * cell[2] + z };
            t.Steps[0] = 0;
            for (unsigned i = 0; i < 3; ++i)
            {
              t.Corners[i + 1] = t.Corners[i];
              ++t.Corners[i + 1][order[i]];
              t.Steps[i + 1] = static_cast<std::uint8_t>(t.Steps[i] | (1u << order[i]));
            }
            this->Trace(t, labels.OfCube);
          }
          JoinInside(labels.OfCube);
          segments.insert(segments.end(), labels.OfCube.begin(), labels.OfCube.end());
        }
      }
    }
  }

  /**
   * Removes places inside of a cube. Places next to corners stay, because the position of the
   * corner depends on them. Two places of a ring about the diagonal stay, too.
   */
  static void JoinInside(std::vector<Segment>& segments)
  {
    for (std::size_t i = 0; i < segments.size(); ++i)
    {
      for (unsigned end = 0; end < 2; ++end)
      {
        std::size_t j = FindNext(segments, i, end);
        while (j < segments.size())
        {
          const unsigned far = segments[j].Ends[0] == segments[i].Ends[end] ? 1 : 0;
          segments[i].Ends[end] = segments[j].Ends[far];
          segments[i].Labels[end] = segments[j].Labels[far];
          segments[j] = segments.back();
          segments.pop_back();
          i = i == segments.size() ? j : i;
          j = FindNext(segments, i, end);
        }
      }
    }
  }

  /** The segment to join to an end of another segment; the number of segments if there is none. */
  static std::size_t FindNext(
    const std::vector<Segment>& segments, std::size_t segment, unsigned end)
  {
    const auto [place, other] =
      std::pair{ segments[segment].Ends[end], segments[segment].Ends[1 - end] };
    if (!Numbering::IsInsideOfCube(place) || Numbering::IsCorner(other))
    {
      return segments.size();
    }
    for (std::size_t j = 0; j < segments.size(); ++j)
    {
      const auto& ends = segments[j].Ends;
      if (j != segment && (ends[0] == place || ends[1] == place))
      {
        const Numbering::Number far = ends[0] == place ? ends[1] : ends[0];
        return Numbering::IsCorner(far) || far == other ? segments.size() : j;
      }
    }
    return segments.size();
  }

  /** @param t has three or four labels */
  void Trace(const FineTetrahedron& t, std::vector<Segment>& segments) const
  {
    std::array<LabelId, 4> labels = t.Labels;
    const unsigned distinct = CountDistinct(labels.data(), labels.data() + 4);
    const Numbering::Number corner =
      this->Numbers.Encode({ t.Corners[0], t.Steps[1], t.Steps[2], true });
    Segment segment;
    unsigned found = 0;
    for (unsigned i = 0; i < 4; ++i)
    {
      const std::array<LabelId, 3> facet = t.FacetLabels(i);
      if (!this->Space.IsJunction(facet))
      {
        continue;
      }
      if (distinct == 4)
      {
        segments.push_back(
          { { corner, this->Numbers.Encode(t.Facet(i)) }, { t.FacetLabels(3), facet } });
      }
      else
      {
        segment.Ends[found] = this->Numbers.Encode(t.Facet(i));
        segment.Labels[found++] = facet;
      }
    }
    if (found == 2)
    {
      segments.push_back(segment);
    }
  }

  const LabelledSpace<Field>& Space;
  const BitMask<3>& Sites;
  const Numbering Numbers;
};

} // namespace

//------------------------------------------------------------------------------------------------
template <typename Field>
JunctionCurves::JunctionCurves(const LabelImage<3>& image, const Field& field,
  const BitMask<3>& sites, unsigned threads, const std::stop_token& stop)
{
  const auto layers = static_cast<std::size_t>(field.LatticeDimensions()[2] - 1);
  const LabelledSpace<Field> space(image, field);
  const Tracer<Field> tracer(space, sites);
  std::vector<Segment> segments = ParallelCollect<Segment>(
    layers, 1, threads,
    [&](std::size_t first, std::size_t last, std::vector<Segment>& found)
    {
      for (std::size_t k = first; k < last; ++k)
      {
        tracer.TraceLayer(static_cast<std::int64_t>(k), found);
      }
    },
    stop);
  tracer.FollowOpenEnds(segments, threads, stop);
  const Graph<Field> graph(segments, space, threads, stop);
  this->Corners = graph.NumberOfCorners();
  this->All = graph.Curves();
}

template JunctionCurves::JunctionCurves(
  const LabelImage<3>&, const LabelField<3>&, const BitMask<3>&, unsigned, const std::stop_token&);
template JunctionCurves::JunctionCurves(
  const LabelImage<3>&, const ScalarField<3>&, const BitMask<3>&, unsigned, const std::stop_token&);

} // namespace voxplex
