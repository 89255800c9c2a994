// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ElementSizes.h
 * @brief Everything by which a user bounds the size of elements, as the kernel's SizeFunction.
 */
#ifndef voxplex_ElementSizes_h
#define voxplex_ElementSizes_h

#include "Image/ImageFrame.h"
#include "Image/SpaceTimeFrame.h"
#include "Sizing/SizeFunction.h"

#include "vtkSmartPointer.h"

#include <atomic>
#include <cstdint>
#include <exception>
#include <functional>
#include <limits>
#include <map>
#include <mutex>
#include <optional>
#include <type_traits>

class vtkDataArray;
class vtkImplicitFunction;

namespace voxplex
{

/** An image of sizes: linear between voxels, the nearest value outside. */
class SizeImage
{
public:
  /**
   * @param frame where the image lies
   * @param sizes one component per voxel of the frame's grid; kept, not copied
   */
  SizeImage(const ImageFrame& frame, vtkDataArray* sizes);

  /**
   * Size at a point of the world. Voxels whose value is NaN, zero or negative set no bound and are
   * left out of the interpolation; +infinity where none is left. Thread safe.
   */
  double At(const Point<3>& x) const;

  /** Whether a point of the world is in a voxel, or at most half a voxel away. */
  bool Covers(const Point<3>& x) const;

private:
  ImageFrame Frame;
  vtkSmartPointer<vtkDataArray> Sizes;
};

/** Throws InputError, with the bounds of both, if the image of sizes lies beside the image that is meshed. */
void CheckOverlap(const ImageFrame& sizes, const ImageFrame& image);

/** How the images lie that a D-dimensional mesh is made from. */
template <int D>
using FrameOf = std::conditional_t<D == 3, ImageFrame, SpaceTimeFrame>;

/**
 * @brief The smallest of all sizes that are given.
 *
 * In 4D the image of sizes and the implicit function are those of space and apply at all times.
 *
 * Set the members before meshing; Evaluate() is then safe to call from any thread. Implicit
 * functions are called by one thread at a time, because VTK's are not thread safe in general (they
 * evaluate their transform into members).
 */
template <int D>
class ElementSizes : public SizeFunction<D>
{
public:
  /** x: D physical coordinates, in 4D the last is the time. */
  using Callable = std::function<double(const double* x, long long label)>;

  double Uniform = 0.0; ///< 0: none
  std::map<std::int64_t, double> PerLabel;
  std::optional<SizeImage> Image;
  vtkSmartPointer<vtkImplicitFunction> Implicit;
  Callable Function;
  FrameOf<D> Frame; ///< of the label image

  /** Whether anything is given at all. */
  bool Any() const;

  double Evaluate(const Point<D>& p, std::int64_t label) const override;
  bool DependsOnLabelAlone() const override
  {
    return !this->Image && !this->Implicit && !this->Function;
  }

  /** Whether Function has thrown; sizes are then of no use and meshing should stop. */
  bool Failed() const { return this->HasFailed.load(std::memory_order_acquire); }
  /** Throws what Function has thrown first, if anything. */
  void Rethrow() const;

private:
  double Call(const Point<D>& x, std::int64_t label) const;

  mutable std::mutex ImplicitMutex;
  mutable std::mutex FailureMutex;
  mutable std::exception_ptr Failure;
  mutable std::atomic<bool> HasFailed{ false };
};

extern template class ElementSizes<3>;
extern template class ElementSizes<4>;

} // namespace voxplex

#endif
