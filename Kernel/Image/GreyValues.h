// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file GreyValues.h
 * @brief Detects grey-value images that were given as segmentations.
 */
#ifndef voxplex_GreyValues_h
#define voxplex_GreyValues_h

#include "Image/LabelImage.h"

#include <cstdint>
#include <stop_token>

namespace voxplex
{

/** Numbers of pairs of voxels with a common face. Pairs with a background voxel do not count. */
struct NeighbourPairs
{
  std::int64_t All = 0;
  std::int64_t Different = 0; ///< pairs with two different labels

  /** 0 if there are no pairs. */
  double ShareOfDifferent() const
  {
    return this->All > 0 ? static_cast<double>(this->Different) / static_cast<double>(this->All)
                         : 0.0;
  }
};

/**
 * Counts the pairs in one pass over the image.
 * @param threads 0 means all cores; the result does not depend on it
 * @throws Cancelled if a stop was requested before the end
 */
template <int D>
NeighbourPairs CountNeighbourPairs(
  const LabelImage<D>& image, unsigned threads = 1, const std::stop_token& stop = {});

/** Images with fewer labels, or fewer pairs of neighbours, are never treated as grey values. */
inline constexpr int FewestGreyValues = 40;
inline constexpr std::int64_t FewestGreyPairs = 50000;
/** With more labels than this, the number of pairs does not count. */
inline constexpr int ManyGreyValues = 2000;
/** In grey-value images more than this share of the pairs have different values. */
inline constexpr double LeastGreyShare = 0.6;

/**
 * Refuses an image whose labels look like grey values: there are many labels, and most neighbours
 * differ. The mesh would enclose nearly every voxel separately, and take minutes or hours. In a
 * segmentation, labels form regions, even if there are many labels:
 *
 *     image                                           labels    share of neighbours that differ
 *     atlases of the head, knee, brain (12)           32 to 724            0.01 to 0.18
 *     Voronoi cells of 114 voxels on average          1900                 0.27
 *     Voronoi cells of 33 voxels on average           3375                 0.39
 *     blocks of 2 x 2 x 2 voxels                      1000                 0.47
 *     MR images of brains, 1 mm, 8 bits               126 to 248           0.85 to 0.91
 *     one of these images, smoothed by 1 or 2 voxels  227 to 242           0.84 to 0.86
 *     the same image with twice the resolution        180                  0.74
 *     another image at 0.7 mm, 80 grey values         80                   0.76
 *     quantised to 64, 32, 16 grey values             63, 31, 15           0.71, 0.55, 0.38
 *     phantoms of CT images, noise of 5 to 40 HU      59 to 255            0.71 to 0.96
 *     noise smoothed by 4 voxels                      250, 63, 15          0.90, 0.63, 0.20
 *     noise                                           255                  1.00
 *
 * The number of labels alone says nothing: a polycrystal has thousands of grains. Images with few labels and small
 * images are accepted, even if they are noise. Only labels that are to be meshed are looked at.
 *
 * @throws InputError if the labels look like grey values; Cancelled
 */
template <int D>
void CheckSegmented(
  const LabelImage<D>& image, unsigned threads = 1, const std::stop_token& stop = {});

extern template NeighbourPairs CountNeighbourPairs(
  const LabelImage<3>&, unsigned, const std::stop_token&);
extern template NeighbourPairs CountNeighbourPairs(
  const LabelImage<4>&, unsigned, const std::stop_token&);
extern template void CheckSegmented(const LabelImage<3>&, unsigned, const std::stop_token&);
extern template void CheckSegmented(const LabelImage<4>&, unsigned, const std::stop_token&);

} // namespace voxplex

#endif
