// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RepairMemory.h
 * @brief What repairs of manifolds keep for the next one.
 */
#ifndef voxplex_RepairMemory_h
#define voxplex_RepairMemory_h

#include "Conformity/RepairNeighbourhood.h"

#include <boost/container/small_vector.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace voxplex
{

namespace repair
{

/**
 * What is best for a ridge or a crumb, as long as no simplex around the vertices that were seen
 * changes.
 */
struct Proposal
{
  std::optional<Change> Best; ///< none: it is no defect any more, or nothing helps
  std::vector<VertexId> Seen; ///< may be repeated
};

/** The proposals for a defect in the passes of a call. */
class ProposalHistory
{
public:
  using Shared = std::shared_ptr<const Proposal>;

  /** @param pass not before that of any other */
  void Add(std::uint32_t pass, const Shared& proposal)
  {
    if (this->Entries.empty() || this->Entries.back().second != proposal)
    {
      this->Entries.push_back({ pass, proposal });
    }
  }

  /** The proposal that was right in a pass. There must be one of the first pass. */
  const Shared& In(std::uint32_t pass) const
  {
    auto at = this->Entries.end();
    do
    {
      --at;
    } while (at != this->Entries.begin() && at->first > pass);
    return at->second;
  }

  /** Calls visit with each proposal. */
  template <typename Visit>
  void ForEach(const Visit& visit) const
  {
    for (const auto& [pass, proposal] : this->Entries)
    {
      visit(*proposal);
    }
  }

private:
  boost::container::small_vector<std::pair<std::uint32_t, Shared>, 1> Entries;
};

/** What was found for a defect. */
template <typename Key>
struct ProposalRecord
{
  Key Of;
  ProposalHistory Found;
};

} // namespace repair

/**
 * What RepairManifold() has found, for a call after further refinement. It then looks for changes
 * only where simplices are new or have another label, and where other changes are made for that.
 */
template <int D>
struct RepairMemory
{
  /** Must be set to the vertices of such simplices before the next call, or Records be cleared. */
  std::vector<VertexId> Changed;
  std::vector<repair::ProposalRecord<repair::Ridge<D>>> Records; ///< in the order of the ridges
};

/** What RelabelCrumbs() has found, in the same way. */
struct CrumbMemory
{
  /** Must be set to the vertices of new simplices before the next call, or Records be cleared. */
  std::vector<VertexId> Changed;
  std::vector<SimplexId> Simplices;                                    ///< of all crumbs, ascending
  std::vector<repair::ProposalRecord<std::vector<SimplexId>>> Records; ///< in the order of crumbs
};

} // namespace voxplex

#endif
