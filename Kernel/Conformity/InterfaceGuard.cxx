// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Conformity/InterfaceGuard.h"

#include "Parallel/ParallelFor.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <utility>

namespace voxplex
{

namespace
{

// Chosen on the knee atlas: around edges a larger radius adds elements and new trouble at its rim, around
// far faces a smaller one leaves the tips of processes without what they hang on.

/** Faces within so many delta of a far face, or of the middle of a non-manifold edge, are sampled. */
constexpr double RadiusAtFace = 1.0;
constexpr double RadiusAtEdge = 0.5;

/**
 * Spacing at the first visit, in delta. With 0.5 there is one round less, but meshes of atlases with thin labels have up to
 * a sixth more elements.
 */
constexpr double FirstSpacing = 0.8;

/** Bounds of circumballs are this times the spacing of points, but for the finest. */
constexpr double BoundFactor = 2.0;

/** Nothing is sampled more finely than this, in smallest voxel spacings. */
constexpr double FinestVoxels = 0.2;

/** Where delta is graded the mesh may be so many finest deltas away from interfaces; uniform meshes are about as far. */
constexpr double SurfaceDistance = 1.22;
/** From faces of voxels it may be so many times as far, for their stairs. */
constexpr double StairFactor = 1.15;

/** Of vertices that are nearer to each other than this times NearVoxel one is enough to clear voxels around. */
constexpr double ClearingDistance = 0.25;

/** Of both, which are ascending. */
std::vector<VoxelFace> UnionOf(const std::vector<VoxelFace>& a, const std::vector<VoxelFace>& b)
{
  std::vector<VoxelFace> all;
  std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(all));
  return all;
}

std::vector<Point<3>> VerticesOfInterfaces(const SimplexMesh<3>& mesh)
{
  std::vector<Point<3>> vertices;
  std::vector<bool> added(mesh.Points.size());
  for (const auto& facet : mesh.Facets)
  {
    for (const std::uint32_t v : facet)
    {
      if (!added[v])
      {
        added[v] = true;
        vertices.push_back(mesh.Points[v]);
      }
    }
  }
  return vertices;
}

/** Some of the points, none nearer to another than `distance`; each of the others is nearer to one of them. */
std::vector<Point<3>> ThinOut(const std::vector<Point<3>>& points, double distance)
{
  FeatureGrid<3> kept({ 0.0, 0.0, 0.0 }, distance, points.size());
  std::vector<Point<3>> some;
  for (const Point<3>& p : points)
  {
    if (!kept.AnyWithin(p, distance))
    {
      kept.Add(p);
      some.push_back(p);
    }
  }
  return some;
}

double DiagonalOf(const GridGeometry<3>& grid)
{
  const Point<3> voxel{ grid.Spacing(0), grid.Spacing(1), grid.Spacing(2) };
  return std::sqrt(Dot(voxel, voxel));
}

} // namespace

//------------------------------------------------------------------------------------------------
InterfaceGuard::InterfaceGuard(const LabelImage<3>& image, const BitMask<3>& sites,
  const Domain<3>& domain, const BaseDensity<3>& base, const InterfaceSizes<3>* sizes,
  LocalDelta<3>& local, unsigned threads, const std::stop_token& stop)
  : Image(image)
  , Sites(sites)
  , Surfaces(domain)
  , Base(base)
  , Sizes(sizes)
  , Local(local)
  , Threads(threads)
  , Stop(stop)
{
  const GridGeometry<3>& grid = this->Image.Grid();
  const Point<3> spacing{ grid.Spacing(0), grid.Spacing(1), grid.Spacing(2) };
  this->FinestSpacing = FinestVoxels * std::min({ spacing[0], spacing[1], spacing[2] });
  this->VoxelDiagonal = DiagonalOf(grid);
  this->NearEnough = LargestSurfaceDistance(grid, this->Base.Asked);
  if (!this->Sizes && !this->Base.Graded)
  {
    constexpr double Safety = 1.0 - 1e-6;
    const double distance = std::max(LargestDistance * this->Base.Delta, this->VoxelDiagonal);
    const double half = 0.5 * std::max({ spacing[0], spacing[1], spacing[2] });
    this->NearVoxel = Safety * (distance - half); // half a diagonal is longer
  }
}

//------------------------------------------------------------------------------------------------
double InterfaceGuard::LargestSurfaceDistance(const GridGeometry<3>& grid, double delta)
{
  return std::max(SurfaceDistance * delta, 0.5 * DiagonalOf(grid));
}

//------------------------------------------------------------------------------------------------
double InterfaceGuard::DeltaAt(const Face& face) const
{
  return this->DeltaAt(face, this->CentreOf(face));
}

