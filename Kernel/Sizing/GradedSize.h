// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file GradedSize.h
 * @brief A size function whose growth from place to place is limited.
 */
#ifndef voxplex_GradedSize_h
#define voxplex_GradedSize_h

#include "Sizing/GradedGrid.h"
#include "Sizing/SizeFunction.h"

#include <memory>
#include <stop_token>

namespace voxplex
{

/**
 * @brief sf'(p) = min over the points q of the object of { sf(q) + gradation |p - q| }: the largest
 * function below sf that changes by no more than `gradation` over a unit of length.
 *
 * sf is sampled once at the centre of every voxel of the object. If sf depends on the label alone,
 * it is sampled once for each label. A query evaluates sf again and takes the smaller of the two
 * values, so that no bound of sf is lost between samples. GradedGrid describes the error of the
 * sampled sf'.
 */
template <int D>
class GradedSize final : public SizeFunction<D>
{
public:
  /**
   * sf with its growth limited. Returns sf itself if there is nothing to limit: the gradation is 0,
   * sf is null, or sf is the same everywhere.
   *
   * @param gradation change of the size over a unit of length, 0 or more
   * @param threads 0 means all cores; the result does not depend on it
   * @throws Cancelled if a stop was requested before the end
   */
  static std::shared_ptr<const SizeFunction<D>> Limit(std::shared_ptr<const SizeFunction<D>> size,
    const LabelImage<D>& image, double gradation, unsigned threads,
    const std::stop_token& stop = {});

  double Evaluate(const Point<D>& p, std::int64_t label) const override;

private:
  GradedSize(std::shared_ptr<const SizeFunction<D>> size, GradedGrid<D> grid);

  std::shared_ptr<const SizeFunction<D>> Size;
  GradedGrid<D> Grid;
};

extern template class GradedSize<3>;
extern template class GradedSize<4>;

} // namespace voxplex

#endif
