// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Refinement/Scheduling/LoadBalancer.h"

#include "Refinement/Scheduling/BeggingLists.h"

#include <cassert>
#include <map>
#include <utility>

namespace voxplex
{

BeggingLists::BeggingLists(
  const ProcessorTopology& groups, const ProcessorTopology& topology, LoopSharing* sharing)
  : Sharing(sharing)
  , Slots(groups.Group.size())
{
  assert(groups.Group.size() == topology.Group.size());
  // A group is identified by its number and its parent's list, so groups nest for any numbers.
  std::map<std::pair<unsigned, unsigned>, unsigned> listOf;
  std::vector<unsigned> members;
  const unsigned noParent = WaitingList::Nobody;
  for (std::size_t t = 0; t < this->Slots.size(); ++t)
  {
    this->Slots[t].Group = topology.Group[t];
    unsigned parent = noParent;
    for (unsigned level = Levels; level-- > 0;)
    {
      const unsigned next = static_cast<unsigned>(members.size());
      // All threads share the highest level.
      const unsigned group = level + 1 == Levels ? 0 : groups.Group[t][level];
      const auto [found, isNew] = listOf.try_emplace({ parent, group }, next);
      if (isNew)
      {
        members.push_back(0);
        if (parent != noParent)
        {
          ++members[parent];
        }
      }
      parent = found->second;
      this->Slots[t].ListOfLevel[level] = parent;
    }
    ++members[parent];
  }
  this->Lists = std::vector<List>(members.size());
  for (std::size_t i = 0; i < members.size(); ++i)
  {
    this->Lists[i].Capacity = members[i] - 1;
  }
}

unsigned BeggingLists::SharedLevel(unsigned a, unsigned b) const
{
  unsigned level = 0;
  while (level + 1 < Levels && this->Slots[a].Group[level] != this->Slots[b].Group[level])
  {
    ++level;
  }
  return level;
}

LoadBalancer::Beggar BeggingLists::TakeBeggar(unsigned giver)
{
  const Beggar nobody{ Nobody, 0 };
  const auto& lists = this->Slots[giver].ListOfLevel;
  // Beggars of other sockets may wait for long, and every thread asks all the time. So this look
  // takes no mutex.
  bool mayServe = false;
  for (const unsigned list : lists)
  {
    mayServe = mayServe || this->Lists[list].Size.load(std::memory_order_relaxed) != 0;
  }
  if (!mayServe)
  {
    return nobody;
  }
  const std::scoped_lock lock(this->Mutex);
  if (this->Over.load(std::memory_order_relaxed))
  {
    return nobody;
  }
  for (const unsigned index : lists)
  {
    List& list = this->Lists[index];
    const unsigned beggar = list.Threads.TakeFirst(this->Slots);
    if (beggar != WaitingList::Nobody)
    {
      list.Size.fetch_sub(1, std::memory_order_relaxed);
      this->Listed.fetch_sub(1, std::memory_order_relaxed);
      --this->Waiting;
      return { beggar, this->SharedLevel(giver, beggar) };
    }
  }
  return nobody;
}

bool BeggingLists::Beg(unsigned thread)
{
  Slot& own = this->Slots[thread];
  {
    const std::scoped_lock lock(this->Mutex);
    if (this->Over.load(std::memory_order_relaxed))
    {
      return false;
    }
    if (++this->Waiting == this->Slots.size())
    {
      this->End();
      return false;
    }
    unsigned level = 0;
    while (level + 1 < Levels)
    {
      const List& list = this->Lists[own.ListOfLevel[level]];
      if (list.Size.load(std::memory_order_relaxed) < list.Capacity)
      {
        break;
      }
      ++level;
    }
    List& list = this->Lists[own.ListOfLevel[level]];
    assert(list.Size.load(std::memory_order_relaxed) < list.Capacity);
    list.Threads.Append(this->Slots, thread);
    list.Size.fetch_add(1, std::memory_order_relaxed);
    own.Spot.Prepare();
    this->Listed.fetch_add(1, std::memory_order_relaxed);
  }
  WaitAndHelp(own.Spot, this->Sharing, thread);
  // Relaxed: the thread that ends the run wrote this before it woke this thread.
  return !this->Over.load(std::memory_order_relaxed);
}

void BeggingLists::End()
{
  this->Over.store(true, std::memory_order_relaxed);
  for (Slot& slot : this->Slots)
  {
    slot.Spot.Wake();
  }
}

void BeggingLists::Stop()
{
  const std::scoped_lock lock(this->Mutex);
  this->End();
}

std::unique_ptr<LoadBalancer> MakeLoadBalancer(
  BalancePolicy policy, const ProcessorTopology& topology, LoopSharing* sharing)
{
  if (policy == BalancePolicy::Hierarchical)
  {
    return std::make_unique<BeggingLists>(topology, topology, sharing);
  }
  const auto threads = static_cast<unsigned>(topology.Group.size());
  return std::make_unique<BeggingLists>(FlatTopology(threads), topology, sharing);
}

} // namespace voxplex
