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
#include <atomic>
#include <cstddef>
#include <functional>
#include <thread>
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
 * **Lazy removal** (the default). Entries of simplices that died meanwhile are recognised by their
 * generation and dropped when taken. Only the owner touches its list, except for a gift while it
 * waits for work. Entries that are put last are always removed lazily.
 *
 * Most entries die in the list, so a list that knows which entries are alive (DropDeadBy()) drops the
 * dead ones when its memory is full, and takes more memory only if more than half of it is then still
 * in use. Otherwise dead entries take eight bytes for each simplex that was ever made.
 *
 * **Eager removal** (REMOVE_ON_THE_FLY of the thesis, section 3.2.3). The thread that deletes a
 * simplex takes it out of the list that contains it, which may be another thread's. Then the list
 * needs a lock, and a directory tells where every simplex is. Entries that the directory no longer
 * knows are removed lazily.
 */
class PoorElementList
{
public:
  struct Entry
  {
    SimplexId Id;
    std::uint32_t Generation;
  };

  /** The list of each simplex and its index there. All lists of a run share it. */
  class Directory
  {
  public:
    struct Slot
    {
      std::uint32_t List;
      std::uint32_t Index;
    };
    /** @return List is None if the simplex was never in a list */
    Slot Find(SimplexId s)
    {
      this->Places.Grow(s + 1);
      const std::uint64_t place =
        std::atomic_ref<std::uint64_t>(this->Places[s]).load(std::memory_order_relaxed);
      return { static_cast<std::uint32_t>(place >> 32), static_cast<std::uint32_t>(place) };
    }
    void Set(SimplexId s, Slot slot)
    {
      this->Places.Grow(s + 1);
      std::atomic_ref<std::uint64_t>(this->Places[s])
        .store((std::uint64_t{ slot.List } << 32) | slot.Index, std::memory_order_relaxed);
    }

  private:
    ChunkedArray<std::uint64_t> Places{ ~std::uint64_t{ 0 } };
  };

  /**
   * Switches to eager removal.
   * @param number of this list, distinct from those of the other lists
   */
  void RemoveEagerly(Directory& directory, std::uint32_t number)
  {
    this->Where = &directory;
    this->Number = number;
  }

  /** @param isAlive whether the simplex of an entry is alive; called by the thread that pushes */
  void DropDeadBy(std::function<bool(const Entry&)> isAlive)
  {
    this->MayBeAlive = std::move(isAlive);
  }

  void Push(SimplexId s, std::uint32_t generation)
  {
    const Guard guard(*this);
    this->PushGuarded({ s, generation });
  }

  /** Adds an entry that is taken when nothing else is left. */
  void PushLast(SimplexId s, std::uint32_t generation)
  {
    const Guard guard(*this);
    if (this->Last.size() == this->Last.capacity())
    {
      this->ReserveOneMore(this->Last);
    }
    this->Last.push_back({ s, generation });
  }

  /** Whether no entry is left, except for those that eager removal has taken out. */
  bool Empty()
  {
    const Guard guard(*this);
    this->DropRemoved();
    return this->Entries.empty() && this->Last.empty();
  }
  /** Whether only entries that were put last are left. */
  bool OnlyLast()
  {
    const Guard guard(*this);
    this->DropRemoved();
    return this->Entries.empty();
  }
  /** The number of entries, including dead ones. */
  std::size_t Size()
  {
    const Guard guard(*this);
    return this->Entries.size() + this->Last.size();
  }

  /**
   * Takes the last entry. With eager removal its Id may be None. The list must not have been empty.
   */
  Entry Pop()
  {
    const Guard guard(*this);
    this->DropRemoved();
    std::vector<Entry>& entries = this->Entries.empty() ? this->Last : this->Entries;
    if (entries.empty())
    {
      return { None, 0 };
    }
    const Entry e = entries.back();
    entries.pop_back();
    return e;
  }

  /** Moves all entries to the ends of two vectors, in the order in which they were pushed. */
  void TakeAll(std::vector<Entry>& entries, std::vector<Entry>& last)
  {
    const Guard guard(*this);
    entries.insert(entries.end(), this->Entries.begin(), this->Entries.end());
    last.insert(last.end(), this->Last.begin(), this->Last.end());
    this->Entries.clear();
    this->Last.clear();
  }

