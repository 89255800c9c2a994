// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MasksOnGrid.h
 * @brief Masks, each an image of its own, as one label image on one grid.
 */
#ifndef voxplex_MasksOnGrid_h
#define voxplex_MasksOnGrid_h

#include "LabelTable.h"
#include "MaskUnion.h"
#include "ScalarImage.h"

#include <optional>
#include <string>
#include <vector>

namespace voxplex
{

/**
 * Takes masks one after the other, of which none is kept. They become labels 1, 2, ... in this order. Messages name a
 * mask as it is `shown`: '/path/liver.nii.gz'.
 */
class MasksOnGrid
{
public:
  /**
   * The grid is that of the first mask or, if masks may be resampled to it, by nearest neighbour, that with the smallest
   * voxels, with the finest spacing along each axis that a mask with parallel axes has. It is extended to all that are
   * offered, unless they would need too much memory.
   *
   * @param threshold above which probabilities are inside
   */
  explicit MasksOnGrid(bool mayResample, double threshold = 0.5)
    : MayResample(mayResample)
    , Threshold(threshold)
  {
  }

  /**
   * Of each mask before the first is added; or of none, if all have one grid.
   *
   * @throws InputError for time frames, a single slice, another unit of length, and voxels between those of the grid,
   * unless they are resampled
   */
  void OfferGrid(ScalarImage image, const std::string& shown);

  /**
   * Puts a mask that does not say where it lies where another one of its size does; if none says it, where one of
   * them is guessed to lie.
   *
   * @return whether its place is no guess any more
   * @throws InputError if there is none of its size, or several at different places, and for another spacing
   */
  bool TakePlace(ScalarImage& image, const std::string& shown);

  /** @throws InputError if masks that were offered begin at different places, so that one place does not tell theirs */
  void CheckOneOrigin() const;

  /**
   * @param entry its name may be empty: the label has none then
   * @return whether it was added: if no grid was offered, only masks on that of the first are
   * @throws InputError as OfferGrid(), and for values of no mask
   */
  bool Add(const LabelTable::Entry& entry, ScalarImage image, const std::string& shown);

  /** @param warnings receives what is lost or overlaps, a line each */
  ScalarImage Finish(Overlap rule, std::vector<std::string>& warnings);

  /** Names and colours of the masks that have one. */
  const LabelTable& GetLabels() const { return this->Labels; }

  /** Where the masks that were offered lie; without voxels. */
  ScalarImage FindGrid() const;

private:
  struct Place
  {
    ScalarImage Image; ///< without voxels
    std::string Shown;
  };

  void Check(const ScalarImage& image, const std::string& shown) const;
  std::vector<const Place*> Placed() const;
  const Place& Finest() const;
  ScalarImage Refined() const;
  std::optional<ScalarImage> Extended(ScalarImage grid) const;
  void Resample(const std::string& name, ScalarImage& image, const std::string& shown);

  bool MayResample;
  double Threshold;
  std::vector<Place> Offered;
  ScalarImage Grid;
  std::optional<MaskUnion> Union; ///< with the first mask
  LabelTable Labels;
  std::vector<std::string> OddNames; ///< warnings of names that are not used
  std::string Lost;
  std::string Ties; ///< those with faces in the middle of voxels
  std::string Put;  ///< which were put where others lie
};

} // namespace voxplex

#endif
