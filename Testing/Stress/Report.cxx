// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Report.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <sstream>

namespace voxplex::stress
{

namespace
{

constexpr std::size_t CasesOfCause = 6; ///< largest number that is named for each cause
constexpr std::size_t CasesOfRanking = 5;
constexpr double SecondsBetweenLines = 20.0;

double WallSeconds()
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::string Name(const CaseId& id)
{
  return std::string(NameOf(id.Kind)) + ":" + std::to_string(id.Seed) + ":" +
    std::to_string(id.Number);
}

/** The first words of a refusal, with N for numbers, so that equal refusals have one entry. */
std::string Beginning(const std::string& refusal)
{
  std::string words;
  for (const char c : refusal.substr(0, 60))
  {
    const bool isDigit = c >= '0' && c <= '9';
    if (!isDigit || words.empty() || words.back() != 'N')
    {
      words += isDigit ? 'N' : c;
    }
  }
  return words;
}

/** What a kind has after commas. */
std::vector<std::string> FeaturesOf(const std::string& kind)
{
  std::vector<std::string> features;
  std::istringstream stream(kind.find(',') == std::string::npos ? "" : kind.substr(kind.find(',')));
  for (std::string feature; std::getline(stream, feature, ',');)
  {
    if (!feature.empty())
    {
      features.push_back(feature.substr(1));
    }
  }
  return features;
}

double Per(std::uint64_t a, std::uint64_t b)
{
  return static_cast<double>(a) / static_cast<double>(b);
}

} // namespace

//------------------------------------------------------------------------------------------------
std::string RepeatCommand(const CaseId& id)
{
  return "voxplexStress --dimension " + std::string(NameOf(id.Kind)) + " --seed " +
    std::to_string(id.Seed) + " --case " + std::to_string(id.Number);
}

//------------------------------------------------------------------------------------------------
void Report::Ranking::Add(double figure, const std::string& what)
{
  this->Worst.emplace_back(figure, what);
  std::sort(this->Worst.rbegin(), this->Worst.rend());
  this->Worst.resize(std::min(this->Worst.size(), CasesOfRanking));
}

//------------------------------------------------------------------------------------------------
void Report::Add(const CaseId& id, const CaseResult& result)
{
  ++this->Cases;
  ++this->Kinds[result.Kind.substr(0, result.Kind.find_first_of("+,"))];
  for (const std::string& feature : FeaturesOf(result.Kind))
  {
    Outcomes& outcomes = this->Features[feature];
    ++(result.Status == CaseStatus::Passed    ? outcomes.Passed
        : result.Status == CaseStatus::Failed ? outcomes.Failed
                                              : outcomes.Refused);
  }
  this->Elements += result.Elements;
  this->Seconds += result.Seconds;
  this->CheckSeconds += result.CheckSeconds;
  this->CasesNonManifold += result.NonManifold > 0 ? 1 : 0;
  this->NonManifold += result.NonManifold;
  this->CasesWithLost += result.Lost > 0 ? 1 : 0;
  if (result.Status == CaseStatus::Refused)
  {
    ++this->Refused;
    ++this->Refusals[Beginning(result.Refusal)];
  }
  if (result.Status == CaseStatus::Failed)
  {
    ++this->FailedCases;
    std::printf("FAILED %s\n", RepeatCommand(id).c_str());
    for (const Finding& f : result.Failures)
    {
      std::printf("  %s: %s\n", f.Cause.c_str(), f.Message.c_str());
      Cause& cause = this->Causes[f.Cause];
      cause.Message = cause.Cases++ == 0 ? f.Message : cause.Message;
      if (cause.First.size() < CasesOfCause)
      {
        cause.First.push_back(id);
      }
    }
  }
  this->Rank(id, result);
  if (WallSeconds() > this->LastLine + SecondsBetweenLines)
  {
    this->LastLine = WallSeconds();
    std::printf("%llu cases, %llu failed, %llu refused\n",
      static_cast<unsigned long long>(this->Cases),
      static_cast<unsigned long long>(this->FailedCases),
      static_cast<unsigned long long>(this->Refused));
  }
  std::fflush(stdout);
}

void Report::Rank(const CaseId& id, const CaseResult& result)
{
  const std::string name =
    Name(id) + " (" + result.Kind + ", " + std::to_string(result.Elements) + " elements)";
  this->Slowest.Add(result.Seconds, name);
  if (result.Elements >= 300)
  {
    this->SlowestPerElement.Add(1e6 * result.Seconds / static_cast<double>(result.Elements), name);
    this->CreatedPerElement.Add(Per(result.Created, result.Elements), name);
  }
  if (result.Vertices >= 100)
  {
    this->OperationsPerVertex.Add(Per(result.Operations, result.Vertices), name);
  }
}

//------------------------------------------------------------------------------------------------
void Report::Print() const
{
  const auto count = [](std::uint64_t n) { return static_cast<unsigned long long>(n); };
  std::printf("\nCases (a case is named DIMENSION:SEED:NUMBER):\n");
  std::printf("  %8llu run, %llu elements, %.1f s of processor time, and %.1f s for checks\n",
    count(this->Cases), count(this->Elements), this->Seconds, this->CheckSeconds);
  for (const auto& [kind, n] : this->Kinds)
  {
    std::printf("  %8llu %s\n", count(n), kind.empty() ? "of unknown kind" : kind.c_str());
  }
  for (const auto& [feature, n] : this->Features)
  {
    std::printf("  %8llu with %s: %llu passed, %llu failed, %llu refused\n",
      count(n.Passed + n.Failed + n.Refused), feature.c_str(), count(n.Passed), count(n.Failed),
      count(n.Refused));
  }
  std::printf("  %8llu refused\n", count(this->Refused));
  for (const auto& [words, n] : this->Refusals)
  {
    std::printf("  %16llu %s...\n", count(n), words.c_str());
  }
  std::printf("  %8llu with edges that are not manifold (%llu edges)\n",
    count(this->CasesNonManifold), count(this->NonManifold));
  std::printf("  %8llu with components listed as lost\n", count(this->CasesWithLost));
  for (const auto& [name, cause] : this->Causes)
  {
    std::printf("  %8llu failed: %s, as", count(cause.Cases), name.c_str());
    for (const CaseId& id : cause.First)
    {
      std::printf(" %s", Name(id).c_str());
    }
    std::printf("\n%18s%s\n", "", cause.Message.c_str());
  }
  for (const Ranking* ranking : { &this->Slowest, &this->SlowestPerElement,
         &this->CreatedPerElement, &this->OperationsPerVertex })
  {
    std::printf("Most %s:\n", ranking->Title.c_str());
    for (const auto& [figure, what] : ranking->Worst)
    {
      std::printf("  %10.4g %s\n", figure, what.c_str());
    }
  }
  std::printf("%llu passed, %llu failed, %llu refused\n",
    count(this->Cases - this->FailedCases - this->Refused), count(this->FailedCases),
    count(this->Refused));
}

} // namespace voxplex::stress
