// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Conformity/FragmentCheck.h"

#include "Base/GridIndex.h"
#include "Geometry/SimplexQuality.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace voxplex
{

namespace
{

using Index = GridGeometry<3>::Index;

/**
 * Points are asked for this many times at most. Each time the spacing becomes finer where they are asked
 * for, so most meshes need less than 15. But where a finer part of a vessel meets a coarser one, a new
 * gap may open.
 */
constexpr unsigned MostRounds = 64;

/**
 * Without exact components, those are listed whose largest fragment has less than this part of the volume.
 * Many meshes have a few tetrahedra that hang on the rest at an edge.
 */
constexpr double WholeFraction = 0.9;

/**
 * Around a fragment that has no centre of a voxel, faces are sampled within this many longest edges of a
 * tetrahedron around its vertices.
 */
constexpr double RadiusAtVertex = 0.5;

double LongestEdge(const std::array<Point<3>, 4>& p)
{
  double longest2 = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i)
  {
    for (std::size_t j = 0; j < i; ++j)
    {
      longest2 = std::max(longest2, Distance2(p[i], p[j]));
    }
  }
  return std::sqrt(longest2);
}

/** Calls visit(voxel) with the voxels of the crop that have their centres in or on a tetrahedron. */
template <typename Visit>
void ForEachCentreIn(std::array<Point<3>, 4> points, const LabelImage<3>& image, const Visit& visit)
{
  Index low;
  Index high;
  low.fill(std::numeric_limits<std::int64_t>::max());
  high.fill(std::numeric_limits<std::int64_t>::min());
  for (Point<3>& p : points)
  {
    p = image.Grid().ToIndex(p);
    for (std::size_t a = 0; a < 3; ++a)
    {
      p[a] -= static_cast<double>(image.CropOrigin()[a]);
      low[a] = std::min<std::int64_t>(low[a], std::llround(p[a]));
      high[a] = std::max<std::int64_t>(high[a], std::llround(p[a]));
    }
  }
  const std::array<const Point<3>*, 4> corners = { &points[0], &points[1], &points[2], &points[3] };
  constexpr double Tolerance = 1e-9; // centres may be on faces
  const double whole = SignedVolume<3>(corners.data());
  ForEachIndex(low, high,
    [&](const Index& voxel)
    {
      const Point<3> centre = { static_cast<double>(voxel[0]), static_cast<double>(voxel[1]),
        static_cast<double>(voxel[2]) };
      for (std::size_t i = 0; i < 4; ++i)
      {
        std::array<const Point<3>*, 4> part = corners;
        part[i] = &centre;
        if (SignedVolume<3>(part.data()) < -Tolerance * whole)
        {
          return;
        }
      }
      visit(voxel);
    });
}

} // namespace

//------------------------------------------------------------------------------------------------
FragmentCheck::FragmentCheck(const Subject& subject, const ComponentOptions& options,
  bool mayRefine, LocalSampling<3>& sampling, ComponentStatistics& statistics,
  const std::stop_token& stop)
  : Of(subject)
  , Wanted(subject.All.FindWanted(options.Smallest))
  , Exact(options.Exact)
  , RoundsLeft(options.Exact && mayRefine ? MostRounds : 0)
  , Sampling(sampling)
  , Statistics(statistics)
  , Stop(stop)
{
}

//------------------------------------------------------------------------------------------------
bool FragmentCheck::Inspect(const LabelledTriangulation<3>& elements)
{
  ElementFragments fragments(elements, this->Stop);
  fragments.FindComponents(this->Of.All, this->Of.Image);
  const std::vector<Pieces> pieces = this->FindPieces(fragments);
  this->Report(pieces);
  if (this->RoundsLeft == 0 || this->Statistics.Broken.empty())
  {
    return false;
  }
  const std::size_t points =
    this->Sampling.SampleGaps(this->FacesNear(this->FindGaps(fragments, pieces), pieces));
  if (points == 0)
  {
    return false;
  }
  --this->RoundsLeft;
  ++this->Statistics.Rounds;
  this->Statistics.Seeds += points;
  return true;
}

