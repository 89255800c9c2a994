// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file StressCase.h
 * @brief One image and what is asked of it, made from a seed and a number.
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

/** What is meshed. */
enum class Family
{
  Space,     ///< label images in 3D
  SpaceTime, ///< label images in 4D
  Isosurface ///< grey-value images, in 3D mostly
};

/** As users write them: 3, 4, iso. */
std::string_view NameOf(Family family);

/** The same numbers give the same case, on any machine. */
struct CaseId
{
  Family Kind = Family::Space;
  std::uint64_t Seed = 0;
  std::uint64_t Number = 0;
};

/** A bound of circumradii: by label, and growing along the first axis. */
struct SizeRequest
{
  double Everywhere = 0.0; ///< 0: none
  std::int32_t Label = 0;  ///< that has a size of its own, or 0
  double OfLabel = 0.0;
  double Slope = 0.0; ///< over a unit of length along the first axis

  bool IsGiven() const { return this->Everywhere > 0.0 || this->OfLabel > 0.0; }
  /** Infinite where there is no bound. */
  double At(double x, std::int64_t label) const;
};

template <int D>
struct StressCase
{
  CaseId Id;
  std::string Kind; ///< of the image
  Volume<D> Image;
  MeshingOptions<D> Options; ///< but for Options.Size
  SizeRequest Size;
  bool Twice = false; ///< meshed a second time, to compare bit for bit

  ///@{
  /** Of the image's voxels; Measure() sets them. */
  double InterfaceArea = 0.0; ///< of the faces between different labels
  double ObjectVolume = 0.0;
  ///@}
  void Measure();

  /** The delta that is used. */
  double Delta() const;
  /** About how many elements there will be, by the image and the options alone; limits of time are made of it. */
  double ExpectedElements() const;

  /** The options with the size function. */
  MeshingOptions<D> AllOptions() const;
};

/** Whether a case of a family has four dimensions. */
bool IsSpaceTime(const CaseId& id);

/** D as IsSpaceTime() says. */
template <int D>
StressCase<D> MakeCase(const CaseId& id);

/** In words: the image, and the options that differ from the defaults. */
template <int D>
std::string Describe(const StressCase<D>& of);

/**
 * The call of the program voxplex that makes the same mesh, or almost.
 * @param file the image's
 * @param missing receives what the program has no flag for
 */
template <int D>
std::string ShellCommand(
  const StressCase<D>& of, const std::string& file, std::vector<std::string>& missing);

/** Draws options; the image must be complete and measured. */
template <int D>
void DrawOptions(StressCase<D>& of, Random& random);

} // namespace voxplex::stress

#endif