double InterfaceGuard::DeltaAt(const Face& face, const Point<3>& centre) const
{
  return this->Sizes
    ? this->Sizes->At(centre, this->Image.At(face.Voxel), this->Image.At(face.Next()))
    : this->Base.At(centre);
}

/** Of all interfaces that there may be. */
double InterfaceGuard::DensestAt(const Point<3>& p) const
{
  return this->Sizes ? std::min(this->Sizes->Largest(), this->Sizes->GradedAt(p))
                     : this->Base.At(p);
}

double InterfaceGuard::RemedyAt(const Face& face) const
{
  const double delta = this->DeltaAt(face);
  return this->Base.Graded ? std::min(delta, this->Base.Asked) : delta;
}

bool InterfaceGuard::IsFar(const Face& face, const Interfaces& mesh, Hint& hint) const
{
  return this->Base.Graded ? this->IsFarFromTriangles(face, mesh, hint.Triangle)
                           : this->IsFarFromVertices(face, mesh.Vertices, hint.Vertex);
}

bool InterfaceGuard::IsFarFromVertices(
  const Face& face, const FeatureGrid<3>& vertices, const Point<3>*& known) const
{
  const Point<3> centre = this->CentreOf(face);
  const double distance =
    std::max(LargestDistance * this->DeltaAt(face, centre), this->VoxelDiagonal);
  if (known && Distance2(centre, *known) < distance * distance)
  {
    return false;
  }
  known =
    vertices.FindWithin(centre, 0.5 * distance); // it serves more faces nearby than a farther one
  if (!known)
  {
    known = vertices.FindWithin(centre, distance);
  }
  return !known;
}

// The faces of voxels, and the interface that runs about them, which is what is meshed.
bool InterfaceGuard::IsFarFromTriangles(
  const Face& face, const Interfaces& mesh, std::uint32_t& hint) const
{
  const Point<3> centre = this->CentreOf(face);
  const double half = 0.5 * this->Image.Grid().Spacing(static_cast<int>(face.Axis));
  if (this->NearEnough > half && mesh.Vertices.AnyWithin(centre, this->NearEnough - half))
  {
    return false;
  }
  const double distance = std::sqrt(mesh.Triangles.Distance2To(centre, hint));
  if (distance > StairFactor * this->NearEnough)
  {
    return true;
  }
  Point<3> z;
  return distance + half > this->NearEnough &&
    this->Surfaces.FirstCrossing(this->Image.CentreOf(face.Voxel), this->Image.At(face.Voxel),
      this->Image.CentreOf(face.Next()), z) &&
    mesh.Triangles.Distance2To(z, hint) > this->NearEnough * this->NearEnough;
}

void InterfaceGuard::FindFarFacesOf(
  const Index& voxel, const Interfaces& mesh, Hint& hint, std::vector<Face>& far) const
{
  for (unsigned a = 0; a < 3; ++a)
  {
    const Face face{ voxel, a };
    if (this->Image.At(voxel) != this->Image.At(face.Next()) && this->IsFar(face, mesh, hint))
    {
      far.push_back(face);
    }
  }
}

Point<3> InterfaceGuard::CentreOf(const Face& face) const
{
  return voxplex::CentreOf(face, this->Image);
}

//------------------------------------------------------------------------------------------------
// Row by row of a ball: IndexToFrame is upper triangular, so that z and y of the frame are the same all along a row.
void InterfaceGuard::ClearVoxelsNear(const Point<3>& p, BitMask<3>& voxels) const
{
  const GridGeometry<3>::Matrix& m = this->Image.Grid().IndexToFrame;
  const Index& n = voxels.Dimensions();
  Point<3> x = this->Image.Grid().ToIndex(p); // in the mask, which has a layer more than the crop
  for (std::size_t a = 0; a < 3; ++a)
  {
    x[a] -= static_cast<double>(this->Image.CropOrigin()[a] - 1);
  }
  // The places along an axis that are no farther than half a width from a centre; its square is rounded.
  const auto places = [&](std::size_t a, double centre, double half2)
  {
    const double half = std::sqrt(std::max(half2, 0.0)) / m[a][a];
    return std::pair{ std::max<std::int64_t>(
                        static_cast<std::int64_t>(std::ceil(centre - half)), 0),
      std::min(static_cast<std::int64_t>(std::floor(centre + half)), n[a] - 1) };
  };
  const double radius2 = this->NearVoxel * this->NearVoxel;
  const auto layers = places(2, x[2], radius2);
  for (std::int64_t k = layers.first; k <= layers.second; ++k)
  {
    const double dz = static_cast<double>(k) - x[2];
    const double left2 = radius2 - m[2][2] * dz * m[2][2] * dz;
    const auto rows = places(1, x[1] - m[1][2] * dz / m[1][1], left2);
    for (std::int64_t j = rows.first; j <= rows.second; ++j)
    {
      const double dy = static_cast<double>(j) - x[1];
      const double y = m[1][1] * dy + m[1][2] * dz;
      const auto [first, last] =
        places(0, x[0] - (m[0][1] * dy + m[0][2] * dz) / m[0][0], left2 - y * y);
      voxels.ClearRun({ first, j, k }, last);
    }
  }
}

