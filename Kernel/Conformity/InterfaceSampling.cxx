// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Conformity/InterfaceSampling.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace voxplex
{

namespace
{

// Chosen on the knee atlas. Around edges, a larger radius adds elements, and makes new non-manifold
// edges at its rim. Around far faces, a smaller radius leaves out the parts that the tips of
// processes hang on.

/**
 * Faces are sampled within this many sampling distances of a far face, or of the midpoint of a
 * non-manifold edge.
 */
constexpr double RadiusAtFace = 1.0;
constexpr double RadiusAtEdge = 0.5;

/**
 * Spacing at the first visit, in sampling distances. With 0.5, there is one round less, but meshes
 * of atlases with thin labels have up to a sixth more elements.
 */
constexpr double FirstSpacing = 0.8;

/**
 * The sampling distance of R1 is this factor times the spacing of points, except the finest
 * spacing.
 */
constexpr double BoundFactor = 2.0;

/** The finest spacing of points, in smallest voxel spacings. */
constexpr double FinestVoxels = 0.2;

} // namespace

//------------------------------------------------------------------------------------------------
InterfaceSampling::InterfaceSampling(const LabelImage<3>& image, const BitMask<3>& sites,
  const Domain<3>& domain, const SizingField<3>& sizing, LocalDelta<3>& local,
  const std::stop_token& stop)
  : Image(image)
  , Sites(sites)
  , Surfaces(domain)
  , Sizing(sizing)
  , Local(local)
  , Stop(stop)
  , FinestSpacing(FinestVoxels * image.Grid().SmallestSpacing())
{
}

//------------------------------------------------------------------------------------------------
std::vector<FeatureSeed<3>> InterfaceSampling::AroundIfBad(
  const std::vector<VoxelFace>& far, const std::vector<NonManifoldPlace>& edges)
{
  const bool isBad = !far.empty() ||
    std::any_of(
      edges.begin(), edges.end(), [](const NonManifoldPlace& edge) { return !edge.IsJunction; });
  return this->Around(far, isBad ? edges : std::vector<NonManifoldPlace>());
}

//------------------------------------------------------------------------------------------------
std::vector<FeatureSeed<3>> InterfaceSampling::Around(
  const std::vector<VoxelFace>& far, const std::vector<NonManifoldPlace>& edges)
{
  std::vector<SearchBall> balls;
  balls.reserve(far.size() + edges.size());
  for (const VoxelFace& face : far)
  {
    balls.push_back({ CentreOf(face, this->Image), RadiusAtFace * this->FirstDistance(face) });
  }
  for (const NonManifoldPlace& edge : edges)
  {
    balls.push_back({ edge.Middle, RadiusAtEdge * this->Sizing.AskedNear(edge.Middle) });
  }
  const std::vector<VoxelFace> faces = FindFacesNear(this->Image, this->Sites, balls, this->Stop);
  if (faces.empty())
  {
    return {};
  }
  this->Faces = UnionOf(this->Faces, faces);

  for (const VoxelFace& face : far)
  {
    this->LowerBound(face);
  }
  std::vector<FeatureSeed<3>> seeds;
  std::map<Index, double> spacings;
  for (const VoxelFace& face : faces)
  {
    const Index cell = CellOf(face);
    auto spacing = spacings.find(cell);
    if (spacing == spacings.end())
    {
      const unsigned visit = this->Visits[cell]++;
      spacing = spacings.emplace(cell, this->SpacingAt(face, visit)).first;
    }
    Point<3> z;
    if (spacing->second > 0.0 &&
      this->Surfaces.FirstCrossing(this->Image.CentreOf(face.Voxel), this->Image.At(face.Voxel),
        this->Image.CentreOf(face.Next()), z))
    {
      seeds.push_back({ z, spacing->second });
      this->Local.SetSpacing(face.Voxel, 1, spacing->second);
    }
  }
  this->Local.Grade();
  return seeds;
}

//------------------------------------------------------------------------------------------------
InterfaceSampling::Index InterfaceSampling::CellOf(const VoxelFace& face)
{
  Index cell = face.Voxel;
  for (std::int64_t& c : cell)
  {
    c = (c + 1) / LocalDelta<3>::Cell;
  }
  return cell;
}

/**
 * The distance that sampling begins with: the sampling distance. If it is graded, at most the
 * requested one.
 */
double InterfaceSampling::FirstDistance(const VoxelFace& face) const
{
  const double distance = this->Sizing.AskedDistance(
    CentreOf(face, this->Image), this->Image.At(face.Voxel), this->Image.At(face.Next()));
  const BaseDistance<3>& base = this->Sizing.Base();
  return base.Graded ? std::min(distance, base.Asked) : distance;
}

/**
 * The spacing, halved at each visit. The last visit has the finest spacing; after it, the result is
 * 0.
 */
double InterfaceSampling::SpacingAt(const VoxelFace& face, unsigned visit) const
{
  const double first = FirstSpacing * this->FirstDistance(face);
  const double spacing = std::ldexp(first, -static_cast<int>(visit));
  if (spacing >= this->FinestSpacing)
  {
    return spacing;
  }
  return 2.0 * spacing > this->FinestSpacing || visit == 0 ? this->FinestSpacing : 0.0;
}

//------------------------------------------------------------------------------------------------
// Points alone do not give elements to a part that is thinner than their spacing: if no
// circumcentre lies in the part, no element has its label. R1 with a smaller sampling distance
// makes circumballs small enough.
void InterfaceSampling::LowerBound(const VoxelFace& face)
{
  const auto visits = this->Visits.find(CellOf(face));
  if (visits == this->Visits.end())
  {
    return;
  }
  const double spacing = this->SpacingAt(face, visits->second);
  if (spacing > 0.0)
  {
    const LabelId label = std::max(this->Image.At(face.Voxel), this->Image.At(face.Next()));
    const bool isFinest = spacing <= this->FinestSpacing;
    this->Local.SetBound(face.Voxel, 1, label, isFinest ? spacing : BoundFactor * spacing);
  }
}

//------------------------------------------------------------------------------------------------
std::vector<VoxelFace> UnionOf(const std::vector<VoxelFace>& a, const std::vector<VoxelFace>& b)
{
  std::vector<VoxelFace> all;
  std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(all));
  return all;
}

} // namespace voxplex
