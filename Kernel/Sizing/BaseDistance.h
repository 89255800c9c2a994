// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file BaseDistance.h
 * @brief The sampling distance of interfaces to which no other size is given.
 */
#ifndef voxplex_BaseDistance_h
#define voxplex_BaseDistance_h

#include "Sizing/GradedDelta.h"

#include <algorithm>

namespace voxplex
{

/** Delta, the same everywhere or graded. */
template <int D>
struct BaseDistance
{
  double Delta = 1.0;                     ///< if it is graded: the largest
  const GradedDelta<D>* Graded = nullptr; ///< Delta(z); null: the same everywhere
  double Equivalent = Delta; ///< the uniform distance that gives about as many vertices
  double Asked = Delta;      ///< delta of the options: the lower bound of At()

  double At(const Point<D>& z) const { return this->Graded ? this->Graded->At(z) : this->Delta; }

  double Finest() const
  {
    return this->Graded ? std::min(this->Graded->Finest(), this->Delta) : this->Delta;
  }
};

} // namespace voxplex

#endif
