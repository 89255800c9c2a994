// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Conformity/InterfaceSampling.h"

#include "Conformity/FinestSpacing.h"

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

/** The finest spacing of points, as FinestSpacing() takes it. */
constexpr double FinestVoxels = 0.2;

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
InterfaceSampling<D>::InterfaceSampling(const LabelImage<D>& image, const BitMask<D>& sites,
  const Domain<D>& domain, const SizingField<D>& sizing, LocalDelta<D>& local,
  const std::stop_token& stop)
  : Image(image)
  , Sites(sites)
  , Surfaces(domain)
  , Sizing(sizing)
  , Local(local)
  , Stop(stop)
  , FinestSpacing(voxplex::FinestSpacing<D>(image.Grid(), FinestVoxels))
{
}

//------------------------------------------------------------------------------------------------
template <int D>
std::vector<FeatureSeed<D>> InterfaceSampling<D>::AroundIfBad(
  const std::vector<VoxelFace<D>>& far, const std::vector<NonManifoldPlace<D>>& edges)
{
  const bool isBad = !far.empty() ||
    std::any_of(
      edges.begin(), edges.end(), [](const NonManifoldPlace<D>& edge) { return !edge.IsJunction; });
  return this->Around(far, isBad ? edges : std::vector<NonManifoldPlace<D>>());
}

//------------------------------------------------------------------------------------------------
template <int D>
std::vector<FeatureSeed<D>> InterfaceSampling<D>::Around(
  const std::vector<VoxelFace<D>>& far, const std::vector<NonManifoldPlace<D>>& edges)
{
  std::vector<SearchBall<D>> balls;
  balls.reserve(far.size() + edges.size());
  for (const VoxelFace<D>& face : far)
  {
    balls.push_back({ CentreOf(face, this->Image), RadiusAtFace * this->FirstDistance(face) });
  }
  for (const NonManifoldPlace<D>& edge : edges)
  {
    balls.push_back({ edge.Middle, RadiusAtEdge * this->Sizing.AskedNear(edge.Middle) });
  }
  const std::vector<VoxelFace<D>> faces =
    FindFacesNear(this->Image, this->Sites, balls, this->Stop);
  if (faces.empty())
  {
    return {};
  }
  this->Faces = UnionOf(this->Faces, faces);

  for (const VoxelFace<D>& face : far)
  {
    this->LowerBound(face);
  }
  std::vector<FeatureSeed<D>> seeds;
  std::map<Index, double> spacings;
  for (const VoxelFace<D>& face : faces)
  {
    const Index cell = CellOf(face);
    auto spacing = spacings.find(cell);
    if (spacing == spacings.end())
    {
      const unsigned visit = this->Visits[cell]++;
      spacing = spacings.emplace(cell, this->SpacingAt(face, visit)).first;
    }
    Point<D> z;
    if (spacing->second > 0.0 &&
      this->Surfaces.FirstCrossing(this->Image.CentreOf(face.Voxel), this->Image.At(face.Voxel),
        this->Image.CentreOf(face.Next()), z))
    {
      seeds.push_back({ z, spacing->second });
      this->Local.SetSpacing(face.Voxel, 1, spacing->second);
    }
  }
  this->Local.Grade(this->Sizing.Largest());
  return seeds;
}

//------------------------------------------------------------------------------------------------
template <int D>
auto InterfaceSampling<D>::CellOf(const VoxelFace<D>& face) -> Index
{
  Index cell = face.Voxel;
  for (std::int64_t& c : cell)
  {
    c = (c + 1) / LocalDelta<D>::Cell;
  }
  return cell;
}

/**
 * The distance that sampling begins with: the sampling distance. If it is graded, at most the
 * requested one.
 */
template <int D>
double InterfaceSampling<D>::FirstDistance(const VoxelFace<D>& face) const
{
  const double distance = this->Sizing.AskedDistance(
    CentreOf(face, this->Image), this->Image.At(face.Voxel), this->Image.At(face.Next()));
  const BaseDistance<D>& base = this->Sizing.Base();
  return base.Graded ? std::min(distance, base.Asked) : distance;
}

/**
 * The spacing, halved at each visit. The last visit has the finest spacing; after it, the result is
 * 0.
 */
template <int D>
double InterfaceSampling<D>::SpacingAt(const VoxelFace<D>& face, unsigned visit) const
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
template <int D>
void InterfaceSampling<D>::LowerBound(const VoxelFace<D>& face)
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

template class InterfaceSampling<3>;
template class InterfaceSampling<4>;

} // namespace voxplex
