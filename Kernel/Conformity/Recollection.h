// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Recollection.h
 * @brief Internal to ManifoldLabels: what an earlier call has found, where it is still right.
 */
#ifndef voxplex_Recollection_h
#define voxplex_Recollection_h

#include "Conformity/RepairMemory.h"
#include "Delaunay/Triangulation.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace voxplex::repair
{

/**
 * @brief What an earlier call has found for defects, as far as it is right.
 *
 * A call decides on one defect after the other, in passes. The earlier call is followed step by
 * step; a step is a defect in a pass. It is known around which vertices a label is not that of the
 * same step of the earlier call, or a simplex is new. What was found there is not right any more.
 *
 * Find() may be called by several threads.
 */
template <int D>
class Recollection
{
public:
  using Shared = ProposalHistory::Shared;

  /**
   * @param triangulation, records must outlive this object
   * @param changed the vertices of simplices that are new, or have another label at the beginning
   * @param records of the earlier call, in the order of their keys
   * @param defects of this call, in the order of their keys
   * @param keyOf gives the key of a defect
   */
  template <typename Key, typename Defect, typename KeyOf>
  Recollection(const Triangulation<D>& triangulation, const std::vector<VertexId>& changed,
    const std::vector<ProposalRecord<Key>>& records, const std::vector<Defect>& defects,
    const KeyOf& keyOf)
    : Source(triangulation)
    , Differs(triangulation.VertexIdEnd(), 0)
    , Known(defects.size(), nullptr)
  {
    for (const VertexId v : changed)
    {
      this->Differs[v] = 1;
    }
    std::size_t d = 0;
    for (const ProposalRecord<Key>& record : records)
    {
      while (d < defects.size() && keyOf(defects[d]) < record.Of)
      {
        ++d;
      }
      if (d < defects.size() && keyOf(defects[d]) == record.Of)
      {
        this->Known[d] = &record.Found;
        continue;
      }
      record.Found.ForEach([this](const Proposal& proposal) { this->Mark(proposal.Best); });
    }
  }

  /** Must be told the simplices that differ otherwise. */
  void Mark(const std::vector<SimplexId>& simplices)
  {
    for (const SimplexId t : simplices)
    {
      for (const VertexId v : this->Source.GetSimplex(t).V)
      {
        if (v < this->Differs.size()) // not so: t is no simplex any more
        {
          this->Differs[v] = 1;
        }
      }
    }
  }

  /** What was found for defect d, if nothing that was seen differs; otherwise null. */
  Shared Find(std::size_t d, std::uint32_t pass) const
  {
    const Shared found = this->Known[d] ? this->Known[d]->In(pass) : nullptr;
    const bool isRight = found &&
      std::none_of(found->Seen.begin(), found->Seen.end(),
        [this](VertexId v) { return this->Differs[v] != 0; });
    return isRight ? found : nullptr;
  }

  /** Must be told what is found instead, as part of the step. */
  void Compare(std::size_t d, std::uint32_t pass, const Proposal& now)
  {
    const std::optional<Change> before =
      this->Known[d] ? this->Known[d]->In(pass)->Best : std::nullopt;
    if (before != now.Best)
    {
      this->Mark(before);
      this->Mark(now.Best);
    }
  }

private:
  void Mark(const std::optional<Change>& change)
  {
    if (change)
    {
      this->Mark(change->Cells);
    }
  }

  const Triangulation<D>& Source;
  std::vector<std::uint8_t> Differs;         ///< by vertex: 1 if something around it does
  std::vector<const ProposalHistory*> Known; ///< for each defect; null: nothing
};

} // namespace voxplex::repair

#endif
