// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Reading.h"

#include "Excerpt.h"

namespace voxplex::io
{

void WarnOfLengths(const std::string& unit, Reading& reading)
{
  for (const char* plain : { "", "mm", "millimeter", "millimetre", "millimeters", "millimetres" })
  {
    if (unit == plain)
    {
      return;
    }
  }
  reading.Warnings.push_back(
    "its lengths are in '" + Excerpt(unit) + "', and so are those of the mesh");
}

} // namespace voxplex::io
