// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/ProcessorTopology.h"

#ifdef VOXPLEX_HAVE_HWLOC
#include "Parallel/HwlocTopology.h"

#include <algorithm>
#include <map>
#include <memory>
#include <type_traits>
#include <utility>
#endif

namespace voxplex
{

ProcessorTopology FlatTopology(unsigned threads)
{
  ProcessorTopology flat;
  flat.Group.assign(threads, { 0, 0, 0 });
  return flat;
}

#ifdef VOXPLEX_HAVE_HWLOC

namespace
{

struct DestroyTopology
{
  void operator()(hwloc_topology_t topology) const { hwloc_topology_destroy(topology); }
};
using HwlocTopology = std::unique_ptr<std::remove_pointer_t<hwloc_topology_t>, DestroyTopology>;

struct FreeBitmap
{
  void operator()(hwloc_bitmap_t bitmap) const { hwloc_bitmap_free(bitmap); }
};
using Bitmap = std::unique_ptr<std::remove_pointer_t<hwloc_bitmap_t>, FreeBitmap>;

/** Null if hwloc fails. */
HwlocTopology LoadTopology()
{
  hwloc_topology_t raw = nullptr;
  if (hwloc_topology_init(&raw) != 0)
  {
    return nullptr;
  }
  HwlocTopology topology(raw);
  // The system knows all that is asked for. hwloc would also ask each processor, one after the other,
  // which takes milliseconds in a virtual machine.
  hwloc_topology_set_components(raw, HWLOC_TOPOLOGY_COMPONENTS_FLAG_BLACKLIST, "x86");
  return hwloc_topology_load(raw) == 0 ? std::move(topology) : nullptr;
}

/**
 * The topology of this machine, read only once: that takes up to a tenth of a second. Thread-safe.
 */
hwloc_topology_t ThisMachine()
{
  static const HwlocTopology machine = LoadTopology();
  return machine.get();
}

/** A logical processor. */
struct Processor
{
  unsigned Number;     ///< of the operating system
  unsigned Package;    ///< logical number of the socket
  unsigned Numa;       ///< logical number of the NUMA node
  unsigned RankInCore; ///< among the allowed hyper-threads of its core; 0 for the first one
};

unsigned NumaNodeOf(hwloc_topology_t topology, hwloc_obj_t processor)
{
  // In hwloc, NUMA nodes are not part of the tree of processors. If a processor has several nodes
  // (fast and large memory), we take the first one.
  for (hwloc_obj_t node = hwloc_get_next_obj_by_type(topology, HWLOC_OBJ_NUMANODE, nullptr);
       node != nullptr; node = hwloc_get_next_obj_by_type(topology, HWLOC_OBJ_NUMANODE, node))
  {
    if (hwloc_bitmap_isset(node->cpuset, processor->os_index))
    {
      return node->logical_index;
    }
  }
  return 0;
}

/** The processors of `allowed`, in the machine's order. Those of one socket are contiguous. */
std::vector<Processor> AllowedProcessors(hwloc_topology_t topology, hwloc_const_bitmap_t allowed)
{
  std::vector<Processor> processors;
  hwloc_obj_t lastCore = nullptr;
  unsigned rankInCore = 0;
  for (hwloc_obj_t unit = hwloc_get_next_obj_by_type(topology, HWLOC_OBJ_PU, nullptr);
       unit != nullptr; unit = hwloc_get_next_obj_by_type(topology, HWLOC_OBJ_PU, unit))
  {
    if (!hwloc_bitmap_isset(allowed, unit->os_index))
    {
      continue;
    }
    const hwloc_obj_t core = hwloc_get_ancestor_obj_by_type(topology, HWLOC_OBJ_CORE, unit);
    rankInCore = core != nullptr && core == lastCore ? rankInCore + 1 : 0;
    lastCore = core;
    const hwloc_obj_t package = hwloc_get_ancestor_obj_by_type(topology, HWLOC_OBJ_PACKAGE, unit);
    processors.push_back({ unit->os_index, package != nullptr ? package->logical_index : 0,
      NumaNodeOf(topology, unit), rankInCore });
  }
  return processors;
}

/** True if processors with the same `inner` have the same `outer`. */
bool Nests(
  const std::vector<Processor>& processors, unsigned Processor::*inner, unsigned Processor::*outer)
{
  std::map<unsigned, unsigned> outerOf;
  return std::all_of(processors.begin(), processors.end(),
    [&](const Processor& processor) {
      return outerOf.emplace(processor.*inner, processor.*outer).first->second == processor.*outer;
    });
}

/** Numbers different values from 0, in the order of their first occurrence. */
class Numbering
{
public:
  unsigned operator()(unsigned thing)
  {
    return this->Numbers.emplace(thing, static_cast<unsigned>(this->Numbers.size())).first->second;
  }

private:
  std::map<unsigned, unsigned> Numbers;
};

} // namespace

ProcessorTopology SpreadThreads(
  hwloc_topology_t machine, hwloc_const_bitmap_t allowed, unsigned threads)
{
  std::vector<Processor> processors = AllowedProcessors(machine, allowed);
  if (processors.empty())
  {
    return FlatTopology(threads);
  }
  unsigned Processor::*inner = &Processor::Package;
  unsigned Processor::*outer = &Processor::Numa;
  bool nested = Nests(processors, inner, outer);
  if (!nested)
  {
    std::swap(inner, outer);
    nested = Nests(processors, inner, outer);
    if (!nested) // true for no known machine; then the levels are socket and machine
    {
      inner = &Processor::Package;
    }
  }
  // The first hyper-thread of every core comes before the second one of any core. The sort is
  // stable, so within each rank one socket follows the other.
  std::stable_sort(processors.begin(), processors.end(),
    [](const Processor& a, const Processor& b) { return a.RankInCore < b.RankInCore; });

  ProcessorTopology spread;
  spread.Group.reserve(threads);
  spread.Processor.reserve(threads);
  Numbering innerNumber;
  Numbering outerNumber;
  for (unsigned t = 0; t < threads; ++t)
  {
    const Processor& processor = processors[t % processors.size()];
    spread.Group.push_back(
      { innerNumber(processor.*inner), nested ? outerNumber(processor.*outer) : 0, 0 });
    spread.Processor.push_back(processor.Number);
  }
  return spread;
}

ProcessorTopology DiscoverTopology(unsigned threads)
{
  const hwloc_topology_t topology = ThisMachine();
  const Bitmap allowed(hwloc_bitmap_alloc());
  if (topology == nullptr || !allowed)
  {
    return FlatTopology(threads);
  }
  // The processors that taskset, a batch system or a container permits. (The topology that hwloc
  // loads already lacks the processors that the control group forbids.)
  if (hwloc_get_cpubind(topology, allowed.get(), HWLOC_CPUBIND_PROCESS) != 0)
  {
    hwloc_bitmap_fill(allowed.get());
  }
  return SpreadThreads(topology, allowed.get(), threads);
}

bool PinThisThread(const ProcessorTopology& topology, unsigned t)
{
  const hwloc_topology_t machine = ThisMachine();
  const Bitmap processor(hwloc_bitmap_alloc());
  if (t >= topology.Processor.size() || machine == nullptr || !processor)
  {
    return false;
  }
  hwloc_bitmap_set(processor.get(), topology.Processor[t]);
  return hwloc_set_cpubind(machine, processor.get(), HWLOC_CPUBIND_THREAD) == 0;
}

#else // without hwloc

ProcessorTopology DiscoverTopology(unsigned threads)
{
  return FlatTopology(threads);
}

bool PinThisThread(const ProcessorTopology&, unsigned)
{
  return false;
}

#endif

} // namespace voxplex
