// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ImageDomain.h
 * @brief An image as the refinement rules see it: labels, distances to interfaces, points on
 *   interfaces.
 */
#ifndef voxplex_ImageDomain_h
#define voxplex_ImageDomain_h

#include "Domain/Domain.h"
#include "Domain/LabelField.h"
#include "Domain/ScalarField.h"
#include "Image/BitMask.h"
#include "Image/FeatureTransform.h"

#include <algorithm>
#include <concepts>
#include <stop_token>

namespace voxplex
{

/**
 * @brief The domain of an image.
 *
 * Labels come from a field: the LabelField of a label image, or the ScalarField of an isosurface.
 * The algorithms hold for any field that keeps the labels of the image at voxel centres and
 * interpolates multilinearly between them.
 *
 * Distances come from the feature transform of the surface voxels (the sites). A site is a voxel of
 * the crop, or of the layer of background around it, that has a face neighbour with another label.
 * Two facts give rigorous distance bounds. First, every interface point lies in a cell between
 * voxel centres, and one edge of this cell joins two sites. Second, next to every site there is an
 * interface point on a grid edge. The nearest site is stored only for cells with edges of about
 * CoarseCell smallest voxel spacings.
 *
 * cfp (thesis, 3.1): march along the ray through the nearest site, from the site's end, and find
 * the root of the label's margin by regula falsi. The ray ends at a voxel centre of another label.
 * The field keeps that label, so the ray always crosses an interface.
 *
 * Where a 3D image cuts the object, a point that is closer to a cut face than the tolerance of the
 * search is moved onto the face, so that the mesh is flat there.
 *
 * Immutable after construction: all methods are const and safe to call from any thread.
 */
template <int D, typename FieldType = LabelField<D>>
class ImageDomain final
  : public Domain<D>
  , private ImageBorder<D>
{
public:
  using Index = typename GridGeometry<D>::Index;
  using typename Domain<D>::Search;

  /** Approximate edge of a cell of the feature transform, in smallest voxel spacings. */
  static constexpr double CoarseCell = 4.0;

  /**
   * @param image the labels; must live as long as this domain
   * @param sigma smoothing in voxels, see LabelField
   * @param threads threads used for the construction; 0 means all cores. The result does not depend
   *   on it.
   * @param stop ends the construction early; the default never does
   * @throws InputError if sigma is out of range or the image too large; Cancelled if stopped;
   *   std::bad_alloc
   */
  ImageDomain(const LabelImage<D>& image, double sigma, unsigned threads = 1,
    const std::stop_token& stop = {}) requires std::same_as<FieldType, LabelField<D>>;
  /** Deleted: the domain does not keep the image alive. */
  ImageDomain(LabelImage<D>&&, double, unsigned = 1, const std::stop_token& = {}) = delete;

  /** The same for an isosurface; its inside has label id 1. */
  explicit ImageDomain(const IsosurfaceImage<D>& image, unsigned threads = 1,
    const std::stop_token& stop = {}) requires std::same_as<FieldType, ScalarField<D>>;
  explicit ImageDomain(IsosurfaceImage<D>&&, unsigned = 1, const std::stop_token& = {}) = delete;

  /**
   * The box of the crop and the layer of background around it. Interfaces lie strictly inside. At a
   * flat end the box ends with the image's first or last frame, and interfaces reach its face.
   */
  Box<D> Bounds() const override { return this->BoundingBox; }
  bool HasTimeBorder(unsigned end) const override { return this->Image.ReachesBorderInTime(end); }
  LabelId Label(const Point<D>& p) const override { return this->Field.Label(p); }
  std::int64_t LabelValue(LabelId id) const override { return this->Image.Values()[id]; }
  double DistanceBound(const Point<D>& p) const override
  {
    return this->DistanceBoundAt(this->Field.ToLattice(p));
  }
  /** A point on the ray to the nearest site where the margin of `label` is below 0.1. */
  bool NearSurfacePoint(const Point<D>& p, LabelId label, Point<D>& z, double& error) const override
  {
    Search search;
    return this->StartSearch(p, label, z, error, search);
  }
  bool StartSearch(
    const Point<D>& p, LabelId label, Point<D>& z, double& error, Search& search) const override;
  /**
   * The point lies on an interface of `label`, to FieldType::RootTolerance voxels (0.005, or 0.001
   * for isosurfaces), or where the margin is smaller than that. On average it
   * is a few hundredths of a voxel farther from p than the nearest interface point. If p is outside
   * of the lattice, the point is near the voxel nearest to the projection of p onto the lattice. The
   * search fails only if p does not have `label`.
   */
  bool ClosestSurfacePoint(const Point<D>& p, LabelId label, Point<D>& z) const override
  {
    return this->FinishSearch({}, p, label, z);
  }
  bool FinishSearch(
    const Search& search, const Point<D>& p, LabelId label, Point<D>& z) const override;
  /** The steps are half a voxel, or longer where the distance bounds allow it. */
  bool FirstCrossing(
    const Point<D>& a, LabelId labelOfA, const Point<D>& b, Point<D>& z) const override;

  const ImageBorder<D>* Border() const override
  {
    return this->Field.Borders().Exist() ? this : nullptr;
  }

  /**
   * Searches at constant time along the gradient of the label's margin, in steps of half a voxel.
   */
  bool ClosestSurfacePointOnEnd(const Point<D>& p, Point<D>& z) const override;

  const LabelImage<D>& GetImage() const { return this->Image; }
  const FieldType& GetLabelField() const { return this->Field; }
  /** Feature transform of the sites, on the lattice of GetLabelField(). */
  const FeatureTransform<D>& GetFeatureTransform() const { return this->Features; }
  /** The sites, on the lattice of GetLabelField(). */
  const BitMask<D>& GetSites() const { return this->Sites; }

  /** Wall-clock seconds that the constructor spent on the label field. */
  double LabelFieldSeconds() const { return this->FieldSeconds; }
  /** Wall-clock seconds that the constructor spent on sites and feature transform. */
  double DistanceSeconds() const { return this->FeatureSeconds; }
  /** Memory held in bytes, without the image. */
  std::size_t MemoryBytes() const
  {
    return this->Field.MemoryBytes() + this->Features.MemoryBytes() + this->Sites.MemoryBytes();
  }

private:
  unsigned FacesAt(const Point<D>& p) const override
  {
    return this->Field.Borders().Near(this->Field.ToLattice(p), OnBorder);
  }
  bool IsBeyond(const Point<D>& p) const override
  {
    return this->Field.Borders().Distance(this->Field.ToLattice(p)) < 0.0;
  }
  bool IsWithin(const Point<D>& p) const override
  {
    return this->Field.Borders().Distance(this->Field.ToLattice(p)) >= -OnBorder;
  }
  Point<D> MoveOnto(const Point<D>& p, unsigned faces) const override
  {
    return faces == 0
      ? p
      : this->Field.ToFrame(this->Field.Borders().MoveOnto(this->Field.ToLattice(p), faces));
  }
  bool FindEdge(const Point<D>& p, double reach, Point<D>& z) const override;

  /** A field, and the seconds that its construction took. */
  struct TimedField
  {
    FieldType Field;
    double Seconds;
  };
  template <typename Function>
  static TimedField MakeField(Function&& make);
  ImageDomain(
    const LabelImage<D>& image, TimedField&& field, unsigned threads, const std::stop_token& stop);

  /**
   * Dense id of the voxel at a lattice index. Outside of the crop it is background, except beyond
   * flat ends.
   */
  LabelId VoxelId(const Index& lattice) const;
  /** p, or its projection onto the flat end if it lies beyond one. */
  Point<D> ClampToEnds(Point<D> p) const
  {
    if constexpr (D == 4)
    {
      p[3] = this->Image.ReachesBorderInTime(0) ? std::max(p[3], this->BoundingBox.Min[3]) : p[3];
      p[3] = this->Image.ReachesBorderInTime(1) ? std::min(p[3], this->BoundingBox.Max[3]) : p[3];
    }
    return p;
  }
  /**
   * In voxels. A search found a point on a cut face if it is closer than NearBorder. OnBorder
   * allows for rounding.
   */
  static constexpr double NearBorder = 2.0 * FieldType::RootTolerance;
  static constexpr double OnBorder = 1e-6;
  /**
   * The frame's coordinates of a point that a search has found, moved onto cut faces and flat ends.
   */
  Point<D> Found(const Point<D>& x) const
  {
    const unsigned faces = this->Field.Borders().Near(x, NearBorder);
    return this->ClampToEnds(
      this->Field.ToFrame(faces == 0 ? x : this->Field.Borders().MoveOnto(x, faces)));
  }
  double DistanceBoundAt(const Point<D>& x) const;
  /** Squared length in the frame of a step in lattice coordinates. */
  double Length2(const Point<D>& step) const;
  /** The site nearest to x, or one that is about as near. */
  bool NearSite(const Point<D>& x, Index& site) const;
  /** A voxel with another label: the site near x, or a face neighbour of it. */
  bool NearVoxelOfOtherLabel(const Point<D>& x, LabelId label, Index& voxel) const;
  /** A point x + t d of a line, and the margin of a label there. */
  using Probe = decltype(Search::Outside);
  Probe ProbeAt(const Point<D>& x, const Point<D>& d, LabelId label, double t) const;
  /**
   * The root t of the label's margin on x + t d between `inside` (margin > 0) and `outside`, to
   * `tolerance` voxels.
   */
  double FindRoot(const Point<D>& x, const Point<D>& d, LabelId label, Probe inside, Probe outside,
    double tolerance) const;
  /**
   * Finds a line from the centre of a voxel near x with another label to x, and a part of it where
   * the margin of the label changes its sign.
   */
  bool FindLine(const Point<D>& x, LabelId label, Search& search) const;

  /**
   * Looks for an interface point on the line from p to its foot point on the tangent plane at z. If
   * that point is nearer than z, it replaces z.
   */
  bool MoveTowardsFoot(const Point<D>& p, const Point<D>& x, LabelId label, Point<D>& z) const;

  const LabelImage<D>& Image;
  double FieldSeconds = 0.0;
  double FeatureSeconds = 0.0;
  FieldType Field;
  BitMask<D> Sites;
  Point<D> Spacing;
  FeatureTransform<D> Features;
  bool IsOrthogonal;
  double SmallestStretch = 1.0; ///< least factor from lengths on orthogonal axes to real ones
  double SiteDistance;          ///< largest distance from an interface point to the nearest site
  double VoxelDiagonal;
  Box<D> BoundingBox;
};

extern template class ImageDomain<3>;
extern template class ImageDomain<4>;
extern template class ImageDomain<3, ScalarField<3>>;
extern template class ImageDomain<4, ScalarField<4>>;

} // namespace voxplex

#endif
