// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Reading.h"

#include "Text.h"

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

void WarnOfSpacing(Reading& reading)
{
  reading.Warnings.push_back(
    "its header gives no spacing of the voxels, which is taken to be 1; set it with SetSpacing()");
}

} // namespace voxplex::io
