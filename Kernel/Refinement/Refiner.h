// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Refiner.h
 * @brief The worker loop: takes poor elements until there are none (thesis, algorithm 2).
 */
#ifndef voxplex_Refiner_h
#define voxplex_Refiner_h

#include "Refinement/RefinementContext.h"

#include <functional>

namespace voxplex
{

/**
 * @brief Refines the triangulation of a context by a set of rules.
 *
 * Rules is a class with `static constexpr int Dimension`, a constructor (context, worker),
 * `ScreenCreated()` and `Refine(simplex)`, as Rules3D; the loop does not know which it runs.
 */
template <typename Rules>
class Refiner
{
public:
  static constexpr int D = Rules::Dimension;

  explicit Refiner(RefinementContext<D>& context)
    : Context(context)
    , Worker(context)
  {
  }

  /**
   * Refines until no rule applies.
   * @param goOn called every few hundred evaluations with the number of elements created so far;
   *   false stops refinement
   * @return false if stopped by goOn
   * @throws std::bad_alloc
   */
  bool Run(const std::function<bool(std::uint64_t vertices)>& goOn)
  {
    Rules rules(this->Context, this->Worker);
    Triangulation<D>& mesh = this->Context.Mesh;
    this->Worker.Kernel.Created.Clear();
    for (SimplexId s = 0; s < mesh.SimplexIdEnd(); ++s)
    {
      if (mesh.IsAlive(s))
      {
        this->Worker.Kernel.Created.MakeRoom(1);
        this->Worker.Kernel.Created.Push(s);
      }
    }
    rules.ScreenCreated();

    std::uint64_t turns = 0;
    while (!this->Worker.Poor.Empty())
    {
      if ((++turns & 255u) == 0 && goOn && !goOn(mesh.VertexIdEnd()))
      {
        return false;
      }
      const PoorElementList::Entry e = this->Worker.Poor.Pop();
      if (this->Dead(e))
      {
        continue;
      }
      if (rules.Refine(e.Id) && !this->Dead(e))
      {
        this->Worker.Poor.Push(e.Id, e.Generation);
      }
    }
    return true;
  }

  const RefinementWorker<D>& GetWorker() const { return this->Worker; }

private:
  bool Dead(const PoorElementList::Entry& e) const
  {
    return !this->Context.Mesh.IsAlive(e.Id) ||
      this->Context.Mesh.State(e.Id).Generation != e.Generation;
  }

  RefinementContext<D>& Context;
  RefinementWorker<D> Worker;
};

} // namespace voxplex

#endif
