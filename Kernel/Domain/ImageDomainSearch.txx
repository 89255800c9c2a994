// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ImageDomainSearch.txx
 * @brief Implementation of ImageDomain.h: distances, and searches for interface points.
 */
#ifndef voxplex_ImageDomainSearch_txx
#define voxplex_ImageDomainSearch_txx

#include "Domain/ImageDomain.h"

#include "Domain/BorderEdges.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace voxplex
{
namespace
{

/** Like FieldType::RootTolerance, where an estimate is enough. */
constexpr double QuickTolerance = 0.1;
/**
 * Largest number of steps of ClosestSurfacePoint towards the foot point. A step is made only if its
 * gain is at least FootGain voxel diagonals.
 */
constexpr int FootSteps = 2;
constexpr double FootGain = 0.02;
/** Bound of the relative error of a stored distance and of the few operations on it. */
constexpr double DistanceError = 1e-6;

/** Length of a step in voxels, along the axis where it is longest. */
template <int D>
double LargestComponent(const Point<D>& step)
{
  double largest = 0.0;
  for (const double component : step)
  {
    largest = std::max(largest, std::abs(component));
  }
  return largest;
}

} // namespace

template <int D, typename FieldType>
inline LabelId ImageDomain<D, FieldType>::VoxelId(const Index& index) const
{
  Index lattice = index;
  ClampToCut(this->Image, lattice);
  return this->Image.AtLattice(lattice);
}

template <int D, typename FieldType>
inline double ImageDomain<D, FieldType>::Length2(const Point<D>& step) const
{
  if (!this->IsOrthogonal)
  {
    const Point<D> d = this->Image.Grid().ToFrame(step);
    return Dot(d, d);
  }
  double sum = 0.0;
  for (std::size_t a = 0; a < D; ++a)
  {
    const double d = this->Spacing[a] * step[a];
    sum += d * d;
  }
  return sum;
}

template <int D, typename FieldType>
inline double ImageDomain<D, FieldType>::DistanceBoundAt(const Point<D>& x) const
{
  // Lengths are computed as if the axes were orthogonal, and stretched at the end.
  double outside2 = 0.0; // from x to the lattice
  double offset2 = 0.0;  // from the lattice's nearest point to the centre of its cell
  std::size_t cell = 0;
  for (std::size_t a = D; a-- > 0;)
  {
    double first = 0.0;
    auto last = static_cast<double>(this->Field.LatticeDimensions()[a] - 1);
    if (D == 4 && a == 3)
    {
      first = std::max(first, this->Field.FlatEnds()[0]);
      last = std::min(last, this->Field.FlatEnds()[1]);
    }
    const double inside = std::clamp(x[a], first, last);
    const double out = this->Spacing[a] * (x[a] - inside);
    outside2 += out * out;
    const std::uint32_t c = this->Features.CellOf(a, inside);
    const double offset = this->Spacing[a] * (inside - this->Features.Centre(a, c));
    offset2 += offset * offset;
    cell = cell * this->Features.CellDimensions()[a] + c;
  }
  const double distance = static_cast<double>(this->Features.Distance(cell));
  double lower =
    std::max(0.0, distance * (1.0 - DistanceError) - std::sqrt(offset2) - this->SiteDistance);
  if (outside2 > 0.0)
  {
    // All interfaces lie in the lattice's box, so the angle at the box is at least a right angle.
    lower = std::sqrt(lower * lower + outside2);
  }
  return this->SmallestStretch * lower;
}

template <int D, typename FieldType>
inline bool ImageDomain<D, FieldType>::NearSite(const Point<D>& x, Index& site) const
{
  // Compare the stored sites of the 2^D cells around x. If x is outside of the lattice, take the
  // cells around the lattice point nearest to x. The best site is the nearest to x, or nearly so.
  Point<D> inside = x;
  if (!this->IsOrthogonal)
  {
    Point<D> last;
    for (std::size_t a = 0; a < D; ++a)
    {
      last[a] = static_cast<double>(this->Field.LatticeDimensions()[a] - 1);
    }
    inside = this->Image.Grid().NearestInBox(x, last);
  }
  std::array<std::uint32_t, D> low;
  for (std::size_t a = 0; a < D; ++a)
  {
    low[a] =
      this->Features.CellOf(a, inside[a] - 0.5 * static_cast<double>(this->Features.Stride()[a]));
  }
  double best = std::numeric_limits<double>::infinity();
  std::uint32_t previous = FeatureTransform<D>::NoSite;
  for (unsigned corner = 0; corner < (1u << D); ++corner)
  {
    std::size_t cell = 0;
    for (std::size_t a = D; a-- > 0;)
    {
      const std::uint32_t c =
        std::min(low[a] + ((corner >> a) & 1u), this->Features.CellDimensions()[a] - 1);
      cell = cell * this->Features.CellDimensions()[a] + c;
    }
    const std::uint32_t voxel = this->Features.Site(cell);
    if (voxel == previous || voxel == FeatureTransform<D>::NoSite)
    {
      continue;
    }
    previous = voxel;
    const Index candidate = this->Features.IndexOf(voxel);
    Point<D> step;
    for (std::size_t a = 0; a < D; ++a)
    {
      step[a] = static_cast<double>(candidate[a]) - x[a];
    }
    const double distance2 = this->Length2(step);
    if (distance2 < best)
    {
      best = distance2;
      site = candidate;
    }
  }
  return best < std::numeric_limits<double>::infinity();
}

template <int D, typename FieldType>
inline bool ImageDomain<D, FieldType>::NearVoxelOfOtherLabel(
  const Point<D>& x, LabelId label, Index& voxel) const
{
  Index site{};
  if (!this->NearSite(x, site))
  {
    return false;
  }
  ClampToCut(this->Image, site);
  if (this->VoxelId(site) != label)
  {
    voxel = site;
    return true;
  }
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t a = 0; a < D; ++a)
  {
    for (int side = -1; side <= 1; side += 2)
    {
      Index candidate = site;
      candidate[a] += side;
      ClampToCut(this->Image, candidate);
      if (this->VoxelId(candidate) == label)
      {
        continue;
      }
      Point<D> step;
      for (std::size_t b = 0; b < D; ++b)
      {
        step[b] = static_cast<double>(candidate[b]) - x[b];
      }
      const double distance2 = this->Length2(step);
      if (distance2 < best)
      {
        best = distance2;
        voxel = candidate;
      }
    }
  }
  return best < std::numeric_limits<double>::infinity();
}

