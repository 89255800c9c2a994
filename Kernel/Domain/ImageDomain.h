// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ImageDomain.h
 * @brief An image as the rules see it: labels, distances to interfaces, points on interfaces.
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
 * Labels come from a field: the LabelField of a label image, or the ScalarField of an isosurface. What is
 * said here holds for any field that keeps the labels of the label image at voxel centres and that
 * interpolates multilinearly between them. Distances come from the feature transform of the surface
 * voxels (the sites): those of the crop and of the layer of background around it that have a face
 * neighbour with another label. Every interface point lies in a cell between voxel centres of which
 * two corners that share an edge are sites; and next to every site, on a grid edge, there is an
 * interface point. Distance bounds follow from these two facts and are rigorous. The nearest site
 * is stored for cells of about CoarseCell smallest voxel spacings only.
 *
 * cfp (thesis, 3.1): march along the ray through the nearest site and find the root of the
 * label's margin by regula falsi, starting from the site's end; the ray ends at a voxel centre of
 * another label, which the field preserves, so it always crosses an interface.
 *
 * Where a 3D image cuts the object, points found closer to a cut face than the search is exact are moved onto it,
 * so that faces of the mesh are flat there.
 *
 * Immutable after construction: all methods are const and safe to call from any thread.
 */
template <int D, typename FieldType = LabelField<D>>
class ImageDomain final : public Domain<D>
{
public:
  using Index = typename GridGeometry<D>::Index;

  /** Edge of a cell of the feature transform in smallest voxel spacings, about. */
  static constexpr double CoarseCell = 4.0;

  /**
   * @param image the labels; must live as long as this
   * @param sigma smoothing in voxels, see LabelField
   * @param threads threads used for the construction; 0 means all cores. The result does not
   *   depend on it.
   * @param stop ends the construction early; the default never does
   * @throws InputError if sigma is out of range or the image too large; Cancelled if stopped;
   *   std::bad_alloc
   */
  ImageDomain(const LabelImage<D>& image, double sigma, unsigned threads = 1,
    const std::stop_token& stop = {}) requires std::same_as<FieldType, LabelField<D>>;
  /** The domain does not keep the image alive. */
  ImageDomain(LabelImage<D>&&, double, unsigned = 1, const std::stop_token& = {}) = delete;

  /** The same for the inside of an isosurface: label id 1. */
  explicit ImageDomain(const IsosurfaceImage<D>& image, unsigned threads = 1,
    const std::stop_token& stop = {}) requires std::same_as<FieldType, ScalarField<D>>;
  explicit ImageDomain(IsosurfaceImage<D>&&, unsigned = 1, const std::stop_token& = {}) = delete;

  /**
   * The box of the crop and the layer of background around it; interfaces lie strictly inside, but at
   * flat ends, where the box ends with the image's first or last frame.
   */
  Box<D> Bounds() const override { return this->BoundingBox; }
  bool IsFlatEnd(unsigned end) const override { return this->Image.IsCutInTime(end); }
  LabelId Label(const Point<D>& p) const override { return this->Field.Label(p); }
  std::int64_t LabelValue(LabelId id) const override { return this->Image.Values()[id]; }
  DistanceInterval DistanceBounds(const Point<D>& p) const override
  {
    return this->DistanceBoundsAt(this->Field.ToLattice(p));
  }
  /** Where the margin of `label` is below 0.1 on the ray to the nearest site. */
  bool NearSurfacePoint(
    const Point<D>& p, LabelId label, Point<D>& z, double& error) const override;
  /**
   * The point found lies on an interface of `label` to FieldType::RootTolerance voxels (0.005, or 0.001 for isosurfaces)
   * and is on average a few hundredths of a voxel farther from p than the nearest one. Outside of the lattice it is near
   * the voxel nearest to the lattice's nearest point, not to p. False only if p does not have `label`.
   */
  bool ClosestSurfacePoint(const Point<D>& p, LabelId label, Point<D>& z) const override;
  /** Steps of half a voxel, longer ones where the distance bounds allow it. */
  bool FirstCrossing(
    const Point<D>& a, LabelId labelOfA, const Point<D>& b, Point<D>& z) const override;

  bool IsCut() const override { return this->Field.Cuts().Exist(); }
  unsigned CutFaces(const Point<D>& p) const override
  {
    return this->Field.Cuts().Exist() ? this->Field.Cuts().Near(this->Field.ToLattice(p), OnCutFace)
                                      : 0u;
  }
  bool IsBeyondCutFaces(const Point<D>& p) const override
  {
    return this->Field.Cuts().Exist() &&
      this->Field.Cuts().Distance(this->Field.ToLattice(p)) < 0.0;
  }
  bool IsWithinCutFaces(const Point<D>& p) const override
  {
    return !this->Field.Cuts().Exist() ||
      this->Field.Cuts().Distance(this->Field.ToLattice(p)) >= -OnCutFace;
  }
  Point<D> MoveOntoCutFaces(const Point<D>& p, unsigned faces) const override
  {
    return faces == 0
      ? p
      : this->Field.ToFrame(this->Field.Cuts().MoveOnto(this->Field.ToLattice(p), faces));
  }

