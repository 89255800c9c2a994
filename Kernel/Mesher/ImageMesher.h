// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ImageMesher.h
 * @brief The entry point of the kernel: makes a simplex mesh of a label image or an isosurface.
 */
#ifndef voxplex_ImageMesher_h
#define voxplex_ImageMesher_h

#include "Image/IsosurfaceImage.h"
#include "Image/LabelImage.h"
#include "Mesh/SimplexMesh.h"
#include "Mesher/MeshingOptions.h"
#include "Mesher/MeshingStatistics.h"

#include <functional>
#include <stop_token>
#include <utility>

namespace voxplex
{

class RunProgress;

/** How a run ended. Errors are exceptions (Error.h). */
enum class MeshingOutcome
{
  Done,
  Cancelled ///< the progress callback returned false; the mesh is empty
};

/**
 * @brief Meshes one label image, or the inside of an isosurface.
 *
 * Arrays and a grid go in, as LabelImage or IsosurfaceImage, with options; arrays (SimplexMesh) and a
 * record of the run (MeshingStatistics) come out, in the frame of the grid (GridGeometry).
 *
 * Run() may be called repeatedly. Distinct instances may run at the same time in one process. With
 * one thread, or with TeamOptions::Reproducible, the mesh is bit-for-bit reproducible.
 */
template <int D>
class ImageMesher
{
public:
  explicit ImageMesher(MeshingOptions<D> options)
    : Options(std::move(options))
  {
  }

  /**
   * Called from the thread that called Run(), at least ten times a second, with the fraction done
   * (0 to 1, never decreasing). If it returns false, the run is cancelled. If it throws, Run()
   * throws the same exception.
   */
  std::function<bool(double fraction)> Progress;

  /**
   * Removes noise, makes the mesh, and measures what the statistics say of it.
   * @param image the label image; to be moved here, unless the caller needs it afterwards
   * @param mesh receives the mesh; empty when cancelled
   * @throws InputError, also if no delta gives the requested number of elements; TooLargeError;
   *   std::bad_alloc
   */
  MeshingOutcome Run(LabelImage<D> image, SimplexMesh<D>& mesh);
  /** As above, for the inside of an isosurface of a grey-value image. */
  MeshingOutcome Run(IsosurfaceImage<D> image, SimplexMesh<D>& mesh);

  const MeshingStatistics& Statistics() const { return this->Stats; }

private:
  /** @param isosurface the isosurface whose labels `image` has, or null */
  MeshingOutcome Run(
    LabelImage<D>& image, const IsosurfaceImage<D>* isosurface, SimplexMesh<D>& mesh);
  void Measure(const LabelImage<D>& image, const SimplexMesh<D>& mesh);
  bool RunReporting(
    const std::function<bool()>& run, const RunProgress& progress, std::stop_source& stop);

  MeshingOptions<D> Options;
  MeshingStatistics Stats;
};

extern template class ImageMesher<3>;
extern template class ImageMesher<4>;

} // namespace voxplex

#endif