//------------------------------------------------------------------------------------------------
InterfaceGuard::Interfaces::Interfaces(double reach, std::size_t expected,
  std::vector<Triangle> triangles, unsigned threads, const std::stop_token& stop)
  : Vertices({ 0.0, 0.0, 0.0 }, reach, expected)
  , Triangles(std::move(triangles), threads, stop)
{
}

/** No vertex is asked for that is farther than this. */
double InterfaceGuard::Reach() const
{
  const double delta =
    this->Sizes ? std::max(this->Base.Delta, this->Sizes->Largest()) : this->Base.Delta;
  return this->Base.Graded ? this->NearEnough
                           : std::max(LargestDistance * delta, this->VoxelDiagonal);
}

//------------------------------------------------------------------------------------------------
std::vector<InterfaceGuard::Face> InterfaceGuard::FilterFar(
  const std::vector<Face>& faces, const Interfaces& interfaces) const
{
  std::vector<Face> far;
  Hint hint;
  std::copy_if(faces.begin(), faces.end(), std::back_inserter(far),
    [&](const Face& face) { return this->IsFar(face, interfaces, hint); });
  return far;
}

//------------------------------------------------------------------------------------------------
// There may be few vertices, but the triangles between them must be near.
std::vector<InterfaceGuard::Face> InterfaceGuard::FindFarFaces(const SimplexMesh<3>& mesh) const
{
  const std::vector<Point<3>> vertices = VerticesOfInterfaces(mesh);
  Interfaces interfaces(
    this->Reach(), vertices.size(), TrianglesOf(mesh), this->Threads, this->Stop);
  for (const Point<3>& p : vertices)
  {
    interfaces.Vertices.Add(p);
  }
  const std::vector<Face> far = this->FilterFar(this->Sampled, interfaces);
  return far.empty() ? this->FindAllFar(interfaces, vertices) : far;
}

std::vector<InterfaceGuard::Face> InterfaceGuard::FindFarAgain(
  const std::vector<Point<3>>& gone, const Interfaces& interfaces) const
{
  std::vector<SearchBall> balls;
  for (const Point<3>& p : gone)
  {
    balls.push_back({ p, this->Reach() + 1e-6 * this->VoxelDiagonal }); // for rounding
  }
  const std::vector<Face> near = FindFacesNear(this->Image, this->Sites, balls, this->Stop);
  return this->FilterFar(UnionOf(this->Sampled, near), interfaces);
}

//------------------------------------------------------------------------------------------------
std::vector<InterfaceGuard::Face> InterfaceGuard::FindAllFar(
  const Interfaces& interfaces, const std::vector<Point<3>>& vertices) const
{
  constexpr std::size_t Grain = 1024;
  constexpr std::size_t RowsAtOnce = 64;
  constexpr std::int64_t VoxelsOfHint = 4;
  BitMask<3> voxels = this->Sites;
  if (this->NearVoxel > 0.0)
  {
    // Vertices may be much denser than delta asks for. What only the others are near to is tested below.
    const std::vector<Point<3>> some = ThinOut(vertices, ClearingDistance * this->NearVoxel);
    ParallelFor(
      0, some.size(), Grain, this->Threads,
      [&](std::size_t first, std::size_t last)
      {
        for (std::size_t i = first; i < last; ++i)
        {
          this->ClearVoxelsNear(some[i], voxels);
        }
      },
      this->Stop);
  }
  const std::size_t rows = voxels.NumberOfRows();
  const Index& n = voxels.Dimensions();
  std::vector<std::vector<Face>> found((rows - 1) / RowsAtOnce + 1);
  ParallelFor(
    0, rows, RowsAtOnce, this->Threads,
    [&](std::size_t first, std::size_t last)
    {
      std::vector<Hint> hints(static_cast<std::size_t>(n[0] / VoxelsOfHint + 1));
      for (std::size_t row = first; row < last; ++row)
      {
        const auto y = static_cast<std::int64_t>(row) % n[1] - 1;
        const auto z = static_cast<std::int64_t>(row) / n[1] - 1;
        const auto words = std::as_const(voxels).Row(row);
        for (std::size_t w = 0; w < words.size(); ++w)
        {
          for (std::uint64_t bits = words[w]; bits != 0; bits &= bits - 1)
          {
            const std::int64_t x = static_cast<std::int64_t>(64 * w) + std::countr_zero(bits);
            this->FindFarFacesOf({ x - 1, y, z }, interfaces,
              hints[static_cast<std::size_t>(x / VoxelsOfHint)], found[first / RowsAtOnce]);
          }
        }
      }
    },
    this->Stop);
  std::vector<Face> far;
  for (const auto& part : found)
  {
    far.insert(far.end(), part.begin(), part.end());
  }
  return far;
}

