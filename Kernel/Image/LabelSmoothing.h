// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LabelSmoothing.h
 * @brief Internal to LabelField: the arithmetic by which indicators of labels become samples.
 *
 * It works on blocks of 8^D samples and knows nothing of images or tiles. A sample is a 16-bit
 * fixed-point number in which 2^14 is 1. Arrays belong to the caller, have any alignment that their
 * type allows and do not overlap. Results are the same, bit for bit, whichever vector instructions
 * the processor has.
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
 * The 1D kernel (1 + c) g - c g*g as weights of the distances 0, 1, ... 4 sigma in voxels, which add up to
 * 1 over both sides; {1} for sigma 0.
 * @param secondMoment of the kernel in sigma^2, which c makes it: 0 leaves parabolas as they are
 */
std::vector<double> NonShrinkingKernel(double sigma, double secondMoment);

/**
 * @brief The separable kernel (1 + c) g - c g*g of LabelField, applied to indicators.
 *
 * Its weights are multiples of 2^-14 that add up to 1, and are applied as such: where all
 * indicators are equal the result is exactly +1 or -1.
 *
 * Immutable after construction; one instance may serve several threads.
 */
class LabelSmoothing
{
public:
  /** What a vector register takes, never across two cache lines (which cost 8 % for sigma 2). */
  struct alignas(32) EightFloats
  {
    std::array<float, 8> Values;
  };
  /** Memory for intermediate results: one for each thread, kept from call to call. */
  using Buffers = std::array<std::vector<EightFloats>, 2>;

  /**
   * @param dimension D, 3 or 4
   * @param sigma standard deviation in voxels, 0 (none) to 5
   */
  LabelSmoothing(int dimension, double sigma);

  /** Voxels on either side that a sample depends on, along each axis: 4 sigma, rounded up. */
  std::size_t Radius() const { return this->Weights.size() - 1; }

  /**
   * Smooths the indicator of one label.
   * @param words the indicator on a box of w = 8 + 2 Radius() voxels along each axis: w^(D - 1)
   *   rows along x, the second axis fastest; bit i of a row's word is 1 where voxel i has the label
   *   (+1) and 0 where it has not (-1), and bits from w on are 0
   * @param plane receives the 8^D samples in the middle of the box, x fastest, clamped to -1 ... 1
   */
  void Smooth(const std::uint64_t* words, Buffers& buffers, std::int16_t* plane) const;

private:
  int Dimension;
  std::vector<float> Weights;       ///< of the distances 0 ... Radius()
  std::vector<std::int16_t> Tables; ///< of the pass along x
};

/**
 * Makes the own label of each voxel win by a margin at least, by raising its sample where it does
 * not.
 * @param own of n voxels, the number of the label that each has, 0 to labels - 1
 * @param margins of n voxels, in samples; even
 * @param labels at least 2
 * @param planes of n samples: with two labels a single one, (u_0 - u_1) / 2, which is u_0;
 *   otherwise one for each label
 * @param scratch n samples; not used with two labels
 */
void KeepOwnLabels(const std::uint16_t* own, const std::int16_t* margins, std::size_t labels,
  std::size_t n, std::int16_t* planes, std::int16_t* scratch);

} // namespace voxplex

#endif
