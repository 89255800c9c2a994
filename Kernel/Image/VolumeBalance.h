// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file VolumeBalance.h
 * @brief Internal to LabelField: moves smoothed interfaces so that labels keep their volumes.
 */
#ifndef voxplex_VolumeBalance_h
#define voxplex_VolumeBalance_h

#include <cstddef>
#include <vector>

namespace voxplex
{

/**
 * @brief What is to be subtracted from the smoothed samples of a label in space-time, so that its
 * volume is that of its voxels.
 *
 * Smoothing moves interfaces where they are curved, and where two of them are near: a sheet of 3 voxels
 * becomes 5 % too thick, and one of 2 voxels 13 %. Let V be the part of a voxel that the interpolated
 * samples give to the label, and I be 1 in voxels of the label, otherwise 0. The sum of V - I around
 * a sample is the volume that the label has too much there. Divided by the area of the interface
 * around the sample, it is the distance by which the interface is moved back. Both sums are weighted by
 * a Gaussian as wide as the smoothing.
 *
 * The arithmetic is on blocks of 8^4 samples. A result depends on the samples around it only, not on its
 * place in the block. Immutable after construction. Several threads may use one instance.
 */
class VolumeBalance
{
public:
  /** Memory for intermediate results. Each thread has its own, and reuses it in every call. */
  struct Buffers
  {
    std::vector<float> Excess;
    std::vector<float> Area;
    std::vector<float> Other;
  };

  /**
   * @param sigma standard deviation of the spread in voxels, positive
   * @param kernel weights of the smoothing: of the distances 0, 1, ... voxels
   */
  VolumeBalance(double sigma, const std::vector<double>& kernel);

  /** A result depends on this number of samples on each side, along each axis. */
  std::size_t Radius() const { return this->Spread.size(); }

  /**
   * @param margins the label's on a box of w = 8 + 2 Radius() samples along each axis, x fastest: half
   *   of its value minus the largest other one, -1 where it is far away, 1 where it is alone
   * @param shifts receives what is to be subtracted from the label's values at the 8^4 samples in the
   *   middle of the box
   */
  void Find(const float* margins, Buffers& buffers, float* shifts) const;

private:
  std::vector<float> Spread; ///< weights of the distances 0, 1, ...
  float Slope;               ///< of the samples across a plane interface, a voxel
  float PerFilling;          ///< a voxel is full if its mean sample is 1 / PerFilling
};

} // namespace voxplex

#endif