  bool NearCutEdge(const Point<D>& p, double reach, Point<D>& z) const override;

  /** Along the gradient of the label's margin in the frame of time, in steps of half a voxel. */
  bool ClosestSurfacePointOnEnd(const Point<D>& p, Point<D>& z) const override;

  const LabelImage<D>& GetImage() const { return this->Image; }
  const FieldType& GetLabelField() const { return this->Field; }
  /** Of the lattice of GetLabelField(). */
  const FeatureTransform<D>& GetFeatureTransform() const { return this->Features; }
  /** The sites, on the lattice of GetLabelField(). */
  const BitMask<D>& GetSites() const { return this->Sites; }

  /** Wall-clock seconds spent in the constructor on the label field. */
  double LabelFieldSeconds() const { return this->FieldSeconds; }
  /** Wall-clock seconds spent in the constructor on sites and feature transform. */
  double DistanceSeconds() const { return this->FeatureSeconds; }
  /** Memory held, without the image, bytes. */
  std::size_t MemoryBytes() const
  {
    return this->Field.MemoryBytes() + this->Features.MemoryBytes() + this->Sites.MemoryBytes();
  }

private:
  /** A field, and the seconds that it took to make it. */
  struct TimedField
  {
    FieldType Field;
    double Seconds;
  };
  template <typename Function>
  static TimedField MakeField(Function&& make);
  ImageDomain(
    const LabelImage<D>& image, TimedField&& field, unsigned threads, const std::stop_token& stop);

  /** Dense id of a voxel at a lattice index; background outside of the crop, but for flat ends. */
  LabelId VoxelId(const Index& lattice) const;
  /** The point nearest to p that is not beyond a flat end. */
  Point<D> ClampToEnds(Point<D> p) const
  {
    if constexpr (D == 4)
    {
      p[3] = this->Image.IsCutInTime(0) ? std::max(p[3], this->BoundingBox.Min[3]) : p[3];
      p[3] = this->Image.IsCutInTime(1) ? std::min(p[3], this->BoundingBox.Max[3]) : p[3];
    }
    return p;
  }
  /** A point closer than this to a cut face has been found on it, voxels; one on it up to rounding is closer. */
  static constexpr double NearCutFace = 2.0 * FieldType::RootTolerance;
  static constexpr double OnCutFace = 1e-6;
  /** The frame's coordinates of a point that a search has found, not beyond a flat end. */
  Point<D> Found(const Point<D>& x) const
  {
    const unsigned faces = this->Field.Cuts().Near(x, NearCutFace);
    return this->ClampToEnds(
      this->Field.ToFrame(faces == 0 ? x : this->Field.Cuts().MoveOnto(x, faces)));
  }
  DistanceInterval DistanceBoundsAt(const Point<D>& x) const;
  /** Squared length in the frame of a step in lattice coordinates. */
  double Length2(const Point<D>& step) const;
  /** A site near x, close to the nearest one. */
  bool NearSite(const Point<D>& x, Index& site) const;
  /** A voxel near x with another label, next to a site near x. */
  bool NearVoxelOfOtherLabel(const Point<D>& x, LabelId label, Index& voxel) const;
  /** A point x + t d of a line, and by how much a label wins there. */
  struct Probe
  {
    double T;
    double Margin;
  };
  Probe ProbeAt(const Point<D>& x, const Point<D>& d, LabelId label, double t) const;
  /**
   * The root of the label's margin on x + t d between `inside` (margin > 0) and `outside`, to
   * `tolerance` voxels.
   */
  double FindRoot(const Point<D>& x, const Point<D>& d, LabelId label, Probe inside, Probe outside,
    double tolerance) const;
  /**
   * The root of the label's margin on the ray from a voxel near x with another label,
   * n + t (x - n).
   */
  bool FindOnRay(const Point<D>& x, LabelId label, double tolerance, Point<D>& n, double& t) const;

  /** Replaces z by the interface point straight below p on the tangent plane at z, if that is
   * nearer. */
  bool MoveTowardsFoot(const Point<D>& p, const Point<D>& x, LabelId label, Point<D>& z) const;

  const LabelImage<D>& Image;
  double FieldSeconds = 0.0;
  double FeatureSeconds = 0.0;
  FieldType Field;
  BitMask<D> Sites;
  Point<D> Spacing;
  FeatureTransform<D> Features;
  bool IsOrthogonal;
  double SmallestStretch = 1.0; ///< of lengths, from orthogonal axes to the real ones
  double LargestStretch = 1.0;
  double LowerSlack; ///< from an interface point to the nearest site, at most
  double UpperSlack; ///< from a site to an interface point, at most
  double VoxelDiagonal;
  Box<D> BoundingBox;
};

extern template class ImageDomain<3>;
extern template class ImageDomain<4>;
extern template class ImageDomain<3, ScalarField<3>>;
extern template class ImageDomain<4, ScalarField<4>>;

} // namespace voxplex

#endif