  /**
   * With eager removal: takes a dead simplex out if it is in this list. Any thread may call this.
   */
  void Remove(const Entry& e, std::uint32_t index)
  {
    const Guard guard(*this);
    if (index < this->Entries.size() && this->Entries[index].Id == e.Id &&
      this->Entries[index].Generation == e.Generation)
    {
      this->Entries[index].Id = None;
    }
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
    std::vector<Entry> gift;
    std::vector<Entry> giftOfLast;
    {
      const Guard guard(*this);
      gift = TakeOlderHalf(this->Entries, fewest, isAlive);
      giftOfLast = TakeOlderHalf(this->Last, fewest, isAlive);
      this->NoteAll();
    }
    const Guard guard(receiver);
    for (const Entry& e : gift)
    {
      receiver.PushGuarded(e);
    }
    receiver.Last.insert(receiver.Last.end(), giftOfLast.begin(), giftOfLast.end());
    return gift.size() + giftOfLast.size();
  }

private:
  /**
   * Holds the list's lock if it needs one. The lock is held for a few instructions, so other
   * threads spin.
   */
  class Guard
  {
  public:
    explicit Guard(PoorElementList& list)
      : Lock(list.Where ? &list.Busy : nullptr)
    {
      while (this->Lock && this->Lock->test_and_set(std::memory_order_acquire))
      {
        std::this_thread::yield();
      }
    }
    ~Guard()
    {
      if (this->Lock)
      {
        this->Lock->clear(std::memory_order_release);
      }
    }
    Guard(const Guard&) = delete;
    Guard& operator=(const Guard&) = delete;

  private:
    std::atomic_flag* Lock;
  };

  template <typename Predicate>
  static std::vector<Entry> TakeOlderHalf(
    std::vector<Entry>& entries, std::size_t fewest, Predicate&& isAlive)
  {
    const auto dead = std::remove_if(entries.begin(), entries.end(),
      [&isAlive](const Entry& e) { return e.Id == None || !isAlive(e); });
    entries.erase(dead, entries.end());
    const std::size_t moved = entries.size() >= fewest ? entries.size() / 2 : 0;
    const auto end = entries.begin() + static_cast<std::ptrdiff_t>(moved);
    std::vector<Entry> taken(entries.begin(), end);
    entries.erase(entries.begin(), end);
    return taken;
  }

  /** For one more entry. */
  void ReserveOneMore(std::vector<Entry>& entries)
  {
    if (this->MayBeAlive)
    {
      std::erase_if(
        entries, [this](const Entry& e) { return e.Id == None || !this->MayBeAlive(e); });
    }
    if (entries.size() >= entries.capacity() / 2)
    {
      entries.reserve(std::max(2 * entries.capacity(), FewestEntries));
    }
  }

  void PushGuarded(const Entry& e)
  {
    if (this->Entries.size() == this->Entries.capacity())
    {
      this->ReserveOneMore(this->Entries);
      this->NoteAll();
    }
    this->Entries.push_back(e);
    if (this->Where)
    {
      this->Where->Set(
        e.Id, { this->Number, static_cast<std::uint32_t>(this->Entries.size() - 1) });
    }
  }
  void DropRemoved()
  {
    while (!this->Entries.empty() && this->Entries.back().Id == None)
    {
      this->Entries.pop_back();
    }
  }
  void NoteAll()
  {
    for (std::size_t i = 0; this->Where && i < this->Entries.size(); ++i)
    {
      this->Where->Set(this->Entries[i].Id, { this->Number, static_cast<std::uint32_t>(i) });
    }
  }

  static constexpr std::size_t FewestEntries = 1024; ///< room for these is always there

  std::function<bool(const Entry&)> MayBeAlive; ///< may be empty
  std::vector<Entry> Entries;
  std::vector<Entry> Last; ///< taken when Entries is empty
  Directory* Where = nullptr;
  std::uint32_t Number = 0;
  std::atomic_flag Busy;
};

} // namespace voxplex

#endif
