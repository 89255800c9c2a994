// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MasksOnGrid.h
 * @brief Masks, each an image of its own, as one label image on one grid.
 */
#ifndef voxplex_io_MasksOnGrid_h
#define voxplex_io_MasksOnGrid_h

#include "ImageReading/MaskUnion.h"
#include "ImageReading/ReadImage.h"
#include "LabelTable.h"

#include <optional>
#include <string>
#include <vector>

namespace voxplex::io
{

/**
 * Takes masks one after the other, of which none is kept. They become labels 1, 2, ... in this order. Messages name a
 * mask as it is `shown`: '/path/liver.nii.gz'.
 */
class MasksOnGrid
{
public:
  /** @param threshold above which probabilities are inside */
  explicit MasksOnGrid(double threshold = 0.5)
    : Threshold(threshold)
  {
  }

  /**
   * Resampling is asked for by offering all masks before the first is added: the grid is that with the smallest voxels,
   * and masks on others are resampled to it, by nearest neighbour. Otherwise it is that of the first, and others are
   * refused.
   *
   * @throws FileError as Add()
   */
  void OfferGrid(ScalarImage image, const std::string& shown);

  /**
   * @param entry its name may be empty: the label has none then
   * @throws FileError for time frames, a single slice, another grid, and values of no mask
   */
  void Add(const LabelTable::Entry& entry, ScalarImage image, const std::string& shown);

  /** @param warnings those that there are; what is lost or overlaps is added, a line each */
  ImageAnswer Finish(Overlap rule, std::vector<std::string> warnings);

  /** Where the masks lie; without voxels. */
  const ScalarImage& GetGrid() const { return this->Grid; }

private:
  void Resample(const std::string& name, ScalarImage& image, const std::string& shown);

  double Threshold;
  ScalarImage Grid;
  std::string ShownOfGrid; ///< the mask that it is from; empty if there is none
  bool MayResample = false;
  std::optional<MaskUnion> Union; ///< with the first mask
  LabelTable Labels;
  std::string Lost;
};

} // namespace voxplex::io

#endif
