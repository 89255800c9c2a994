// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PoorElementList.h
 * @brief The poor element list (PEL) of a thread (thesis, section 3.2.1).
 */
#ifndef voxplex_PoorElementList_h
#define voxplex_PoorElementList_h

#include "Delaunay/Stores.h"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

namespace voxplex
{

/**
 * @brief Simplices that may violate a rule, last in first out.
 *
 * The simplices made last are refined first: most simplices die young, and their data are still in
 * the cache. Some are put last: they are taken when nothing else is left.
 *
 * Entries of simplices that died meanwhile are recognised by their generation and dropped when taken.
 * Only the owner touches its list, except for a gift while it waits for work.
 *
 * Most entries die in the list, so a list that knows which entries are alive (DropDeadBy()) drops the
 * dead ones when its memory is full, and takes more memory only if more than half of it is then still
 * in use. Otherwise dead entries take eight bytes for each simplex that was ever made.
 */
class PoorElementList
{
public:
  struct Entry
  {
    SimplexId Id;
    std::uint32_t Generation;
  };

  /** @param isAlive whether the simplex of an entry is alive; called by the thread that pushes */
  void DropDeadBy(std::function<bool(const Entry&)> isAlive)
  {
    this->MayBeAlive = std::move(isAlive);
  }

  void Push(SimplexId s, std::uint32_t generation)
  {
    this->PushTo(this->Entries, { s, generation });
  }

  /** Adds an entry that is taken when nothing else is left. */
  void PushLast(SimplexId s, std::uint32_t generation)
  {
    this->PushTo(this->Last, { s, generation });
  }

  bool Empty() const { return this->Entries.empty() && this->Last.empty(); }
  /** Whether only entries that were put last are left. */
  bool OnlyLast() const { return this->Entries.empty(); }
  /** The number of entries, including dead ones. */
  std::size_t Size() const { return this->Entries.size() + this->Last.size(); }

  /** Takes the last entry. The list must not be empty. */
  Entry Pop()
  {
    std::vector<Entry>& entries = this->Entries.empty() ? this->Last : this->Entries;
    const Entry e = entries.back();
    entries.pop_back();
    return e;
  }

  /** Moves all entries to the ends of two vectors, in the order in which they were pushed. */
  void TakeAll(std::vector<Entry>& entries, std::vector<Entry>& last)
  {
    entries.insert(entries.end(), this->Entries.begin(), this->Entries.end());
    last.insert(last.end(), this->Last.begin(), this->Last.end());
    this->Entries.clear();
    this->Last.clear();
  }

  /**
   * Drops the entries for which `isAlive` is false. If at least `fewest` remain, moves the older
   * half of them to another list. The same holds for the entries that were put last. The oldest
   * simplices are the largest, and the farthest from where the owner works.
   * @return the number of entries that were moved
   */
  template <typename Predicate>
  std::size_t GiveOlderHalf(PoorElementList& receiver, std::size_t fewest, Predicate&& isAlive)
  {
    const std::vector<Entry> gift = TakeOlderHalf(this->Entries, fewest, isAlive);
    for (const Entry& e : gift)
    {
      receiver.PushTo(receiver.Entries, e);
    }
    const std::vector<Entry> giftOfLast = TakeOlderHalf(this->Last, fewest, isAlive);
    receiver.Last.insert(receiver.Last.end(), giftOfLast.begin(), giftOfLast.end());
    return gift.size() + giftOfLast.size();
  }

private:
  template <typename Predicate>
  static std::vector<Entry> TakeOlderHalf(
    std::vector<Entry>& entries, std::size_t fewest, Predicate&& isAlive)
  {
    const auto dead = std::remove_if(
      entries.begin(), entries.end(), [&isAlive](const Entry& e) { return !isAlive(e); });
    entries.erase(dead, entries.end());
    const std::size_t moved = entries.size() >= fewest ? entries.size() / 2 : 0;
    const auto end = entries.begin() + static_cast<std::ptrdiff_t>(moved);
    std::vector<Entry> taken(entries.begin(), end);
    entries.erase(entries.begin(), end);
    return taken;
  }

  void PushTo(std::vector<Entry>& entries, const Entry& e)
  {
    if (entries.size() == entries.capacity())
    {
      if (this->MayBeAlive)
      {
        std::erase_if(entries, [this](const Entry& old) { return !this->MayBeAlive(old); });
      }
      if (entries.size() >= entries.capacity() / 2)
      {
        entries.reserve(std::max(2 * entries.capacity(), FewestEntries));
      }
    }
    entries.push_back(e);
  }

  static constexpr std::size_t FewestEntries = 1024; ///< room for these is always there

  std::function<bool(const Entry&)> MayBeAlive; ///< may be empty
  std::vector<Entry> Entries;
  std::vector<Entry> Last; ///< taken when Entries is empty
};

} // namespace voxplex

#endif