template <int D, typename FieldType>
inline typename ImageDomain<D, FieldType>::Probe ImageDomain<D, FieldType>::ProbeAt(
  const Point<D>& x, const Point<D>& d, LabelId label, double t) const
{
  Point<D> at;
  for (std::size_t a = 0; a < D; ++a)
  {
    at[a] = x[a] + t * d[a];
  }
  return { t, this->Field.MarginAt(at, label) };
}

template <int D, typename FieldType>
inline double ImageDomain<D, FieldType>::FindRoot(const Point<D>& x, const Point<D>& d,
  LabelId label, Probe inside, Probe outside, double tolerance) const
{
  const double voxels = LargestComponent<D>(d); // per unit of t
  int last = 0;                                 // which end moved last
  for (int i = 0; i < 40 && std::abs(outside.T - inside.T) * voxels > tolerance; ++i)
  {
    // Illinois algorithm: regula falsi that halves the value of an end that stays twice.
    double t =
      inside.T + (outside.T - inside.T) * (inside.Margin / (inside.Margin - outside.Margin));
    if (!((t - inside.T) * (t - outside.T) < 0.0))
    {
      t = 0.5 * (inside.T + outside.T);
    }
    const Probe probe = this->ProbeAt(x, d, label, t);
    if (std::abs(probe.Margin) < tolerance)
    {
      return t;
    }
    if (probe.Margin > 0.0)
    {
      inside = probe;
      outside.Margin *= last == 1 ? 0.5 : 1.0;
      last = 1;
    }
    else
    {
      outside = probe;
      inside.Margin *= last == -1 ? 0.5 : 1.0;
      last = -1;
    }
  }
  return 0.5 * (inside.T + outside.T);
}

