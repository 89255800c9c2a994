// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Optimisation/Tetrahedra/Flips.h"

#include <algorithm>
#include <limits>

namespace voxplex
{

namespace
{

/** Scores must grow by this factor, so that flipping terminates. */
constexpr double LeastGain = 1.05;
/** The smallest score of new tetrahedra. They are positively oriented in spite of rounding. */
constexpr double LeastScore = 1e-6;

constexpr double Infinity = std::numeric_limits<double>::infinity();

} // namespace

//------------------------------------------------------------------------------------------------
bool Flips::Improve(std::uint32_t t)
{
  this->Best.Gain = 0.0;
  for (unsigned i = 0; i < 4; ++i)
  {
    for (unsigned j = 0; j < i; ++j)
    {
      this->ConsiderEdge(t, j, i);
    }
  }
  if (this->Best.Gain <= 0.0 || !this->Target.Replace(this->Best.Old, this->Best.Fresh))
  {
    return false;
  }
  ++(this->Best.OnInterface ? this->Done.InterfaceFlips : this->Done.EdgeRemovals);
  this->Done.Dropped += this->Best.Fresh.empty() ? 1 : 0;
  return true;
}

double Flips::ScoreOf(std::span<const std::uint32_t> cells) const
{
  double score = 1.0;
  for (const std::uint32_t t : cells)
  {
    score = std::min(score, static_cast<double>(this->Target.Mesh().Scores[t]));
  }
  return score;
}

/** The smallest score that a plan must reach, if the tetrahedra that it replaces have this score. */
double Flips::LeastScoreFrom(double before) const
{
  // If nothing is poor afterwards, any gain is enough: flipping ends there.
  const double gain = std::min(before * LeastGain, 1.0);
  return std::max({ LeastScore, gain, before + this->Best.Gain });
}

void Flips::Consider(double before)
{
  this->Current.Gain = std::min(1.0, this->Current.Score) - before;
  // If two plans are equally good, prefer the one that does not change interfaces.
  if (this->Current.Gain > this->Best.Gain ||
    (this->Current.Gain > 0.0 && this->Current.Gain == this->Best.Gain && this->Best.OnInterface &&
      !this->Current.OnInterface))
  {
    std::swap(this->Best, this->Current);
  }
}

//------------------------------------------------------------------------------------------------
void Flips::ConsiderEdge(std::uint32_t t, unsigned i, unsigned j)
{
  const TetrahedralComplex& mesh = this->Target.Mesh();
  EdgeRing& ring = this->Ring;
  if (!GatherRing(this->Target, t, i, j, LongestRing, ring))
  {
    return;
  }
  const double before = this->ScoreOf(ring.Cells);
  const double floor = this->LeastScoreFrom(before);

  // Rotate the ring so that a run of one label begins with the first cell.
  const std::size_t cells = ring.Cells.size();
  const auto labelAt = [&](std::size_t k) { return mesh.Labels[ring.Cells[k < cells ? k : 0]]; };
  std::size_t changes = 0;
  std::size_t start = 0;
  for (std::size_t k = 0; k + (ring.Closed ? 0 : 1) < cells; ++k)
  {
    if (labelAt(k) != labelAt(k + 1))
    {
      ++changes;
      start = (k + 1) % cells;
    }
  }
  if (changes > (ring.Closed ? 2u : 0u))
  {
    return; // three or more regions meet here, or the interface is not manifold
  }
  const bool onInterface = !ring.Closed || changes == 2;
  std::size_t firstRun = cells;
  if (changes == 2)
  {
    std::rotate(ring.Cells.begin(), ring.Cells.begin() + static_cast<std::ptrdiff_t>(start),
      ring.Cells.end());
    std::rotate(
      ring.Link.begin(), ring.Link.begin() + static_cast<std::ptrdiff_t>(start), ring.Link.end());
    firstRun = 1;
    while (labelAt(firstRun) == labelAt(0))
    {
      ++firstRun;
    }
  }
  if (onInterface && !this->MayFlipInterface(firstRun))
  {
    return;
  }

  Plan& plan = this->Current;
  plan.Fresh.clear();
  plan.OnInterface = onInterface;
  const std::span<const std::uint32_t> link(ring.Link);
  if (changes == 2)
  {
    std::array<std::uint32_t, LongestRing + 1> second;
    std::size_t size = 0;
    for (std::size_t k = firstRun; k <= cells; ++k)
    {
      second[size++] = ring.Link[k % cells];
    }
    plan.Score = this->Triangulate(link.first(firstRun + 1), labelAt(0), floor);
    if (plan.Score < floor)
    {
      return;
    }
    plan.Score = std::min(plan.Score,
      this->Triangulate(
        std::span<const std::uint32_t>(second).first(size), labelAt(firstRun), floor));
  }
  else
  {
    plan.Score = this->Triangulate(link, labelAt(0), floor);
  }
  if (plan.Score < floor)
  {
    return;
  }
  plan.Old = ring.Cells;
  this->Consider(before);
}

//------------------------------------------------------------------------------------------------
/**
 * Klincsek's recursion. Returns less than `floor` if no triangulation has this score or a better
 * one.
 */
double Flips::Triangulate(
  std::span<const std::uint32_t> chain, TetrahedralComplex::Label label, double floor)
{
  const TetrahedralComplex& mesh = this->Target.Mesh();
  const std::size_t n = chain.size();
  const std::uint32_t a = this->Ring.A;
  const std::uint32_t b = this->Ring.B;
  for (std::size_t i = 0; i + 1 < n; ++i)
  {
    this->Table[i][i + 1] = Infinity;
  }
  for (std::size_t length = 2; length < n; ++length)
  {
    for (std::size_t i = 0; i + length < n; ++i)
    {
      const std::size_t j = i + length;
      double best = -Infinity;
      for (std::size_t k = i + 1; k < j; ++k)
      {
        double score = std::min(this->Table[i][k], this->Table[k][j]);
        if (score < floor || score <= best)
        {
          continue;
        }
        score = std::min(score, mesh.Score({ a, chain[i], chain[k], chain[j] }));
        if (score < floor || score <= best)
        {
          continue;
        }
        score = std::min(score, mesh.Score({ chain[i], chain[k], chain[j], b }));
        if (score >= floor && score > best)
        {
          best = score;
          this->Choice[i][j] = k;
        }
      }
      this->Table[i][j] = best;
    }
  }
  const double score = this->Table[0][n - 1];
  if (score >= floor)
  {
    this->Emit(chain, label, 0, n - 1);
  }
  return score;
}

void Flips::Emit(std::span<const std::uint32_t> chain, TetrahedralComplex::Label label,
  std::size_t i, std::size_t j)
{
  if (j < i + 2)
  {
    return;
  }
  const std::size_t k = this->Choice[i][j];
  this->Current.Fresh.push_back({ { this->Ring.A, chain[i], chain[k], chain[j] }, label });
  this->Current.Fresh.push_back({ { chain[i], chain[k], chain[j], this->Ring.B }, label });
  this->Emit(chain, label, i, k);
  this->Emit(chain, label, k, j);
}

//------------------------------------------------------------------------------------------------
/**
 * Whether the interface edge of Ring, between c = Link[0] and d = Link[firstRun], may be flipped to
 * cd.
 */
bool Flips::MayFlipInterface(std::size_t firstRun)
{
  const TetrahedralComplex& mesh = this->Target.Mesh();
  const EdgeRing& ring = this->Ring;
  const std::size_t cells = ring.Cells.size();
  const std::uint32_t c = ring.Link[0];
  const std::uint32_t d = ring.Link[firstRun];
  const Point<3>& a = mesh.Points[ring.A];
  const Point<3>& b = mesh.Points[ring.B];
  const Point<3>& pc = mesh.Points[c];
  const Point<3>& pd = mesh.Points[d];
  const unsigned both = mesh.BorderFacesOf(ring.A) & mesh.BorderFacesOf(ring.B);
  if ((both & mesh.BorderFacesOf(c)) != (both & mesh.BorderFacesOf(d)))
  {
    return false; // an edge of a cut face
  }

  const Point<3> abc = Cross(Subtract(b, a), Subtract(pc, a));
  const Point<3> bad = Cross(Subtract(pd, a), Subtract(b, a));
  const Point<3> adc = Cross(Subtract(pd, a), Subtract(pc, a));
  const Point<3> bcd = Cross(Subtract(pc, b), Subtract(pd, b));
  const double crease = this->Rules.CreaseCosine;
  if (!(CosineBetween(abc, bad) >= crease && CosineBetween(adc, bcd) >= crease &&
        CosineBetween(abc, adc) >= crease && CosineBetween(abc, bcd) >= crease))
  {
    return false;
  }

  FacetBounds bounds(this->Rules);
  bounds.Replace(CosineOfSmallestAngle(a, b, pc), this->IsAtJunction(ring.A, ring.B, c));
  bounds.Replace(CosineOfSmallestAngle(a, b, pd), this->IsAtJunction(ring.A, ring.B, d));
  if (!bounds.Allow(CosineOfSmallestAngle(a, pc, pd), this->IsAtJunction(ring.A, c, d)) ||
    !bounds.Allow(CosineOfSmallestAngle(b, pc, pd), this->IsAtJunction(ring.B, c, d)))
  {
    return false;
  }

  if (!ring.Closed && firstRun > 1 &&
    (SignedVolume<3>(std::array{ &a, &b, &pc, &pd }.data()) < 0.0 || this->MayBeEdge(c, d)))
  {
    return false; // would fill background, or use triangles of another part that touches this one
  }
  // cd must not be on an interface already. cd can be an edge already only if a label has one cell
  // here. If the label has more cells, acd or bcd can be a facet already only if a or b has three
  // interface triangles. Then a new tetrahedron would be an existing one with inverted orientation,
  // and its score would be negative.
  return (firstRun > 1 || !this->IsInterfaceEdge(ring.Cells[0], c, d)) &&
    (!ring.Closed || firstRun + 1 < cells || !this->IsInterfaceEdge(ring.Cells[firstRun], c, d));
}

/** Whether two vertices are joined by an edge. True if this cannot be determined. */
bool Flips::MayBeEdge(std::uint32_t a, std::uint32_t b)
{
  return !this->Target.GatherStar(a, this->Star) ||
    std::any_of(this->Star.Corners.begin(), this->Star.Corners.end(),
      [b](const TetrahedralComplex::Vertices& v)
      { return std::find(v.begin(), v.end(), b) != v.end(); });
}

/** Whether an edge of t is on an interface. True if this cannot be determined. */
bool Flips::IsInterfaceEdge(std::uint32_t t, std::uint32_t a, std::uint32_t b)
{
  const TetrahedralComplex& mesh = this->Target.Mesh();
  if (!GatherRing(this->Target, t, mesh.IndexOf(t, a), mesh.IndexOf(t, b), 4 * LongestRing,
        this->OtherRing) ||
    !this->OtherRing.Closed)
  {
    return true;
  }
  return std::any_of(this->OtherRing.Cells.begin(), this->OtherRing.Cells.end(),
    [&](std::uint32_t cell) { return mesh.Labels[cell] != mesh.Labels[t]; });
}

bool Flips::IsAtJunction(std::uint32_t u, std::uint32_t v, std::uint32_t w) const
{
  const auto& kinds = this->Target.Mesh().Kinds;
  return kinds[u] == VertexRole::Fixed || kinds[v] == VertexRole::Fixed ||
    kinds[w] == VertexRole::Fixed;
}

} // namespace voxplex
