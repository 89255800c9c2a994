// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SizeFunction.h
 * @brief The upper bound of the circumradius of elements (sf of the thesis, section 2.2, size
 *   rule).
 */
#ifndef voxplex_SizeFunction_h
#define voxplex_SizeFunction_h

#include "Geometry/Point.h"

#include <cstdint>

namespace voxplex
{

/**
 * @brief sf(p): an element with its circumcentre at p has a circumradius below this value.
 *
 * Every meshing thread calls Evaluate(), several at once, so implementations must be thread-safe.
 * +infinity sets no bound; NaN and values that are not positive set none, either.
 * A value below a tenth of delta is raised to that, so that refinement terminates.
 */
template <int D>
class SizeFunction
{
public:
  virtual ~SizeFunction() = default;

  /**
   * @param p point of the mesher's frame
   * @param label the image's own label value at p (never background)
   */
  virtual double Evaluate(const Point<D>& p, std::int64_t label) const = 0;

  /**
   * Whether the value is the same at all points of a label. Then it is asked once for each label.
   */
  virtual bool DependsOnLabelAlone() const { return false; }
};

} // namespace voxplex

#endif