template <int D, typename FieldType>
inline bool ImageDomain<D, FieldType>::MoveTowardsFoot(
  const Point<D>& p, const Point<D>& x, LabelId label, Point<D>& z) const
{
  Point<D> gradient;
  if (!this->Field.MarginGradientAt(this->Field.ToLattice(z), label, gradient))
  {
    return false;
  }
  // Transform the gradient to the frame: multiply by the transposed inverse of IndexToFrame, by
  // forward substitution.
  const auto& matrix = this->Image.Grid().IndexToFrame;
  for (std::size_t k = 0; k < D; ++k)
  {
    for (std::size_t r = 0; r < k; ++r)
    {
      gradient[k] -= matrix[r][k] * gradient[r];
    }
    gradient[k] /= matrix[k][k];
  }
  const double length = std::sqrt(Dot(gradient, gradient));
  const Point<D> toZ = Subtract(z, p);
  const double distance = std::sqrt(Dot(toZ, toZ));
  if (!(length > 0.0))
  {
    return false;
  }
  // The tangent plane is at the distance `foot` from p, in the direction against the gradient.
  const double foot = -Dot(toZ, gradient) / length;
  if (!(foot > 0.0 && foot < distance - FootGain * this->VoxelDiagonal))
  {
    return false;
  }
  Point<D> d; // step in lattice coordinates per unit of length
  for (std::size_t a = 0; a < D; ++a)
  {
    d[a] = -gradient[a] / length;
  }
  const Point<D> direction = d;
  d = this->Image.Grid().ToIndex(d);
  Probe outside = this->ProbeAt(x, d, label, std::min(distance, foot + 0.5 * this->VoxelDiagonal));
  if (outside.Margin > 0.0)
  {
    return false;
  }
  Probe inside = this->ProbeAt(x, d, label, std::max(0.0, foot - 0.5 * this->VoxelDiagonal));
  if (inside.T > 0.0 && !(inside.Margin > 0.0))
  {
    outside = inside;
    inside = this->ProbeAt(x, d, label, 0.0);
  }
  const double t = this->FindRoot(x, d, label, inside, outside, FieldType::RootTolerance);
  if (t >= distance)
  {
    return false;
  }
  Point<D> moved;
  for (std::size_t a = 0; a < D; ++a)
  {
    moved[a] = p[a] + t * direction[a];
  }
  if (this->ClampToEnds(moved) != moved)
  {
    return false; // beyond a flat end the field repeats the end
  }
  z = this->MoveOnto(moved,
    this->Field.Borders().Exist()
      ? this->Field.Borders().Near(this->Field.ToLattice(moved), NearBorder)
      : 0u);
  return true;
}

template <int D, typename FieldType>
inline bool ImageDomain<D, FieldType>::FindLine(
  const Point<D>& x, LabelId label, Search& search) const
{
  Index voxel{};
  if (!this->NearVoxelOfOtherLabel(x, label, voxel))
  {
    return false;
  }
  for (std::size_t a = 0; a < D; ++a)
  {
    search.End[a] = static_cast<double>(voxel[a]); // margin < 0 here
  }
  search.Step = Subtract(x, search.End);
  search.Length = std::sqrt(this->Length2(search.Step));
  search.Outside = this->ProbeAt(search.End, search.Step, label, 0.0);
  if (search.Length > 1.5 * this->VoxelDiagonal)
  {
    // The interface is near the voxel: search there in steps of half a voxel.
    const double step = 0.5 / LargestComponent<D>(search.Step);
    const double end = std::min(1.0, 2.0 * this->VoxelDiagonal / search.Length);
    for (double t = step; t < end; t += step)
    {
      const Probe probe = this->ProbeAt(search.End, search.Step, label, t);
      if (probe.Margin > 0.0)
      {
        search.Inside = probe;
        return true;
      }
      search.Outside = probe;
    }
  }
  search.Inside = { 1.0, this->Field.MarginAt(x, label) };
  return search.Inside.Margin > 0.0;
}

template <int D, typename FieldType>
bool ImageDomain<D, FieldType>::StartSearch(
  const Point<D>& p, LabelId label, Point<D>& z, double& error, Search& search) const
{
  const Point<D> x = this->Field.ToLattice(this->ClampToEnds(p));
  if (!this->FindLine(x, label, search))
  {
    return false;
  }
  search.IsStarted = true;
  const double t =
    this->FindRoot(search.End, search.Step, label, search.Inside, search.Outside, QuickTolerance);
  z = this->Found(Interpolate(search.End, x, t));
  // The margin rises by about 1 per voxel. The error allows for half of this slope.
  const double voxels = LargestComponent<D>(search.Step);
  error = voxels > 0.0 ? 2.0 * QuickTolerance * search.Length / voxels : 0.0;
  return true;
}

template <int D, typename FieldType>
bool ImageDomain<D, FieldType>::FinishSearch(
  const Search& search, const Point<D>& p, LabelId label, Point<D>& z) const
{
  const Point<D> q = this->ClampToEnds(p);
  const Point<D> x = this->Field.ToLattice(q);
  Search own;
  if (!search.IsStarted && !this->FindLine(x, label, own))
  {
    return false;
  }
  const Search& line = search.IsStarted ? search : own;
  const double t =
    this->FindRoot(line.End, line.Step, label, line.Inside, line.Outside, FieldType::RootTolerance);
  z = this->Found(Interpolate(line.End, x, t));
  for (int i = 0; i < FootSteps && this->MoveTowardsFoot(q, x, label, z); ++i)
  {
  }
  return true;
}

