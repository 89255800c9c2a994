// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshSizeEstimate.h
 * @brief Estimates the size of a mesh before it is made.
 */
#ifndef voxplex_MeshSizeEstimate_h
#define voxplex_MeshSizeEstimate_h

#include "Image/LabelImage.h"
#include "Sizing/SizeFunction.h"

#include <cstdint>
#include <limits>
#include <stop_token>

namespace voxplex
{

struct MeshSizeEstimate
{
  std::uint64_t Elements = 0; ///< of the final mesh
  std::uint64_t Vertices = 0; ///< of the triangulation, including those outside of the object
  std::uint64_t InterfaceVertices = 0;
  std::uint64_t InterfaceElements = 0; ///< the part of Elements that grows with 1 / delta^(D-1)
  bool SizesBelowFloor = false;        ///< some sampled size had to be raised
  double SmallestSize = std::numeric_limits<double>::infinity(); ///< of the sampled sizes
  std::uint64_t Bytes = 0; ///< memory of the run at its peak, without the image
};

/**
 * Estimates the size of a mesh to about a factor of two. The estimate is far too low for layers
 * thinner than delta, because these are refined far below delta. A size function is sampled at
 * about ten thousand voxels. Cost: one pass over the image's bounding box. The result does not
 * depend on the number of threads.
 *
 * @param sizeFloor sizes below this are raised to it
 * @param size may be null
 * @param threads 0 means all cores
 * @throws Cancelled if a stop was requested before the end
 */
template <int D>
MeshSizeEstimate EstimateMeshSize(const LabelImage<D>& image, double delta, double sizeFloor,
  const SizeFunction<D>* size, unsigned threads, const std::stop_token& stop = {});

/**
 * @param limit the allowed number of bytes; 0 means the machine's physical memory
 * @throws TooLargeError with the estimate in its message
 */
void CheckMemory(const MeshSizeEstimate& estimate, std::uint64_t limit);

} // namespace voxplex

#endif