//------------------------------------------------------------------------------------------------
InterfaceGuard::Index InterfaceGuard::CellOf(const Face& face)
{
  Index cell = face.Voxel;
  for (std::int64_t& c : cell)
  {
    c = (c + 1) / LocalDelta<3>::Cell;
  }
  return cell;
}

/** Halved from visit to visit; the last is at the finest spacing, after it 0. */
double InterfaceGuard::SpacingAt(const Face& face, unsigned visit) const
{
  const double first = FirstSpacing * this->RemedyAt(face);
  const double spacing = std::ldexp(first, -static_cast<int>(visit));
  if (spacing >= this->FinestSpacing)
  {
    return spacing;
  }
  return 2.0 * spacing > this->FinestSpacing || visit == 0 ? this->FinestSpacing : 0.0;
}

//------------------------------------------------------------------------------------------------
// Points alone do not bring out what is thinner than they are apart: as long as no circumcentre lies in it, no
// element has its label. R1 with a smaller delta makes circumballs small enough.
void InterfaceGuard::LowerBound(const Face& face)
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
std::vector<FeatureSeed<3>> InterfaceGuard::InspectVertices(
  const InterfaceVertices::Changes& changes)
{
  const bool isFirst = !this->Known;
  if (isFirst)
  {
    this->Known.emplace(
      this->Reach(), changes.Added.size(), std::vector<Triangle>(), this->Threads, this->Stop);
  }
  for (const Point<3>& p : changes.Gone)
  {
    this->Known->Vertices.Remove(p);
  }
  for (const Point<3>& p : changes.Added)
  {
    this->Known->Vertices.Add(p);
  }
  return this->Propose(isFirst ? this->FindAllFar(*this->Known, changes.Added)
                               : this->FindFarAgain(changes.Gone, *this->Known),
    {});
}

//------------------------------------------------------------------------------------------------
std::vector<FeatureSeed<3>> InterfaceGuard::InspectLabels(
  const std::vector<Point<3>>& gone, const std::vector<Pinch>& pinches)
{
  std::vector<Point<3>> removed;
  std::copy_if(gone.begin(), gone.end(), std::back_inserter(removed),
    [&](const Point<3>& p) { return this->Known->Vertices.Remove(p); });
  const std::vector<Face> far = this->FindFarAgain(removed, *this->Known);
  for (const Point<3>& p : removed)
  {
    this->Known->Vertices.Add(p);
  }
  return this->ProposeIfBad(far, pinches);
}

//------------------------------------------------------------------------------------------------
std::vector<FeatureSeed<3>> InterfaceGuard::InspectMesh(
  const SimplexMesh<3>& mesh, const std::vector<Pinch>& pinches)
{
  return this->ProposeIfBad(this->FindFarFaces(mesh), pinches);
}

//------------------------------------------------------------------------------------------------
// At junctions there may be pinches; they are no reason to go on, but are sampled along with the rest.
std::vector<FeatureSeed<3>> InterfaceGuard::ProposeIfBad(
  const std::vector<Face>& far, const std::vector<Pinch>& pinches)
{
  const bool goOn = !far.empty() ||
    std::any_of(
      pinches.begin(), pinches.end(), [](const Pinch& pinch) { return !pinch.IsJunction; });
  return this->Propose(far, goOn ? pinches : std::vector<Pinch>());
}

//------------------------------------------------------------------------------------------------
std::vector<FeatureSeed<3>> InterfaceGuard::Propose(
  const std::vector<Face>& far, const std::vector<Pinch>& pinches)
{
  this->FarFaces = far.size();
  std::vector<SearchBall> balls;
  for (const Face& face : far)
  {
    balls.push_back({ this->CentreOf(face), RadiusAtFace * this->RemedyAt(face) });
  }
  for (const Pinch& pinch : pinches)
  {
    balls.push_back({ pinch.Middle, RadiusAtEdge * this->DensestAt(pinch.Middle) });
  }
  const std::vector<Face> faces = FindFacesNear(this->Image, this->Sites, balls, this->Stop);
  if (faces.empty())
  {
    return {};
  }
  this->Sampled = UnionOf(this->Sampled, faces);

  for (const Face& face : far)
  {
    this->LowerBound(face);
  }
  std::vector<FeatureSeed<3>> seeds;
  std::map<Index, double> spacings;
  for (const Face& face : faces)
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

} // namespace voxplex
