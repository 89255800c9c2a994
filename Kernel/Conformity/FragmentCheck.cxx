// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Conformity/FragmentCheck.h"

#include "Base/DisjointSets.h"
#include "Conformity/FinestSpacing.h"
#include "Conformity/InterfaceSampling.h"
#include "Mesh/LabelledTriangulation.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace voxplex
{

namespace
{

/**
 * The spacing of points at the first visit of a place, in sampling distances, and at each further
 * visit, in spacings of the visit before. With 0.4 and 0.5, meshes of thin sheets have up to six times
 * as many elements.
 */
constexpr double FirstSpacing = 0.6;
constexpr double NextSpacing = 0.6;

/** The sampling distance of R1 is this factor times the spacing of points. */
constexpr double BoundFactor = 2.0;

/** The finest spacing of points, as FinestSpacing() takes it. */
constexpr double FinestVoxels = 0.5;

/**
 * Faces are sampled within this many longest edges of a tetrahedron around its vertices: a gap
 * between fragments is hardly wider than an edge, and is closed from both sides.
 */
constexpr double RadiusAtVertex = 0.5;

/** The sets of simplices of one label that are connected through faces. */
DisjointSets FindFragments(const LabelledTriangulation<3>& elements)
{
  const std::span<const LabelId> labels = elements.GetLabels();
  DisjointSets fragments(labels.size());
  for (SimplexId s = 0; s < labels.size(); ++s)
  {
    if (labels[s] != 0)
    {
      for (const SimplexId n : elements.GetTriangulation().GetSimplex(s).N)
      {
        if (n < s && labels[n] == labels[s])
        {
          fragments.Join(s, n);
        }
      }
    }
  }
  return fragments;
}

/** The size of the largest fragment of a component. */
struct Largest
{
  std::uint32_t Size = 0;
  std::uint32_t OfThisSize = 0;
  std::uint32_t Fragments = 0; ///< in all

  void Add(std::uint32_t size)
  {
    ++this->Fragments;
    this->OfThisSize = size > this->Size ? 1 : this->OfThisSize + (size == this->Size ? 1 : 0);
    this->Size = std::max(this->Size, size);
  }

  /** Whether a fragment of this size is larger than all others. */
  bool IsAlone(std::uint32_t size) const { return size == this->Size && this->OfThisSize == 1; }
};

double LongestEdge(const Triangulation<3>& mesh, SimplexId s)
{
  const auto& v = mesh.GetSimplex(s).V;
  double longest2 = 0.0;
  for (std::size_t i = 0; i < v.size(); ++i)
  {
    for (std::size_t j = 0; j < i; ++j)
    {
      longest2 = std::max(longest2, Distance2(mesh.Position(v[i]), mesh.Position(v[j])));
    }
  }
  return std::sqrt(longest2);
}

} // namespace

//------------------------------------------------------------------------------------------------
FragmentCheck::FragmentCheck(const Subject& subject, std::int64_t fewestVoxels, unsigned rounds,
  LocalDelta<3>& local, ComponentStatistics& statistics, double& seconds,
  const std::stop_token& stop)
  : ConformityCheck<3>(seconds)
  , Of(subject)
  , Wanted(subject.All.FindWanted(fewestVoxels))
  , RoundsLeft(rounds)
  , Local(local)
  , Statistics(statistics)
  , Stop(stop)
  , FinestSpacing(voxplex::FinestSpacing<3>(subject.Image.Grid(), FinestVoxels))
{
}

//------------------------------------------------------------------------------------------------
Remedy<3> FragmentCheck::InspectElements(const LabelledTriangulation<3>& elements)
{
  if (this->RoundsLeft == 0)
  {
    return {};
  }
  std::vector<FeatureSeed<3>> points = this->Sample(this->FacesOfFragments(elements));
  if (points.empty())
  {
    return {};
  }
  --this->RoundsLeft;
  ++this->Statistics.Rounds;
  this->Statistics.Seeds += points.size();
  return { true, std::move(points) };
}

//------------------------------------------------------------------------------------------------
std::uint32_t FragmentCheck::ComponentOf(const Triangulation<3>& mesh, SimplexId s) const
{
  Point<3> centroid{};
  for (const VertexId v : mesh.GetSimplex(s).V)
  {
    for (std::size_t a = 0; a < 3; ++a)
    {
      centroid[a] += 0.25 * mesh.Position(v)[a];
    }
  }
  const Point<3> at = this->Of.Image.Grid().ToIndex(centroid);
  Index voxel;
  for (std::size_t a = 0; a < 3; ++a)
  {
    voxel[a] = std::llround(at[a]) - this->Of.Image.CropOrigin()[a];
  }
  return this->Of.All.At(voxel);
}

std::vector<VoxelFace<3>> FragmentCheck::FacesOfFragments(
  const LabelledTriangulation<3>& elements) const
{
  constexpr std::uint32_t Unknown = Components<3>::None;
  const Triangulation<3>& mesh = elements.GetTriangulation();
  const std::span<const LabelId> labels = elements.GetLabels();
  const std::vector<Component<3>>& all = this->Of.All.All();
  DisjointSets fragments = FindFragments(elements);
  std::vector<std::uint32_t> size(labels.size()); // by name of the fragment
  for (SimplexId s = 0; s < labels.size(); ++s)
  {
    ++size[fragments.Find(s)];
  }
  ThrowIfStopped(this->Stop);

  std::vector<std::uint32_t> component(labels.size(), Unknown); // likewise
  std::vector<Largest> largest(all.size());                     // by component
  for (SimplexId s = 0; s < labels.size(); ++s)
  {
    const std::uint32_t fragment = fragments.Find(s);
    if (labels[s] == 0 || component[fragment] != Unknown)
    {
      continue;
    }
    const std::uint32_t c = this->ComponentOf(mesh, s);
    if (c == Components<3>::None || all[c].Label != labels[s] || !this->Wanted[c])
    {
      continue;
    }
    component[fragment] = c;
    largest[c].Add(size[fragment]);
  }

  std::vector<SearchBall<3>> balls;
  for (SimplexId s = 0; s < labels.size(); ++s)
  {
    const std::uint32_t fragment = fragments.Find(s);
    const std::uint32_t c = component[fragment];
    if (labels[s] != 0 && c != Unknown && !largest[c].IsAlone(size[fragment]))
    {
      const double radius =
        std::max(this->Of.Image.Grid().VoxelDiagonal(), RadiusAtVertex * LongestEdge(mesh, s));
      for (const VertexId v : mesh.GetSimplex(s).V)
      {
        balls.push_back({ mesh.Position(v), radius });
      }
    }
  }
  if (balls.empty())
  {
    return {};
  }
  std::vector<VoxelFace<3>> faces =
    FindFacesNear(this->Of.Image, this->Of.Sites, balls, this->Stop);
  const auto isInFragmentsAt = [&](const Index& voxel)
  {
    const std::uint32_t c = this->Of.All.At(voxel);
    return c != Components<3>::None && largest[c].Fragments > 1;
  };
  std::erase_if(faces,
    [&](const VoxelFace<3>& face)
    { return !isInFragmentsAt(face.Voxel) && !isInFragmentsAt(face.Next()); });
  return faces;
}

//------------------------------------------------------------------------------------------------
/** Points on these faces, and bounds there. Each cell is sampled once in a call. */
std::vector<FeatureSeed<3>> FragmentCheck::Sample(const std::vector<VoxelFace<3>>& faces)
{
  std::vector<FeatureSeed<3>> seeds;
  std::map<Index, double> now;
  for (const VoxelFace<3>& face : faces)
  {
    const LabelId before = this->Of.Image.At(face.Voxel);
    const LabelId after = this->Of.Image.At(face.Next());
    const Index cell = InterfaceSampling<3>::CellOf(face);
    auto spacing = now.find(cell);
    if (spacing == now.end())
    {
      const auto last = this->Spacings.find(cell);
      const double next = last != this->Spacings.end() ? NextSpacing * last->second
                                                       : FirstSpacing *
          this->Of.Sizing.SamplingDistance(CentreOf(face, this->Of.Image), before, after);
      spacing = now.emplace(cell, next).first;
      this->Spacings[cell] = next;
    }
    Point<3> z;
    if (spacing->second >= this->FinestSpacing &&
      this->Of.Surfaces.FirstCrossing(
        this->Of.Image.CentreOf(face.Voxel), before, this->Of.Image.CentreOf(face.Next()), z))
    {
      seeds.push_back({ z, spacing->second });
      this->Local.SetBound(face.Voxel, 1, std::max(before, after), BoundFactor * spacing->second);
    }
  }
  this->Local.Grade(this->Of.Sizing.Largest());
  return seeds;
}

} // namespace voxplex
