// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Findings.h
 * @brief The errors of a mesh: one entry for each invariant that does not hold.
 */
#ifndef voxplex_stress_Findings_h
#define voxplex_stress_Findings_h

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

namespace voxplex::stress
{

/** One invariant that does not hold. */
struct Finding
{
  std::string Cause;   ///< one word for the class of failure; cases are counted and reduced by it
  std::string Message; ///< describes the first place
  std::uint64_t Count = 0;
};

class Findings
{
public:
  void Add(const std::string& cause, const std::string& message)
  {
    const auto at = std::find_if(this->Entries.begin(), this->Entries.end(),
      [&](const Finding& f) { return f.Cause == cause; });
    if (at != this->Entries.end())
    {
      ++at->Count;
      return;
    }
    this->Entries.push_back({ cause, message, 1 });
  }

  bool Has(const std::string& cause) const
  {
    return std::any_of(this->Entries.begin(), this->Entries.end(),
      [&](const Finding& f) { return f.Cause == cause; });
  }

  const std::vector<Finding>& All() const { return this->Entries; }
  bool IsEmpty() const { return this->Entries.empty(); }

private:
  std::vector<Finding> Entries;
};

/** The shortest text with this number of digits. */
inline std::string Text(double x, int digits = 6)
{
  char text[40];
  std::snprintf(text, sizeof(text), "%.*g", digits, x);
  return text;
}

} // namespace voxplex::stress

#endif
