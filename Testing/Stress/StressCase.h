// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file StressCase.h
 * @brief One image and its meshing options, made from a seed and a number.
 */
#ifndef voxplex_stress_StressCase_h
#define voxplex_stress_StressCase_h

#include "Mesher/MeshingOptions.h"
#include "Random.h"
#include "Volume.h"

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace voxplex::stress
{

/** The kind of image. */
enum class Family
{
  Space,     ///< label images in 3D
  SpaceTime, ///< label images in 4D, and some grey-value images
  Isosurface ///< grey-value images, mostly in 3D
};

/** The name on the command line: 3, 4, iso. */
std::string_view NameOf(Family family);

/** The same numbers give the same case, on any machine. */
struct CaseId
{
  Family Kind = Family::Space;
  std::uint64_t Seed = 0;
  std::uint64_t Number = 0;
};

/** A bound of circumradii, which depends on the label and grows along the first axis. */
struct SizeRequest
{
  double Everywhere = 0.0; ///< 0: none
  std::int32_t Label = 0;  ///< the label with a size of its own, or 0
  double OfLabel = 0.0;
  double Slope = 0.0; ///< growth per unit of length along the first axis

  bool IsGiven() const { return this->Everywhere > 0.0 || this->OfLabel > 0.0; }
  /** The bound at a point; infinite if there is none. */
  double At(double x, std::int64_t label) const;
};

template <int D>
struct StressCase
{
  CaseId Id;
  std::string Kind; ///< kind of the image, and after commas what else the case has
  Volume<D> Image;
  MeshingOptions<D> Options; ///< except Options.Size
  SizeRequest Size;
  /** Mesh a second time and compare bit for bit; if reproducible, with another number of threads. */
  bool Twice = false;

  ///@{
  /** Measures of the image's voxels; Measure() sets them. */
  double InterfaceArea = 0.0; ///< area of the faces between different labels
  double ObjectVolume = 0.0;
  ///@}
  void Measure();

  /** The delta that is used. */
  double Delta() const;
  /**
   * Approximate number of elements, from the image and the options only. In 3D, thin parts are
   * sampled at the scale of voxels for every delta; in 4D, no part is taken as thin.
   */
  double ExpectedElements() const;
  /** The same if all parts are thin. Time limits depend on it. */
  double ExpectedElementsIfThin() const;

  /** The options with the size function. */
  MeshingOptions<D> AllOptions() const;

private:
  double ExpectedElements(bool isThin) const;
};

/** Whether a case of a family has four dimensions. */
bool IsSpaceTime(const CaseId& id);

/** The dimension, according to IsSpaceTime(). */
template <int D>
StressCase<D> MakeCase(const CaseId& id);

/** Describes in words the image and the options that differ from the defaults. */
template <int D>
std::string Describe(const StressCase<D>& of);

/**
 * The command line of the program voxplex that makes the same mesh, or almost the same.
 * @param file path of the image
 * @param missing receives the options for which the program has no flag
 */
template <int D>
std::string ShellCommand(
  const StressCase<D>& of, const std::string& file, std::vector<std::string>& missing);

/** Draws options; the image must be complete and measured. */
template <int D>
void DrawOptions(StressCase<D>& of, Random& random);

/**
 * Draws time planes, and changes other options so that most planes are possible: there may be a smaller delta, and a longer
 * step in time. All other options must have been drawn, and whether the mesh is periodic.
 */
void DrawTimePlanes(StressCase<4>& of, Random& random);

} // namespace voxplex::stress

#endif
