// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LabelSmoothing.h
 * @brief Internal to LabelField: computes smoothed samples from indicators of labels.
 *
 * The functions work on blocks of 8^D samples, and are independent of images and tiles. A sample is
 * a 16-bit fixed-point number in which 2^14 is 1. Arrays belong to the caller. They may have any
 * alignment that their type permits, and must not overlap. The results are bitwise the same for all
 * vector instruction sets.
 */
#ifndef voxplex_LabelSmoothing_h
#define voxplex_LabelSmoothing_h

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace voxplex
{

/**
 * The 1D kernel (1 + c) g - c g*g, as weights of the distances 0, 1, ... 4 sigma in voxels. Over
 * both sides the weights add up to 1. If sigma is 0, the result is {1}.
 * @param secondMoment second moment of the kernel in sigma^2; c is chosen accordingly. With 0, the
 *   kernel does not change parabolas.
 */
std::vector<double> NonShrinkingKernel(double sigma, double secondMoment);

/**
 * @brief The separable kernel (1 + c) g - c g*g of LabelField, applied to indicators.
 *
 * The weights are multiples of 2^-14, and add up to 1 exactly. So if all indicators are equal, the
 * result is exactly +1 or -1.
 *
 * Immutable after construction. Several threads may use one instance.
 */
class LabelSmoothing
{
public:
  /**
   * The contents of a vector register. By its alignment it never crosses a cache line (crossing
   * cost 8 % for sigma 2).
   */
  struct alignas(32) EightFloats
  {
    std::array<float, 8> Values;
  };
  /** Memory for intermediate results. Each thread has its own, and reuses it in every call. */
  using Buffers = std::array<std::vector<EightFloats>, 2>;

  /**
   * @param dimension D, 3 or 4
   * @param sigma standard deviation in voxels, 0 (none) to 5
   */
  LabelSmoothing(int dimension, double sigma);

  /** The 1D kernel: weights of the distances 0, 1, ... Radius(), in units that add up to 1. */
  std::vector<double> Kernel() const;

  /** A sample depends on this number of voxels on each side, along each axis: ceil(4 sigma). */
  std::size_t Radius() const { return this->Weights.size() - 1; }

  /**
   * Smooths the indicator of one label.
   * @param words the indicator on a box of w = 8 + 2 Radius() voxels along each axis. There are
   *   w^(D - 1) rows along x, the second axis fastest. Each row is one word. Bit i is 1 if voxel i
   *   has the label (indicator +1), else 0 (indicator -1). Bits from w on are 0.
   * @param plane receives the 8^D samples in the middle of the box, x fastest, clamped to -1 ... 1
   */
  void Smooth(const std::uint64_t* words, Buffers& buffers, std::int16_t* plane) const;

private:
  int Dimension;
  std::vector<float> Weights;       ///< weights of the distances 0 ... Radius()
  std::vector<std::int16_t> Tables; ///< tables of the pass along x
};

/**
 * Makes the own label of each voxel win by at least a margin. If it does not, its sample is raised.
 * @param own for each of n voxels the number of its label, 0 to labels - 1
 * @param margins for each of n voxels the margin, in units of samples; even
 * @param labels number of labels, at least 2
 * @param planes planes of n samples each. With two labels there is one plane, (u_0 - u_1) / 2,
 *   which is u_0. Otherwise there is one plane for each label.
 * @param scratch n samples; not used with two labels
 */
void KeepOwnLabels(const std::uint16_t* own, const std::int16_t* margins, std::size_t labels,
  std::size_t n, std::int16_t* planes, std::int16_t* scratch);

} // namespace voxplex

#endif
