// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SeedInsertion.txx
 * @brief The part of RefinementRules that inserts points before the rules are applied.
 */
#ifndef voxplex_SeedInsertion_txx
#define voxplex_SeedInsertion_txx

#include "Refinement/Rules/RefinementRules.h"

namespace voxplex
{

//------------------------------------------------------------------------------------------------
/**
 * Moves a point near a flat end onto it. @return false if the point cannot be moved, or crowds
 * others
 */
template <int D, typename Rules>
bool RefinementRules<D, Rules>::FindSeedPosition(const FeatureSeed<D>& seed, Point<D>& z) const
{
  z = seed.Position;
  Point<D> onEnd;
  return !(this->Context.IsNearEnd(z, seed.Delta, onEnd) &&
           !this->Context.Image.ClosestSurfacePointOnEnd(onEnd, z)) &&
    !this->AnyFeatureWithin(z, seed.Delta);
}

//------------------------------------------------------------------------------------------------
template <int D, typename Rules>
bool RefinementRules<D, Rules>::InsertSeed(const FeatureSeed<D>& seed, SimplexId& near)
{
  if (seed.IsShared)
  {
    return this->InsertShared(seed, near);
  }
  Point<D> z;
  if (!this->FindSeedPosition(seed, z))
  {
    return false;
  }
  const SimplexId conflict = this->Context.Mesh.FindConflict(this->Worker.Kernel, z, near);
  if (conflict == None)
  {
    return false;
  }
  this->Context.Mesh.Lock( // no other thread operates, so it succeeds
    this->Worker.Kernel, conflict, this->Context.Mesh.State(conflict).Generation);
  const RuleOutcome outcome = this->InsertFeature(z, seed.Delta, 0.0, conflict, None,
    this->Worker.Statistics.Fired[RuleNumber<D>::SampleSpacing]);
  near = this->Worker.Kernel.Created.Empty() ? near : this->Worker.Kernel.Created[0];
  return outcome == RuleOutcome::Changed;
}

//------------------------------------------------------------------------------------------------
/**
 * Inserts a point that another slab has on the common plane. The removal rule follows a feature
 * point.
 */
template <int D, typename Rules>
bool RefinementRules<D, Rules>::InsertShared(const FeatureSeed<D>& seed, SimplexId& near)
{
  const SimplexId conflict =
    this->Context.Mesh.FindConflict(this->Worker.Kernel, seed.Position, near);
  if (conflict == None)
  {
    return false; // it is a vertex already: a corner of the box
  }
  this->Context.Mesh.Lock( // no other thread operates, so it succeeds
    this->Worker.Kernel, conflict, this->Context.Mesh.State(conflict).Generation);
  if (this->Context.Mesh.Insert(this->Worker.Kernel, seed.Position, seed.Kind, conflict) !=
    InsertionOutcome::Inserted)
  {
    return false;
  }
  ++this->Worker.Statistics.Shared;
  near = this->Worker.Kernel.Created[0];
  this->ScreenCreated();
  if (seed.Kind == VertexKind::Feature)
  {
    this->Context.Features.Add(seed.Position);
    this->RemoveFreeVertices(this->Worker.Kernel.NewVertex, Rules::RemovalRadius * seed.Delta);
    near = this->Worker.Kernel.Created.Empty() ? near : this->Worker.Kernel.Created[0];
  }
  return true;
}

} // namespace voxplex

#endif
