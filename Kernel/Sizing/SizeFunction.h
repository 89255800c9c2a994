// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SizeFunction.h
 * @brief The user's upper bound on the circumradius of elements (sf of the thesis, section 2.2, rule R5).
 */
#ifndef voxplex_SizeFunction_h
#define voxplex_SizeFunction_h

#include "Geometry/Point.h"

#include <cstdint>

namespace voxplex
{

/**
 * @brief sf(p): elements whose circumcentre is p have a circumradius below this value.
 *
 * Implementations are called from every meshing thread at once and must be safe for that.
 * A value of +infinity sets no bound; NaN and values that are not positive are read as no bound.
 * Values below a tenth of delta are raised to that, so that refinement terminates.
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

  /** Whether it is the same at all points of a label, which saves asking for each. */
  virtual bool DependsOnLabelAlone() const { return false; }
};

} // namespace voxplex

#endif
