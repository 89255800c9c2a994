// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "ScalingTables.h"

#include "MarkdownTable.h"
#include "Parallel/ParallelFor.h"
#include "Statistics.h"

#include <algorithm>
#include <string>
#include <utility>

namespace voxplex::benchmarks
{
namespace
{

/** A number of a record, and its name in the JSON stream. */
struct Value
{
  const char* Key;
  double (*Of)(const ScalingRecord&);
};

double OfAThread(double sum, const ScalingRecord& record)
{
  return sum / record.Threads;
}

const Value Values[] = {
  { "tetrahedra", [](const ScalingRecord& r) { return r.Tetrahedra; } },
  { "refinement", [](const ScalingRecord& r) { return r.RefinementSeconds; } },
  { "without_preparation", [](const ScalingRecord& r) { return r.SecondsWithoutPreparation(); } },
  { "total_without_io", [](const ScalingRecord& r) { return r.TotalSeconds; } },
  { "cpu", [](const ScalingRecord& r) { return r.CpuSeconds; } },
  { "peak_memory_mb",
    [](const ScalingRecord& r) { return static_cast<double>(r.PeakBytes) / 1e6; } },
  { "elements_per_second_refinement", [](const ScalingRecord& r) { return r.Rate(); } },
  { "elements_per_second", [](const ScalingRecord& r) { return r.TotalRate(); } },
  { "seeding_seconds", [](const ScalingRecord& r) { return r.SeedingSeconds; } },
  { "threads_that_refined", [](const ScalingRecord& r) { return r.Threads; } },
  { "insertions", [](const ScalingRecord& r) { return static_cast<double>(r.Sum.Insertions); } },
  { "removals", [](const ScalingRecord& r) { return static_cast<double>(r.Sum.Removals); } },
  { "rollbacks", [](const ScalingRecord& r) { return static_cast<double>(r.Sum.Rollbacks); } },
  { "waits", [](const ScalingRecord& r) { return static_cast<double>(r.Sum.Waits); } },
  { "contention_seconds", [](const ScalingRecord& r) { return r.Sum.ContentionSeconds; } },
  { "load_balance_seconds", [](const ScalingRecord& r) { return r.Sum.LoadBalanceSeconds; } },
  { "rollback_seconds", [](const ScalingRecord& r) { return r.Sum.RollbackSeconds; } },
  { "overhead_seconds", [](const ScalingRecord& r) { return r.OverheadSeconds(); } },
  { "overhead_seconds_per_thread",
    [](const ScalingRecord& r) { return OfAThread(r.OverheadSeconds(), r); } },
  { "received_in_socket",
    [](const ScalingRecord& r) { return static_cast<double>(r.Sum.Received[0]); } },
  { "received_in_node",
    [](const ScalingRecord& r) { return static_cast<double>(r.Sum.Received[1]); } },
  { "received_in_machine",
    [](const ScalingRecord& r) { return static_cast<double>(r.Sum.Received[2]); } },
  { "received_elements",
    [](const ScalingRecord& r) { return static_cast<double>(r.Sum.ReceivedElements); } },
  { "switched_to_local", [](const ScalingRecord& r) { return r.SwitchedToLocal ? 1.0 : 0.0; } },
};

std::string ManagerOf(const Configuration& what)
{
  return std::string(ContentionPolicyNames[static_cast<std::size_t>(what.Contention)]);
}

std::string BalancerOf(const Configuration& what)
{
  return std::string(BalancePolicyNames[static_cast<std::size_t>(what.Balance)]);
}

/** Whether the code for several threads ran. */
bool IsParallel(const Configuration& what)
{
  return what.Threads > 1 || what.Synchronise;
}

/** The first cells of a row. */
std::vector<std::string> NameCells(const Configuration& what)
{
  std::string threads = std::to_string(what.Threads);
  threads += what.Synchronise ? " (parallel code)" : "";
  return { threads, IsParallel(what) ? ManagerOf(what) : "-",
    IsParallel(what) ? BalancerOf(what) : "-" };
}

std::vector<std::string> operator+(std::vector<std::string> left, std::vector<std::string> right)
{
  std::move(right.begin(), right.end(), std::back_inserter(left));
  return left;
}

template <typename Of>
std::string Cell(const Series& series, Of of, const char* format = "")
{
  return Format(MedianOf(series.Records, of), format);
}

std::string Gifts(const Series& series)
{
  std::string text;
  for (std::size_t level = 0; level < StealingLevels; ++level)
  {
    text += (level ? " / " : "") +
      Cell(series, [=](const ScalingRecord& r) { return double(r.Sum.Received[level]); });
  }
  return text;
}

std::size_t TimesSwitched(const Series& series)
{
  return static_cast<std::size_t>(std::count_if(series.Records.begin(), series.Records.end(),
    [](const ScalingRecord& r) { return r.SwitchedToLocal; }));
}

const char* const Seconds = "%.3f";
const char* const Factor = "%.2f";

/** The efficiency, or "-" if there are more threads than cores. */
std::string Efficiency(double speedUp, const Series& series)
{
  return series.What.Threads > NumberOfThreads(0) ? "-"
                                                  : Format(speedUp / series.What.Threads, Factor);
}

/** Adds a row to a table that has a series in each column. */
template <typename CellOf>
void AddAcross(
  MarkdownTable& table, const char* name, const std::vector<const Series*>& columns, CellOf cellOf)
{
  std::vector<std::string> row = { name };
  for (const Series* series : columns)
  {
    row.push_back(cellOf(*series));
  }
  table.Add(std::move(row));
}

} // namespace

template <typename Value>
double ScalingTables::Ratio(const Series& series, const Series& reference, Value value)
{
  return MedianPair(series.Records, reference.Records, value).Ratio;
}

double ScalingTables::SpeedUp(const Series& series) const
{
  return Ratio(series, this->Baseline, [](const ScalingRecord& r) { return r.Rate(); });
}

double ScalingTables::TotalSpeedUp(const Series& series) const
{
  return Ratio(series, this->Baseline, [](const ScalingRecord& r) { return r.TotalRate(); });
}

void ScalingTables::PrintTimes(const Selection& selection) const
{
  MarkdownTable table({ "threads", "manager", "balancer", "tetrahedra", "refinement, s",
    "and extraction, s", "total, s", "processor, s", "tets/s", "speed-up", "efficiency",
    "speed-up of total", "memory, MB" });
  for (const std::size_t i : selection)
  {
    const Series& series = this->Runs[i];
    const double speedUp = this->SpeedUp(series);
    table.Add(NameCells(series.What) +
      std::vector<std::string>{ Cell(series, [](const ScalingRecord& r) { return r.Tetrahedra; }),
        Cell(
          series, [](const ScalingRecord& r) { return r.RefinementSeconds; }, Seconds),
        Cell(
          series, [](const ScalingRecord& r) { return r.SecondsWithoutPreparation(); }, Seconds),
        Cell(
          series, [](const ScalingRecord& r) { return r.TotalSeconds; }, Seconds),
        Cell(
          series, [](const ScalingRecord& r) { return r.CpuSeconds; }, Seconds),
        Cell(series, [](const ScalingRecord& r) { return r.Rate(); }), Format(speedUp, Factor),
        Efficiency(speedUp, series), Format(this->TotalSpeedUp(series), Factor),
        Cell(series, [](const ScalingRecord& r) { return double(r.PeakBytes) / 1e6; }) });
  }
  table.Print();
}

void ScalingTables::PrintOverheads(const Selection& selection) const
{
  MarkdownTable table({ "threads", "manager", "balancer", "rollbacks", "waits",
    "contention, s/thread", "load balance, s/thread", "rollback, s/thread", "all three, s/thread",
    "of refinement", "gifts: socket / node / machine", "elements given", "seeding, s" });
  for (const std::size_t i : selection)
  {
    const Series& series = this->Runs[i];
    if (!IsParallel(series.What))
    {
      continue;
    }
    using R = const ScalingRecord&;
    table.Add(NameCells(series.What) +
      std::vector<std::string>{ Cell(series, [](R r) { return double(r.Sum.Rollbacks); }),
        Cell(series, [](R r) { return double(r.Sum.Waits); }),
        Cell(
          series, [](R r) { return OfAThread(r.Sum.ContentionSeconds, r); }, Seconds),
        Cell(
          series, [](R r) { return OfAThread(r.Sum.LoadBalanceSeconds, r); }, Seconds),
        Cell(
          series, [](R r) { return OfAThread(r.Sum.RollbackSeconds, r); }, Seconds),
        Cell(
          series, [](R r) { return OfAThread(r.OverheadSeconds(), r); }, Seconds),
        Cell(
          series,
          [](R r) { return 100.0 * OfAThread(r.OverheadSeconds(), r) / r.RefinementSeconds; },
          "%.1f %%"),
        Gifts(series), Cell(series, [](R r) { return double(r.Sum.ReceivedElements); }),
        Cell(
          series, [](R r) { return r.SeedingSeconds; }, Seconds) });
  }
  table.Print();
}

void ScalingTables::PrintManagers(const Selection& selection) const
{
  std::vector<const Series*> columns;
  for (const std::size_t i : selection)
  {
    columns.push_back(&this->Runs[i]);
  }
  std::sort(columns.begin(), columns.end(),
    [](const Series* a, const Series* b) { return a->What.Contention < b->What.Contention; });
  std::vector<std::string> header = { "" };
  for (const Series* series : columns)
  {
    header.push_back(ManagerOf(series->What));
  }
  MarkdownTable table(header);
  using R = const ScalingRecord&;
  const auto add = [&](const char* name, double (*of)(R), const char* format)
  { AddAcross(table, name, columns, [&](const Series& s) { return Cell(s, of, format); }); };
  add(
    "time, s", [](R r) { return r.RefinementSeconds; }, Seconds);
  add(
    "rollbacks", [](R r) { return double(r.Sum.Rollbacks); }, "");
  add(
    "contention overhead, s", [](R r) { return r.Sum.ContentionSeconds; }, Seconds);
  add(
    "load balance overhead, s", [](R r) { return r.Sum.LoadBalanceSeconds; }, Seconds);
  add(
    "rollback overhead, s", [](R r) { return r.Sum.RollbackSeconds; }, Seconds);
  add(
    "total overhead, s", [](R r) { return r.OverheadSeconds(); }, Seconds);
  AddAcross(
    table, "speed-up", columns, [&](const Series& s) { return Format(this->SpeedUp(s), Factor); });
  AddAcross(table, "livelock (local took over)", columns,
    [](const Series& s)
    {
      const std::size_t times = TimesSwitched(s);
      return times ? "in " + std::to_string(times) + " of " + std::to_string(s.Records.size())
                   : std::string("no");
    });
  table.Print();
}

void ScalingTables::PrintBalancers(const Selection& selection) const
{
  MarkdownTable table({ "threads", "speed-up, rws", "speed-up, hws", "gifts, rws", "gifts, hws",
    "contention, s/thread (hws)", "load balance, s/thread (hws)", "rollback, s/thread (hws)" });
  for (const std::size_t i : selection)
  {
    const Series& hws = this->Runs[i];
    Configuration other = hws.What;
    other.Balance = BalancePolicy::Random;
    const auto rws = std::find_if(selection.begin(), selection.end(),
      [&](std::size_t k) { return this->Runs[k].What == other; });
    if (hws.What.Balance != BalancePolicy::Hierarchical || rws == selection.end())
    {
      continue;
    }
    using R = const ScalingRecord&;
    table.Add({ std::to_string(hws.What.Threads), Format(this->SpeedUp(this->Runs[*rws]), Factor),
      Format(this->SpeedUp(hws), Factor), Gifts(this->Runs[*rws]), Gifts(hws),
      Cell(
        hws, [](R r) { return OfAThread(r.Sum.ContentionSeconds, r); }, Seconds),
      Cell(
        hws, [](R r) { return OfAThread(r.Sum.LoadBalanceSeconds, r); }, Seconds),
      Cell(
        hws, [](R r) { return OfAThread(r.Sum.RollbackSeconds, r); }, Seconds) });
  }
  table.Print();
}

void ScalingTables::PrintWeak(const Selection& selection) const
{
  std::vector<const Series*> columns;
  std::vector<std::string> header = { "threads" };
  for (const std::size_t i : selection)
  {
    columns.push_back(&this->Runs[i]);
    header.push_back(std::to_string(this->Runs[i].What.Threads));
  }
  MarkdownTable table(header);
  using R = const ScalingRecord&;
  const auto add = [&](const char* name, double (*of)(R), const char* format)
  { AddAcross(table, name, columns, [&](const Series& s) { return Cell(s, of, format); }); };
  AddAcross(table, "delta", columns, [](const Series& s) { return Format(s.What.Delta, "%.4f"); });
  add(
    "elements", [](R r) { return r.Tetrahedra; }, "");
  add(
    "time, s", [](R r) { return r.RefinementSeconds; }, Seconds);
  add(
    "total, s", [](R r) { return r.TotalSeconds; }, Seconds);
  add(
    "elements a second", [](R r) { return r.Rate(); }, "");
  AddAcross(
    table, "speed-up", columns, [&](const Series& s) { return Format(this->SpeedUp(s), Factor); });
  AddAcross(
    table, "efficiency", columns, [&](const Series& s) { return Efficiency(this->SpeedUp(s), s); });
  add(
    "overhead, s/thread", [](R r) { return OfAThread(r.OverheadSeconds(), r); }, Seconds);
  add(
    "  contention", [](R r) { return OfAThread(r.Sum.ContentionSeconds, r); }, Seconds);
  add(
    "  load balance", [](R r) { return OfAThread(r.Sum.LoadBalanceSeconds, r); }, Seconds);
  add(
    "  rollback", [](R r) { return OfAThread(r.Sum.RollbackSeconds, r); }, Seconds);
  table.Print();
}

void ScalingTables::PrintSynchronised(std::size_t synchronised) const
{
  const Series& series = this->Runs[synchronised];
  using R = const ScalingRecord&;
  MarkdownTable table({ "one thread", "sequential code", "parallel code", "ratio" });
  const auto add = [&](const char* name, double (*of)(R), const char* format)
  {
    table.Add({ name, Cell(this->Baseline, of, format), Cell(series, of, format),
      Format(Ratio(series, this->Baseline, of), Seconds) });
  };
  add(
    "tetrahedra", [](R r) { return r.Tetrahedra; }, "");
  add(
    "refinement, s", [](R r) { return r.RefinementSeconds; }, Seconds);
  add(
    "total, s", [](R r) { return r.TotalSeconds; }, Seconds);
  add(
    "processor, s", [](R r) { return r.CpuSeconds; }, Seconds);
  add(
    "tets/s, refinement", [](R r) { return r.Rate(); }, "");
  table.Print();
}

void ScalingTables::PrintCeiling(const Selection& selection) const
{
  MarkdownTable table({ "processes at once", "refinement of each, s", "total of each, s",
    "rate against one alone", "rate of the total" });
  using R = const ScalingRecord&;
  for (const std::size_t i : selection)
  {
    const Series& series = this->Runs[i];
    table.Add({ std::to_string(series.What.Copies),
      Cell(
        series, [](R r) { return r.RefinementSeconds; }, Seconds),
      Cell(
        series, [](R r) { return r.TotalSeconds; }, Seconds),
      Format(this->SpeedUp(series), Factor), Format(this->TotalSpeedUp(series), Factor) });
  }
  table.Print();
}

void ScalingTables::PrintOversubscribed(
  const std::vector<std::pair<std::size_t, std::size_t>>& pairs) const
{
  MarkdownTable table({ "manager", "balancer", "threads", "against", "refinement, s", "against, s",
    "ratio", "total, s", "against, s", "ratio" });
  using R = const ScalingRecord&;
  const auto refinement = [](R r) { return r.RefinementSeconds; };
  const auto total = [](R r) { return r.TotalSeconds; };
  for (const auto& [many, few] : pairs)
  {
    const Series& over = this->Runs[many];
    const Series& fitting = this->Runs[few];
    table.Add({ ManagerOf(over.What), BalancerOf(over.What), std::to_string(over.What.Threads),
      std::to_string(fitting.What.Threads), Cell(over, refinement, Seconds),
      Cell(fitting, refinement, Seconds), Format(Ratio(over, fitting, refinement), Factor),
      Cell(over, total, Seconds), Cell(fitting, total, Seconds),
      Format(Ratio(over, fitting, total), Factor) });
  }
  table.Print();
}

void ScalingTables::WriteJson(std::ostream& stream) const
{
  const char* separator = "";
  stream << "[";
  for (const Series& series : this->Runs.All())
  {
    const Configuration& what = series.What;
    stream << separator << "\n    { \"delta\": " << what.Delta << ", \"threads\": " << what.Threads
           << ", \"contention\": \"" << ManagerOf(what) << "\", \"balance\": \"" << BalancerOf(what)
           << "\",\n      \"synchronise\": " << std::boolalpha << what.Synchronise
           << ", \"pin\": " << what.Pin << ", \"seeds\": " << what.Seeds
           << ", \"copies\": " << what.Copies << ",\n      \"speed_up\": " << this->SpeedUp(series)
           << ", \"speed_up_total\": " << this->TotalSpeedUp(series) << ",\n      \"medians\": {";
    for (const Value& value : Values)
    {
      stream << (&value == Values ? " \"" : ", \"") << value.Key
             << "\": " << MedianOf(series.Records, value.Of);
    }
    stream << " },\n      \"runs\": [";
    for (std::size_t i = 0; i < series.Records.size(); ++i)
    {
      stream << (i ? ",\n        {" : "\n        {");
      for (const Value& value : Values)
      {
        stream << (&value == Values ? " \"" : ", \"") << value.Key
               << "\": " << value.Of(series.Records[i]);
      }
      stream << " }";
    }
    stream << " ] }";
    separator = ",";
  }
  stream << "\n  ]";
}

} // namespace voxplex::benchmarks
