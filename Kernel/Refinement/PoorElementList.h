// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PoorElementList.h
 * @brief The poor element list (PEL) of a thread (thesis, section 3.2.1).
 */
#ifndef voxplex_PoorElementList_h
#define voxplex_PoorElementList_h

#include "Delaunay/Stores.h"

#include <vector>

namespace voxplex
{

/**
 * @brief Simplices that may violate a rule, last in first out.
 *
 * Entries of simplices that died meanwhile are recognised by their generation and dropped when taken
 * (lazy removal, REMOVE_ON_THE_FLY off in the thesis' terms). The last simplices made are the first
 * refined: most simplices die young, and their data are still in the cache.
 */
class PoorElementList
{
public:
  struct Entry
  {
    SimplexId Id;
    std::uint32_t Generation;
  };

  void Push(SimplexId s, std::uint32_t generation) { this->Entries.push_back({ s, generation }); }
  bool Empty() const { return this->Entries.empty(); }
  std::size_t Size() const { return this->Entries.size(); }
  Entry Pop()
  {
    const Entry e = this->Entries.back();
    this->Entries.pop_back();
    return e;
  }

private:
  std::vector<Entry> Entries;
};

} // namespace voxplex

#endif
