// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshSizeEstimate.h
 * @brief How large a mesh will be, before it is made.
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
  std::uint64_t Vertices = 0; ///< of the triangulation, those outside of the object included
  std::uint64_t InterfaceVertices = 0;
  std::uint64_t InterfaceElements = 0; ///< of Elements those that grow with 1 / delta^(D-1)
  bool SizesBelowFloor = false;        ///< some sampled size had to be raised
  double SmallestSize = std::numeric_limits<double>::infinity(); ///< of those sampled
  std::uint64_t Bytes = 0; ///< memory of the run at its peak, without the image
};

/**
 * Right to about a factor of two; far too low for layers thinner than delta, which are refined far below it. A size
 * function is sampled at some ten thousand voxels.
 * Cost: one pass over the image's bounding box. The result does not depend on the number of threads.
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
 * @param limit bytes that may be used; 0 means the machine's physical memory
 * @throws TooLargeError with the estimate in its message
 */
void CheckMemory(const MeshSizeEstimate& estimate, std::uint64_t limit);

} // namespace voxplex

#endif
