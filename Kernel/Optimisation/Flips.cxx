// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Optimisation/Flips.h"

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
  this->ConsiderAll(t);
  return this->Apply();
}

void Flips::ConsiderAll(std::uint32_t t)
{
  this->Best.Gain = 0.0;
  for (unsigned i = 0; i < 4; ++i)
  {
    for (unsigned j = 0; j < i; ++j)
    {
      this->ConsiderEdge(t, j, i);
    }
    this->ConsiderFacet(t, i);
  }
}

bool Flips::Apply()
{
  if (this->Best.Gain <= 0.0 || !this->Target.Replace(this->Best.Old, this->Best.Fresh))
  {
    return false;
  }
  ++(this->Best.OnInterface        ? this->Done.InterfaceFlips
      : this->Best.Old.size() == 2 ? this->Done.FacetFlips
                                   : this->Done.EdgeRemovals);
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
void Flips::ConsiderFacet(std::uint32_t t, unsigned i)
{
  const TetrahedralComplex& mesh = this->Target.Mesh();
  const std::uint32_t other = mesh.Cells[t].N[i];
  if (other == TetrahedralComplex::None || mesh.Labels[other] != mesh.Labels[t] ||
    !this->Target.MayChange(t) || !this->Target.MayChange(other))
  {
    return;
  }
  const auto v = StartingAt(mesh.Cells[t].V, i);
  const auto& w = mesh.Cells[other].V;
  const std::uint32_t p = v[0];
  std::uint32_t q = w[0];
  for (unsigned k = 1; q == v[1] || q == v[2] || q == v[3]; ++k)
  {
    q = w[k];
  }
  const std::array<std::uint32_t, 2> old = { t, other };
  const double before = this->ScoreOf(old);
  const double floor = this->LeastScoreFrom(before);
  Plan& plan = this->Current;
  plan.Fresh.clear();
  plan.Score = 1.0;
  for (unsigned k = 0; k < 3; ++k)
  {
    // (v1, v2, v3) are clockwise when seen from p.
    const TetrahedralComplex::Vertices fresh = { v[1 + (k + 1) % 3], v[1 + k], q, p };
    plan.Score = std::min(plan.Score, mesh.Score(fresh));
    if (plan.Score < floor)
    {
      return;
    }
    plan.Fresh.push_back({ fresh, mesh.Labels[t] });
  }
  plan.Old.assign(old.begin(), old.end());
  plan.OnInterface = false;
  this->Consider(before);
}

//------------------------------------------------------------------------------------------------
void Flips::ConsiderEdge(std::uint32_t t, unsigned i, unsigned j)
{
  const TetrahedralComplex& mesh = this->Target.Mesh();
  EdgeRing& ring = this->Ring;
  if (!this->Target.GatherRing(t, i, j, LongestRing, ring))
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
    return false; // an edge of a face where the image cuts the object
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
  if (!this->Target.GatherRing(
        t, mesh.IndexOf(t, a), mesh.IndexOf(t, b), 4 * LongestRing, this->OtherRing) ||
    !this->OtherRing.Closed)
  {
    return true;
  }
  return std::any_of(this->OtherRing.Cells.begin(), this->OtherRing.Cells.end(),
    [&](std::uint32_t cell) { return mesh.Labels[cell] != mesh.Labels[t]; });
}

//------------------------------------------------------------------------------------------------
bool Flips::ImproveByRelabelling(std::uint32_t t)
{
  const TetrahedralComplex& mesh = this->Target.Mesh();
  const TetrahedralComplex::Label own = mesh.Labels[t];
  for (unsigned i = 0; i < 4; ++i)
  {
    const TetrahedralComplex::Label label = mesh.LabelOf(mesh.Cells[t].N[i]);
    bool again = label == own;
    for (unsigned j = 0; j < i; ++j)
    {
      again = again || mesh.LabelOf(mesh.Cells[t].N[j]) == label;
    }
    if (again || !this->MayRelabel(t, label))
    {
      continue;
    }
    if (label == 0)
    {
      const std::array<std::uint32_t, 1> old = { t };
      ++this->Done.Dropped;
      return this->Target.Replace(old, {});
    }
    this->Target.Relabel(t, label);
    this->ConsiderAll(t);
    if (this->Apply())
    {
      ++this->Done.Relabelled;
      return true;
    }
    this->Target.Relabel(t, own);
  }
  return false;
}

bool Flips::MayRelabel(std::uint32_t t, TetrahedralComplex::Label label)
{
  const TetrahedralComplex& mesh = this->Target.Mesh();
  const TetrahedralComplex::Label own = mesh.Labels[t];
  const auto& cell = mesh.Cells[t];
  if (!this->Target.MayChange(t) || mesh.IsHolder(t))
  {
    return false;
  }
  const auto facetIsAtJunction = [&](unsigned i)
  { return this->IsAtJunction(cell.V[(i + 1) & 3], cell.V[(i + 2) & 3], cell.V[(i + 3) & 3]); };
  unsigned shared = 0;
  FacetBounds bounds(this->Rules);
  for (unsigned i = 0; i < 4; ++i)
  {
    const TetrahedralComplex::Label other = mesh.LabelOf(cell.N[i]);
    shared += other == label ? 1 : 0;
    if (label == 0 && other == 0 && this->BorderFacesOfFacet(t, i) != 0)
    {
      return false; // would leave a hole in a flat face
    }
    if (other != own)
    {
      bounds.Replace(this->CosineOfFacet(t, i), facetIsAtJunction(i));
    }
  }
  if (shared < 2 || !this->IsFlatTowards(t, label))
  {
    return false;
  }
  for (unsigned i = 0; i < 4; ++i)
  {
    const bool isNew = mesh.LabelOf(cell.N[i]) == own;
    if (isNew && !bounds.Allow(this->CosineOfFacet(t, i), facetIsAtJunction(i)))
    {
      return false;
    }
  }
  for (unsigned i = 0; i < 4; ++i)
  {
    for (unsigned j = 0; j < i; ++j)
    {
      if (!this->EdgeRunsAllow(t, i, j, label))
      {
        return false;
      }
    }
  }
  // At no vertex may a label get more pieces than before, and the old label must remain at a vertex
  // of t.
  bool goesOn = false;
  for (const std::uint32_t v : cell.V)
  {
    if (!this->Target.GatherStar(v, this->Star))
    {
      return false;
    }
    const std::size_t pieces = this->PiecesInStar(t, label, own);
    goesOn = goesOn || pieces > 0;
    if (pieces > this->PiecesInStar(t, own, own) ||
      (label != 0 && this->PiecesInStar(t, label, label) > this->PiecesInStar(t, own, label)))
    {
      return false;
    }
  }
  return goesOn;
}

bool Flips::IsAtJunction(std::uint32_t u, std::uint32_t v, std::uint32_t w) const
{
  const auto& kinds = this->Target.Mesh().Kinds;
  return kinds[u] == VertexRole::Fixed || kinds[v] == VertexRole::Fixed ||
    kinds[w] == VertexRole::Fixed;
}

/** The faces of the image that facet i of t lies on. */
unsigned Flips::BorderFacesOfFacet(std::uint32_t t, unsigned i) const
{
  const TetrahedralComplex& mesh = this->Target.Mesh();
  const auto& v = mesh.Cells[t].V;
  return mesh.BorderFacesOf(v[(i + 1) & 3]) & mesh.BorderFacesOf(v[(i + 2) & 3]) &
    mesh.BorderFacesOf(v[(i + 3) & 3]);
}

/** The cosine of the smallest angle of facet i of t. */
double Flips::CosineOfFacet(std::uint32_t t, unsigned i) const
{
  const TetrahedralComplex& mesh = this->Target.Mesh();
  return CosineOfSmallestAngle(
    mesh.PointOf(t, (i + 1) & 3), mesh.PointOf(t, (i + 2) & 3), mesh.PointOf(t, (i + 3) & 3));
}

/** Whether the facets of t towards a label make no larger angle than a crease. */
bool Flips::IsFlatTowards(std::uint32_t t, TetrahedralComplex::Label label) const
{
  const TetrahedralComplex& mesh = this->Target.Mesh();
  std::array<Point<3>, 4> normals;
  std::size_t number = 0;
  for (unsigned i = 0; i < 4; ++i)
  {
    if (mesh.LabelOf(mesh.Cells[t].N[i]) == label)
    {
      const auto v = StartingAt(mesh.Cells[t].V, i);
      normals[number++] = Cross(Subtract(mesh.Points[v[2]], mesh.Points[v[1]]),
        Subtract(mesh.Points[v[3]], mesh.Points[v[1]]));
    }
  }
  for (std::size_t k = 0; k < number; ++k)
  {
    for (std::size_t m = 0; m < k; ++m)
    {
      if (!(CosineBetween(normals[k], normals[m]) >= this->Rules.CreaseCosine))
      {
        return false;
      }
    }
  }
  return true;
}

/**
 * Whether labels change around an edge of t at most as often as before, or twice, if t gets another
 * label.
 */
bool Flips::EdgeRunsAllow(std::uint32_t t, unsigned i, unsigned j, TetrahedralComplex::Label label)
{
  const TetrahedralComplex& mesh = this->Target.Mesh();
  EdgeRing& ring = this->OtherRing;
  if (!this->Target.GatherRing(t, i, j, 4 * LongestRing, ring))
  {
    return false;
  }
  unsigned before = ring.Closed ? 0 : 2; // to background and back
  unsigned after = before;
  const std::size_t cells = ring.Cells.size();
  const auto changed = [&](std::uint32_t cell) { return cell == t ? label : mesh.Labels[cell]; };
  for (std::size_t k = 0; k + (ring.Closed ? 0 : 1) < cells; ++k)
  {
    const std::uint32_t one = ring.Cells[k];
    const std::uint32_t next = ring.Cells[(k + 1) % cells];
    before += mesh.Labels[one] != mesh.Labels[next] ? 1 : 0;
    after += changed(one) != changed(next) ? 1 : 0;
  }
  if (!ring.Closed && label == 0)
  {
    // If t is at an end of the ring, it joins background there.
    after -= ring.Cells.front() == t ? 1 : 0;
    after -= ring.Cells.back() == t ? 1 : 0;
  }
  return after <= std::max(before, 2u);
}

/**
 * The number of pieces of a label in Star if t has the label ofT. A piece is connected through
 * facets.
 */
std::size_t Flips::PiecesInStar(
  std::uint32_t t, TetrahedralComplex::Label ofT, TetrahedralComplex::Label label)
{
  const TetrahedralComplex& mesh = this->Target.Mesh();
  const auto& cells = this->Star.Cells;
  const auto has = [&](std::uint32_t cell)
  { return (cell == t ? ofT : mesh.Labels[cell]) == label; };
  this->Reached.assign(cells.size(), 0);
  std::size_t pieces = 0;
  std::vector<std::size_t>& stack = this->Stack;
  for (std::size_t first = 0; first < cells.size(); ++first)
  {
    if (this->Reached[first] != 0 || !has(cells[first]))
    {
      continue;
    }
    ++pieces;
    this->Reached[first] = 1;
    stack.assign({ first });
    while (!stack.empty())
    {
      const std::size_t k = stack.back();
      stack.pop_back();
      for (const std::uint32_t next : mesh.Cells[cells[k]].N)
      {
        const auto at =
          static_cast<std::size_t>(std::find(cells.begin(), cells.end(), next) - cells.begin());
        if (at < cells.size() && this->Reached[at] == 0 && has(next))
        {
          this->Reached[at] = 1;
          stack.push_back(at);
        }
      }
    }
  }
  return pieces;
}

} // namespace voxplex
