// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause

#include "Refinement/Refiner.h"

#include "Refinement/Rules/Seeding.h"

namespace voxplex
{

template <typename Rules>
bool Refiner<Rules>::Run(const Monitor& goOn)
{
  if (this->Options.Threads <= 1 && !this->Options.Synchronise)
  {
    this->Workers.push_back(std::make_unique<RefinementWorker<D>>(this->Context));
    this->Hardware.resize(1);
    this->PushAll();
    HardwareCounters counters;
    counters.Start();
    const bool done = this->WorkAlone(goOn);
    this->Hardware[0] = counters.Stop();
    return done;
  }
  const CycleClock clock;
  this->Team.Run(
    [&](unsigned threads)
    {
      this->MakeWorkers(threads);
      this->SecondsToSeed = clock.Seconds();
    },
    [&](unsigned thread)
    {
      HardwareCounters counters;
      counters.Start();
      this->Work(thread, goOn);
      this->Hardware[thread] = counters.Stop();
    });
  this->SecondsPerTick = clock.SecondsPerTick();
  return !this->Team.Stopped();
}

template <typename Rules>
std::vector<ThreadStatistics> Refiner<Rules>::GetThreadStatistics() const
{
  std::vector<ThreadStatistics> threads;
  for (std::size_t t = 0; t < this->Workers.size(); ++t)
  {
    ThreadStatistics statistics;
    if (!this->Overheads.empty())
    {
      statistics = this->Overheads[t]->Counts;
      statistics.ContentionSeconds = this->Seconds(this->Overheads[t]->Contention);
      statistics.LoadBalanceSeconds = this->Seconds(this->Overheads[t]->LoadBalance);
      statistics.RollbackSeconds = this->Seconds(this->Overheads[t]->Rollback);
    }
    if (const LoopSharing* sharing = this->Team.Help())
    {
      statistics.HelpedLoops = sharing->GetCounts(static_cast<unsigned>(t)).Loops;
      statistics.HelpedIterations = sharing->GetCounts(static_cast<unsigned>(t)).Iterations;
      statistics.HelpingSeconds = this->Seconds(sharing->TicksOfHelp(static_cast<unsigned>(t)));
    }
    const RuleStatistics& rules = this->Workers[t]->Statistics;
    statistics.Insertions = rules.Insertions();
    statistics.Removals = rules.Removed;
    statistics.Hardware = this->Hardware[t];
    threads.push_back(statistics);
  }
  return threads;
}

template <typename Rules>
void Refiner<Rules>::PushAll()
{
  if (this->Start == RefinementStart::AtSeeds)
  {
    this->StartAtSeeds();
    return;
  }
  SeedTriangulation<Rules>(this->Context, *this->Workers[0], this->Seeds, 0, 1);
  const std::vector<SimplexId> simplices = this->LivingSimplices();
  this->template Screen<Rules>(
    *this->Workers[0], simplices.data(), simplices.data() + simplices.size());
}

template <typename Rules>
void Refiner<Rules>::StartAtSeeds()
{
  InsertSeeds<Rules>(this->Context, *this->Workers[0], this->Seeds);
  const std::vector<SimplexId> changed = this->FindReaching();
  this->template Screen<Rules>(*this->Workers[0], changed.data(), changed.data() + changed.size());
}

template <typename Rules>
void Refiner<Rules>::MakeWorkers(unsigned threads)
{
  for (unsigned t = 0; t < threads; ++t)
  {
    this->Workers.push_back(
      std::make_unique<RefinementWorker<D>>(this->Context, static_cast<WorkerId>(t + 1)));
    this->Overheads.push_back(std::make_unique<Overhead>());
  }
  this->Hardware.resize(threads);
  if (this->Options.FineGrained)
  {
    this->HelpEachOther(*this->Team.Help());
  }
  if (this->Start == RefinementStart::AtSeeds)
  {
    this->StartAtSeeds();
    return;
  }
  SeedTriangulation<Rules>(this->Context, *this->Workers[0], this->Seeds,
    std::size_t{ this->Options.SeedsPerThread } * threads, threads);
  const std::vector<SimplexId> simplices = LivingAlongCurve(this->Context.Mesh, threads);
  // By one thread: screening a simplex also writes what it finds out about its neighbours.
  for (std::size_t t = 0; t < threads; ++t)
  {
    this->template Screen<Rules>(*this->Workers[t],
      simplices.data() + simplices.size() * t / threads,
      simplices.data() + simplices.size() * (t + 1) / threads);
  }
}

template <typename Rules>
bool Refiner<Rules>::WorkAlone(const Monitor& goOn)
{
  RefinementWorker<D>& me = *this->Workers[0];
  Rules rules(this->Context, me);
  std::uint64_t turns = 0;
  while (!me.Poor.Empty())
  {
    if ((++turns & 255u) == 0 && goOn && !goOn(this->Context.Mesh.VertexIdEnd()))
    {
      return false;
    }
    const PoorElementList::Entry e = me.Poor.Pop();
    if (this->IsAlive(e) && rules.Refine(e.Id) == RuleOutcome::Changed && this->IsAlive(e))
    {
      me.Poor.Push(e.Id, e.Generation);
    }
  }
  return true;
}

template <typename Rules>
void Refiner<Rules>::Work(unsigned thread, const Monitor& goOn)
{
  RefinementWorker<D>& me = *this->Workers[thread];
  Overhead& overhead = *this->Overheads[thread];
  Rules rules(this->Context, me);
  std::uint64_t turns = 0;
  for (;;)
  {
    if (!this->HasWork(me))
    {
      if (!this->Beg(thread))
      {
        return;
      }
      continue; // the gift may contain dead simplices only
    }
    if ((++turns & 255u) == 0 && goOn && !goOn(this->Context.Mesh.VertexIdEnd()))
    {
      this->Team.Stop();
    }
    if (this->Team.Stopped())
    {
      this->Context.Mesh.Unlock(me.Kernel);
      return;
    }
    // Most entries are dead when they are taken, so the clock starts after them.
    const PoorElementList::Entry e =
      me.PendingRemovals.empty() ? this->NextAlive(me) : PoorElementList::Entry{ None, 0 };
    const CycleClock::Ticks start = CycleClock::Now();
    const RuleOutcome outcome =
      me.PendingRemovals.empty() ? this->Refine(me, rules, e) : rules.RemovePending();
    if (outcome == RuleOutcome::Contended || me.Kernel.NumberOfOwned() >= MostKept)
    {
      this->Context.Mesh.Unlock(me.Kernel);
    }
    if (outcome == RuleOutcome::Contended)
    {
      const CycleClock::Ticks rollback = CycleClock::Now();
      const CycleClock::Ticks helped = this->TicksOfHelp(thread);
      overhead.Rollback += rollback - start;
      ++overhead.Counts.Rollbacks;
      const bool waited = this->Team.Contention().RollbackOccurred(thread, me.Kernel.Winner - 1u);
      overhead.Counts.Waits += waited ? 1 : 0;
      overhead.Contention += CycleClock::Now() - rollback - (this->TicksOfHelp(thread) - helped);
      continue;
    }
    if (outcome == RuleOutcome::Changed)
    {
      this->Team.Contention().RollbackNotOccurred(thread);
      this->TakeUpDeferred(me);
    }
    if (this->Team.Balance().SomeoneBegs())
    {
      this->Give(thread);
    }
  }
}

template <typename Rules>
PoorElementList::Entry Refiner<Rules>::NextAlive(RefinementWorker<D>& me)
{
  if (me.Poor.Empty())
  {
    this->TakeUpDeferred(me);
  }
  while (!me.Poor.Empty())
  {
    const PoorElementList::Entry e = me.Poor.Pop();
    if (this->IsAlive(e))
    {
      return e;
    }
  }
  return { None, 0 };
}

template <typename Rules>
RuleOutcome Refiner<Rules>::Refine(
  RefinementWorker<D>& me, Rules& rules, const PoorElementList::Entry& e)
{
  if (e.Id == None)
  {
    return RuleOutcome::Good;
  }
  RuleOutcome outcome = RuleOutcome::Good;
  switch (this->Context.Mesh.Lock(me.Kernel, e.Id, e.Generation))
  {
    case LockOutcome::Dead:
      return RuleOutcome::Good;
    case LockOutcome::Contended:
      outcome = RuleOutcome::Contended;
      break;
    case LockOutcome::Locked:
      outcome = rules.Refine(e.Id);
      break;
  }
  if (outcome == RuleOutcome::Contended)
  {
    me.Deferred.push_back(e);
  }
  else if (outcome == RuleOutcome::Changed && this->IsAlive(e))
  {
    me.Poor.Push(e.Id, e.Generation);
  }
  return outcome;
}

template <typename Rules>
void Refiner<Rules>::TakeUpDeferred(RefinementWorker<D>& me)
{
  for (const PoorElementList::Entry& e : me.Deferred)
  {
    me.Poor.Push(e.Id, e.Generation);
  }
  me.Deferred.clear();
}

template <typename Rules>
bool Refiner<Rules>::Beg(unsigned thread)
{
  const CycleClock::Ticks start = CycleClock::Now();
  const CycleClock::Ticks helped = this->TicksOfHelp(thread);
  this->Context.Mesh.Unlock(this->Workers[thread]->Kernel);
  this->Team.Contention().BecomesIdle(thread);
  const bool goOn = this->Team.Balance().Beg(thread);
  if (goOn)
  {
    this->Team.Contention().BecomesBusy(thread);
  }
  this->Overheads[thread]->LoadBalance +=
    CycleClock::Now() - start - (this->TicksOfHelp(thread) - helped);
  return goOn;
}

template <typename Rules>
void Refiner<Rules>::Give(unsigned thread)
{
  RefinementWorker<D>& me = *this->Workers[thread];
  if (me.Poor.Size() < GiveThreshold)
  {
    return;
  }
  const LoadBalancer::Beggar beggar = this->Team.Balance().TakeBeggar(thread);
  if (beggar.Thread == LoadBalancer::Nobody)
  {
    return;
  }
  const std::size_t given = me.Poor.GiveOlderHalf(this->Workers[beggar.Thread]->Poor, GiveThreshold,
    [this](const PoorElementList::Entry& e) { return this->IsAlive(e); });
  if (given > 0)
  {
    ThreadStatistics& counts = this->Overheads[beggar.Thread]->Counts;
    ++counts.Received[beggar.Level];
    counts.ReceivedElements += given;
  }
  this->Team.Balance().Wake(beggar.Thread);
}

template <typename Rules>
CycleClock::Ticks Refiner<Rules>::TicksOfHelp(unsigned thread) const
{
  const LoopSharing* sharing = this->Team.Help();
  return sharing ? sharing->TicksOfHelp(thread) : 0;
}

template class Refiner<Rules3D>;
template class Refiner<Rules4D>;

} // namespace voxplex
