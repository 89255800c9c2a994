// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PentatopeRules.h
 * @brief What changes of a pentatope mesh keep.
 */
#ifndef voxplex_PentatopeRules_h
#define voxplex_PentatopeRules_h

#include "Domain/Domain.h"
#include "Domain/TimePlanes.h"
#include "Optimisation/Complex.h"
#include "Optimisation/ComponentGuard.h"
#include "Optimisation/PentatopeShape.h"
#include "Sizing/SizingField.h"

#include <cstdint>

namespace voxplex
{

/** Bounds that changes of a mesh keep. What violates a bound already gets no worse. */
struct PentatopeBounds
{
  double Target = 0.05;         ///< pentatopes with a smaller normalized volume are improved
  double RadiusEdgeRatio = 2.0; ///< at most
  /** How far vertices may be moved off interfaces as a last resort; 0: not at all. */
  double InterfaceTolerance = 0.0;
  const SizingField<4>* Sizing = nullptr; ///< circumradii are below its element sizes; may be null
  /**
   * The facets on these planes stay, and so does the time of their vertices. So do those at the ends of a
   * periodic mesh.
   */
  TimePlanes Planes = {};
  /** No change that would lose one of its components is made. Null: all are. */
  ComponentGuard<4>* Guard = nullptr;
};

/** @brief Says whether bounds are kept. Thread safe. */
class PentatopeRules
{
public:
  /** Both must outlive this object. */
  PentatopeRules(const Domain<4>& surfaces, const PentatopeBounds& bounds)
    : Surfaces(surfaces)
    , Bounds(bounds)
  {
  }

  /**
   * Whether a pentatope keeps the bounds.
   * @param oldRatio the largest ratio of those that it replaces
   * @param label of the pentatope
   */
  bool Allows(const PentatopeShape& shape, double oldRatio, LabelId label) const;

  /** Whether the facet of s across vertex i lies on a time plane. */
  bool IsOnPlane(const PentatopeComplex& complex, std::uint32_t s, unsigned i) const;

private:
  const Domain<4>& Surfaces;
  const PentatopeBounds& Bounds;
};

} // namespace voxplex

#endif