//------------------------------------------------------------------------------------------------
std::vector<FragmentCheck::Pieces> FragmentCheck::FindPieces(ElementFragments& fragments) const
{
  std::vector<Pieces> pieces(this->Wanted.size());
  for (const ElementFragments::Fragment& fragment : fragments.All())
  {
    if (fragment.Component != None && this->Wanted[fragment.Component])
    {
      ++pieces[fragment.Component].Number;
    }
  }
  std::vector<bool> isOfBroken;
  for (const ElementFragments::Fragment& fragment : fragments.All())
  {
    isOfBroken.push_back(fragment.Component != None && pieces[fragment.Component].Number > 1);
  }
  fragments.MeasureVolumes(isOfBroken);
  for (std::uint32_t f = 0; f < fragments.All().size(); ++f)
  {
    if (isOfBroken[f])
    {
      const double volume = fragments.All()[f].Volume;
      Pieces& of = pieces[fragments.All()[f].Component];
      of.Volume += volume;
      if (volume > of.LargestVolume)
      {
        of.LargestVolume = volume;
        of.Largest = f;
      }
    }
  }
  return pieces;
}

void FragmentCheck::Report(const std::vector<Pieces>& pieces)
{
  this->Statistics.Broken.clear(); // of an earlier round
  for (std::size_t c = 0; c < pieces.size(); ++c)
  {
    if (pieces[c].Number < 2)
    {
      continue;
    }
    const double largest = pieces[c].LargestVolume / pieces[c].Volume;
    if (this->Exact || largest < WholeFraction)
    {
      this->Statistics.Broken.push_back(
        { MakeReport(this->Of.All.All()[c], this->Of.Image), pieces[c].Number, largest });
    }
  }
}

//------------------------------------------------------------------------------------------------
// Only fragments other than the largest are looked at: each gap is beside one of them. A gap is where
// two voxels of a component are neighbours, and a fragment has the centre of only one of them.
std::vector<SearchBall<3>> FragmentCheck::FindGaps(
  const ElementFragments& fragments, const std::vector<Pieces>& pieces) const
{
  const auto isSmaller = [&](std::uint32_t f)
  {
    const std::uint32_t c = f == None ? None : fragments.All()[f].Component;
    return c != None && pieces[c].Number > 1 && pieces[c].Largest != f;
  };
  std::vector<std::pair<std::uint32_t, Index>> held; // fragments, and the centres that they have
  std::vector<bool> hasCentre(fragments.All().size());
  for (std::size_t s = 0; s < fragments.Size(); ++s)
  {
    const std::uint32_t f = fragments.Of(s);
    if (isSmaller(f))
    {
      ForEachCentreIn(fragments.PointsOf(s), this->Of.Image,
        [&](const Index& voxel)
        {
          if (this->Of.All.At(voxel) == fragments.All()[f].Component)
          {
            held.emplace_back(f, voxel);
            hasCentre[f] = true;
          }
        });
    }
  }
  std::sort(held.begin(), held.end());

  const double diagonal = this->Of.Image.Grid().VoxelDiagonal();
  std::vector<SearchBall<3>> gaps;
  for (const auto& [f, voxel] : held)
  {
    for (std::size_t a = 0; a < 3; ++a)
    {
      for (const std::int64_t direction : { -1, 1 })
      {
        Index next = voxel;
        next[a] += direction;
        if (this->Of.All.At(next) == fragments.All()[f].Component &&
          !std::binary_search(held.begin(), held.end(), std::pair(f, next)))
        {
          gaps.push_back(
            { Interpolate(this->Of.Image.CentreOf(voxel), this->Of.Image.CentreOf(next), 0.5),
              diagonal });
        }
      }
    }
  }
  for (std::size_t s = 0; s < fragments.Size(); ++s)
  {
    if (isSmaller(fragments.Of(s)) && !hasCentre[fragments.Of(s)])
    {
      const std::array<Point<3>, 4> points = fragments.PointsOf(s);
      for (const Point<3>& p : points)
      {
        gaps.push_back({ p, std::max(diagonal, RadiusAtVertex * LongestEdge(points)) });
      }
    }
  }
  return gaps;
}

std::vector<VoxelFace<3>> FragmentCheck::FacesNear(
  const std::vector<SearchBall<3>>& gaps, const std::vector<Pieces>& pieces) const
{
  std::vector<VoxelFace<3>> faces = FindFacesNear(this->Of.Image, this->Of.Sites, gaps, this->Stop);
  const auto isBrokenAt = [&](const Index& voxel)
  {
    const std::uint32_t c = this->Of.All.At(voxel);
    return c != Components<3>::None && pieces[c].Number > 1;
  };
  std::erase_if(faces,
    [&](const VoxelFace<3>& face) { return !isBrokenAt(face.Voxel) && !isBrokenAt(face.Next()); });
  return faces;
}

} // namespace voxplex
