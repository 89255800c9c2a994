// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Conformity/DistanceCheck.h"

#include "Conformity/FaceScan.h"
#include "Conformity/NonManifoldRidges.h"
#include "Geometry/BoundingTree.h"
#include "Geometry/CellGrid.h"
#include "Parallel/ParallelCollect.h"
#include "Refinement/Rules/FeatureGrid.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace voxplex
{

namespace
{

constexpr std::size_t Grain = 4096;

/**
 * The largest allowed distance of facets from interfaces, in finest sampling distances. Uniform
 * meshes are about as far away.
 */
constexpr double DistanceToFacets = 1.22;

/** Facets may be farther from voxel faces by this factor, because voxel faces form stairs. */
constexpr double StairFactor = 1.15;

/** The voxel whose centre is nearest along each axis. */
template <int D>
typename GridGeometry<D>::Index NearestVoxel(
  const Point<D>& place, const typename GridGeometry<D>::Index& dimensions)
{
  typename GridGeometry<D>::Index voxel;
  for (std::size_t a = 0; a < D; ++a)
  {
    voxel[a] = std::clamp<std::int64_t>(std::llround(place[a]), 0, dimensions[a] - 1);
  }
  return voxel;
}

//------------------------------------------------------------------------------------------------
/** The cells of space that are within a distance of some faces. */
template <int D>
class CellsAround
{
public:
  CellsAround(const Box<D>& bounds, double distance, const std::vector<VoxelFace<D>>& faces,
    const LabelImage<D>& image)
    : Grid(bounds, distance)
    , IsNear(CountCells(this->Grid.Cells))
  {
    using Index = typename VoxelFace<D>::Index;
    Index extent;
    std::copy(this->Grid.Cells.begin(), this->Grid.Cells.end(), extent.begin());
    for (const VoxelFace<D>& face : faces)
    {
      const Point<D> centre = CentreOf(face, image);
      Index low;
      Index high;
      for (std::size_t a = 0; a < D; ++a)
      {
        low[a] = static_cast<std::int64_t>(this->Grid.CellAlong(a, centre[a] - distance));
        high[a] = static_cast<std::int64_t>(this->Grid.CellAlong(a, centre[a] + distance));
      }
      ForEachIndex(
        low, high, [&](const Index& cell) { this->IsNear[OffsetOf(cell, extent)] = true; });
    }
  }

  bool Contain(const Point<D>& p) const { return this->IsNear[this->Grid.CellOf(p)]; }

private:
  const CellGrid<D> Grid;
  std::vector<bool> IsNear;
};

} // namespace

//------------------------------------------------------------------------------------------------
/** @brief The interfaces of a mesh, to be searched from faces. Thread-safe. */
template <int D>
class DistanceCheck<D>::Mesh
{
public:
  /** What was near an adjacent face. */
  struct Hint
  {
    const Point<D>* Vertex = nullptr;
    std::uint32_t Facet = 0; ///< see BoundingTree
  };

  Mesh(const DistanceCheck& check, MeshInterfaces<D> interfaces)
    : Check(check)
    , Largest(LargestDistanceToFacets(check.Image.Grid(), check.Sizing.Base().Asked))
    // With one sampling distance all queries are of the first level.
    , Vertices(Point<D>{}, check.Reach, interfaces.Vertices.size(),
        check.Sizing.IsUniform() ? 1 : FeatureGrid<D>::Levels)
    , Facets(std::move(interfaces.Facets), check.Threads, check.Stop)
  {
    ParallelFor(
      0, interfaces.Vertices.size(), Grain, check.Threads,
      [&](std::size_t first, std::size_t last)
      {
        for (std::size_t v = first; v < last; ++v)
        {
          this->Vertices.Add(interfaces.Vertices[v]);
        }
      },
      check.Stop);
  }

  bool IsFarFrom(const VoxelFace<D>& face, Hint& hint) const
  {
    const Point<D> centre = CentreOf(face, this->Check.Image);
    if (this->Check.MeasuresFacets)
    {
      return this->AreFacetsFarFrom(face, centre, hint.Facet);
    }
    const double asked = this->Check.Sizing.AskedDistance(
      centre, this->Check.Image.At(face.Voxel), this->Check.Image.At(face.Next()));
    const double distance = std::max(LargestDistance * asked, this->Check.VoxelDiagonal);
    if (hint.Vertex && Distance2(centre, *hint.Vertex) < distance * distance)
    {
      return false;
    }
    // A near vertex serves more of the adjacent faces than a far one.
    hint.Vertex = this->Vertices.FindWithin(centre, 0.5 * distance);
    if (!hint.Vertex)
    {
      hint.Vertex = this->Vertices.FindWithin(centre, distance);
    }
    return !hint.Vertex;
  }

private:
  /** Checks the face, and the smooth interface near it, which is the interface that is meshed; 3D. */
  bool AreFacetsFarFrom(
    const VoxelFace<D>& face, const Point<D>& centre, std::uint32_t& facet) const
  {
    const LabelImage<D>& image = this->Check.Image;
    const double half = 0.5 * image.Grid().Spacing(static_cast<int>(face.Axis));
    if (this->Largest > half && this->Vertices.AnyWithin(centre, this->Largest - half))
    {
      return false;
    }
    if constexpr (D == 3)
    {
      const double distance = std::sqrt(this->Facets.Distance2To(centre, facet));
      if (distance > StairFactor * this->Largest)
      {
        return true;
      }
      Point<D> z;
      return distance + half > this->Largest &&
        this->Check.Surfaces.FirstCrossing(
          image.CentreOf(face.Voxel), image.At(face.Voxel), image.CentreOf(face.Next()), z) &&
        this->Facets.Distance2To(z, facet) > this->Largest * this->Largest;
    }
    return true;
  }

  const DistanceCheck& Check;
  const double Largest; ///< allowed distance to facets
  FeatureGrid<D> Vertices;
  const BoundingTree<Triangle> Facets;
};

//------------------------------------------------------------------------------------------------
template <int D>
DistanceCheck<D>::DistanceCheck(const LabelImage<D>& image, const BitMask<D>& sites,
  const Domain<D>& domain, const SizingField<D>& sizing, unsigned threads,
  const std::stop_token& stop)
  : Image(image)
  , Sites(sites)
  , Surfaces(domain)
  , Sizing(sizing)
  , Threads(threads)
  , Stop(stop)
  , MeasuresFacets(D == 3 && sizing.Base().Graded)
  , VoxelDiagonal(image.Grid().VoxelDiagonal())
  , Reach(MeasuresFacets ? LargestDistanceToFacets(image.Grid(), sizing.Base().Asked)
                         : std::max(LargestDistance * sizing.Largest(), VoxelDiagonal))
{
  if (sizing.IsUniform())
  {
    constexpr double Safety = 1.0 - 1e-6;
    // The result is positive, because Reach is at least the voxel's diagonal.
    this->NearVoxel = Safety * (this->Reach - 0.5 * image.Grid().LargestSpacing());
  }
}

template <int D>
double DistanceCheck<D>::LargestDistanceToFacets(const GridGeometry<D>& grid, double delta)
{
  return std::max(DistanceToFacets * delta, 0.5 * grid.VoxelDiagonal());
}

//------------------------------------------------------------------------------------------------
template <int D>
std::vector<VoxelFace<D>> DistanceCheck<D>::FindFar(const LabelledTriangulation<D>& elements) const
{
  return this->FindFar(this->Find(elements, nullptr));
}

template <int D>
std::vector<VoxelFace<D>> DistanceCheck<D>::FindFar(MeshInterfaces<D> interfaces) const
{
  const BitMask<D> voxels = this->VoxelsToLookAt(interfaces.Vertices);
  const Mesh mesh(*this, std::move(interfaces));
  return ScanFaces<typename Mesh::Hint, D>(this->Image, voxels, this->Threads, this->Stop,
    [&](const VoxelFace<D>& face, typename Mesh::Hint& hint)
    { return mesh.IsFarFrom(face, hint); });
}

template <int D>
std::vector<VoxelFace<D>> DistanceCheck<D>::FindFar(
  const LabelledTriangulation<D>& elements, const std::vector<VoxelFace<D>>& among) const
{
  const Mesh mesh(*this, this->Find(elements, &among));
  return FilterFaces<typename Mesh::Hint, D>(among,
    [&](const VoxelFace<D>& face, typename Mesh::Hint& hint)
    { return mesh.IsFarFrom(face, hint); });
}

//------------------------------------------------------------------------------------------------
/** @param among if it is not null, vertices far from all of these faces may be left out */
template <int D>
MeshInterfaces<D> DistanceCheck<D>::Find(
  const LabelledTriangulation<D>& elements, const std::vector<VoxelFace<D>>* among) const
{
  MeshInterfaces<D> interfaces;
  if (among)
  {
    const CellsAround<D> near(this->Surfaces.Bounds(), this->Reach, *among, this->Image);
    interfaces.Vertices =
      this->FindVertices(elements, [&](const Point<D>& p) { return near.Contain(p); });
  }
  else
  {
    interfaces.Vertices = this->FindVertices(elements, [](const Point<D>&) { return true; });
  }
  if constexpr (D == 3)
  {
    if (this->MeasuresFacets)
    {
      const Triangulation<D>& mesh = elements.GetTriangulation();
      const InterfaceFacets<D> all =
        FindInterfaceFacets<D>(mesh, elements.GetLabels(), this->Threads, this->Stop);
      interfaces.Facets.reserve(all.Facets.size());
      for (const auto& v : all.Facets)
      {
        interfaces.Facets.push_back(
          { mesh.Position(v[0]), mesh.Position(v[1]), mesh.Position(v[2]) });
      }
    }
  }
  return interfaces;
}

template <int D>
template <typename IsWanted>
std::vector<Point<D>> DistanceCheck<D>::FindVertices(
  const LabelledTriangulation<D>& elements, const IsWanted& isWanted) const
{
  const Triangulation<D>& mesh = elements.GetTriangulation();
  return ParallelCollect<Point<D>>(
    mesh.VertexIdEnd(), Grain, this->Threads,
    [&](std::size_t first, std::size_t last, std::vector<Point<D>>& found)
    {
      for (auto v = static_cast<VertexId>(first); v < last; ++v)
      {
        const VertexRecord<D>& vertex = mesh.GetVertex(v);
        if (vertex.Alive && vertex.OnInterface && isWanted(vertex.Position))
        {
          found.push_back(vertex.Position);
        }
      }
    },
    this->Stop);
}

//------------------------------------------------------------------------------------------------
// The mask has the voxels of the crop and one layer around it.
template <int D>
Point<D> DistanceCheck<D>::PlaceInMask(const Point<D>& p) const
{
  Point<D> place = this->Image.Grid().ToIndex(p);
  for (std::size_t a = 0; a < D; ++a)
  {
    place[a] -= static_cast<double>(this->Image.CropOrigin()[a] - 1);
  }
  return place;
}

/** The surface voxels that may have far faces on their upper sides. */
template <int D>
BitMask<D> DistanceCheck<D>::VoxelsToLookAt(const std::vector<Point<D>>& vertices) const
{
  BitMask<D> voxels = this->Sites;
  if (this->NearVoxel == 0.0)
  {
    return voxels;
  }
  // Vertices may be much denser than voxels. Those of one voxel clear nearly the same voxels, so one
  // of them is enough. The scan uses all.
  BitMask<D> isUsed(voxels.Dimensions());
  ParallelFor(
    0, vertices.size(), Grain, this->Threads,
    [&](std::size_t first, std::size_t last)
    {
      for (std::size_t v = first; v < last; ++v)
      {
        const Point<D> place = this->PlaceInMask(vertices[v]);
        if (isUsed.SetIfClear(NearestVoxel<D>(place, isUsed.Dimensions())))
        {
          Index voxel{};
          this->ClearVoxelsNear(place, D - 1, this->NearVoxel * this->NearVoxel, voxel, voxels);
        }
      }
    },
    this->Stop);
  return voxels;
}

/**
 * Clears the voxels of a ball whose indices along the axes after `axis` are given, row by row.
 * IndexToFrame is upper triangular, so along an axis the coordinates of all later axes are constant.
 * @param left2 the squared radius, less the squared distance along these axes
 */
template <int D>
void DistanceCheck<D>::ClearVoxelsNear(
  const Point<D>& centre, std::size_t axis, double left2, Index& voxel, BitMask<D>& voxels) const
{
  const auto& m = this->Image.Grid().IndexToFrame;
  double middle = centre[axis]; // where the distance along this axis is 0
  for (std::size_t a = axis + 1; a < D; ++a)
  {
    middle -= m[axis][a] * (static_cast<double>(voxel[a]) - centre[a]) / m[axis][axis];
  }
  const double half = std::sqrt(std::max(left2, 0.0)) / m[axis][axis]; // left2 is rounded
  const auto first = std::max<std::int64_t>(static_cast<std::int64_t>(std::ceil(middle - half)), 0);
  const auto last =
    std::min(static_cast<std::int64_t>(std::floor(middle + half)), voxels.Dimensions()[axis] - 1);
  voxel[axis] = first;
  if (axis == 0)
  {
    voxels.ClearRun(voxel, last);
    return;
  }
  for (; voxel[axis] <= last; ++voxel[axis])
  {
    const double away = m[axis][axis] * (static_cast<double>(voxel[axis]) - middle);
    this->ClearVoxelsNear(centre, axis - 1, left2 - away * away, voxel, voxels);
  }
}

template class DistanceCheck<3>;
template class DistanceCheck<4>;

} // namespace voxplex