template <int D, typename FieldType>
bool ImageDomain<D, FieldType>::FirstCrossing(
  const Point<D>& a, LabelId labelOfA, const Point<D>& b, Point<D>& z) const
{
  const Point<D> x = this->Field.ToLattice(a);
  const Point<D> d = Subtract(this->Field.ToLattice(b), x);
  double longest = 0.0;
  double begin = 0.0;
  double end = 1.0;
  for (std::size_t k = 0; k < D; ++k)
  {
    // Clip to the lattice: outside there is only background, except beyond flat ends.
    double first = 0.0;
    auto last = static_cast<double>(this->Field.LatticeDimensions()[k] - 1);
    if (D == 4 && k == 3)
    {
      constexpr double infinity = std::numeric_limits<double>::infinity();
      first = this->Image.ReachesBorderInTime(0) ? -infinity : first;
      last = this->Image.ReachesBorderInTime(1) ? infinity : last;
    }
    longest = std::max(longest, std::abs(d[k]));
    if (d[k] == 0.0)
    {
      if (x[k] < first || x[k] > last)
      {
        return false;
      }
      continue;
    }
    const double t0 = (first - x[k]) / d[k];
    const double t1 = (last - x[k]) / d[k];
    begin = std::max(begin, std::min(t0, t1));
    end = std::min(end, std::max(t0, t1));
  }
  if (!(longest > 0.0) || !(begin <= end))
  {
    return false;
  }
  // Along a segment to a circumcentre that is very far away, a step must still change t.
  const double step = std::max(0.5 / longest, 4.0 * std::numeric_limits<double>::epsilon());
  const double perLength = 1.0 / std::sqrt(this->Length2(d));
  const auto pointAt = [&](double t)
  {
    Point<D> at;
    for (std::size_t k = 0; k < D; ++k)
    {
      at[k] = x[k] + t * d[k];
    }
    return at;
  };
  Probe before = this->ProbeAt(x, d, labelOfA, begin);
  while (before.T < end)
  {
    const double free = this->DistanceBoundAt(pointAt(before.T)) * perLength;
    const Probe probe =
      this->ProbeAt(x, d, labelOfA, std::min(end, before.T + std::max(step, free)));
    if (!(probe.Margin > 0.0))
    {
      z = this->Found(
        pointAt(this->FindRoot(x, d, labelOfA, before, probe, FieldType::RootTolerance)));
      return true;
    }
    before = probe;
  }
  return false;
}

template <int D, typename FieldType>
bool ImageDomain<D, FieldType>::FindEdge(const Point<D>& p, double reach, Point<D>& z) const
{
  if constexpr (D == 3)
  {
    const unsigned faces = this->FacesAt(p);
    const Point<D> x = this->Field.Borders().MoveOnto(this->Field.ToLattice(p), faces);
    if (faces != 0 && BorderEdgeSearch(this->Field, this->Image.Grid(), x, faces, reach).Find(z))
    {
      z = this->Found(z);
      return true;
    }
  }
  return false;
}

template <int D, typename FieldType>
bool ImageDomain<D, FieldType>::ClosestSurfacePointOnEnd(const Point<D>& p, Point<D>& z) const
{
  const Point<D> x = this->Field.ToLattice(p);
  const LabelId label = this->Field.LabelAt(x);
  Point<D> gradient;
  if (!this->Field.MarginGradientAt(x, label, gradient))
  {
    return false;
  }
  // The steepest descent in space, in lattice coordinates: minus the inverse metric times the
  // gradient.
  const auto& grid = this->Image.Grid();
  Point<D> covector = gradient;
  covector[D - 1] = 0.0;
  for (std::size_t k = 0; k < D; ++k)
  {
    for (std::size_t r = 0; r < k; ++r)
    {
      covector[k] -= grid.IndexToFrame[r][k] * covector[r];
    }
    covector[k] /= -grid.IndexToFrame[k][k];
  }
  covector[D - 1] = 0.0;
  const Point<D> d = grid.ToIndex(covector);
  const double longest = LargestComponent<D>(d);
  if (!(longest > 0.0))
  {
    return false;
  }
  constexpr int Steps = 6; // steps of half a voxel
  Probe inside = this->ProbeAt(x, d, label, 0.0);
  for (int i = 1; i <= Steps; ++i)
  {
    const Probe probe = this->ProbeAt(x, d, label, 0.5 * i / longest);
    if (!(probe.Margin > 0.0))
    {
      const double t = this->FindRoot(x, d, label, inside, probe, FieldType::RootTolerance);
      for (std::size_t a = 0; a + 1 < D; ++a)
      {
        z[a] = x[a] + t * d[a];
      }
      z[D - 1] = x[D - 1];
      z = this->Field.ToFrame(z);
      z[D - 1] = p[D - 1];
      return true;
    }
    inside = probe;
  }
  return false;
}

} // namespace voxplex

#endif
