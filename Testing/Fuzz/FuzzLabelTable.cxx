// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/** @file FuzzLabelTable.cxx @brief Tables of labels, of all formats. */
#include "FileError.h"
#include "Fuzzing.h"
#include "LabelTables/LabelTableFile.h"

namespace fuzz = voxplex::fuzz;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  static const std::string path = fuzz::PathOf("table.txt");
  fuzz::Write(path, data, size);
  try
  {
    const voxplex::LabelTable table = voxplex::io::ReadLabelTableFile(path);
    for (const auto& [label, entry] : table.Entries)
    {
      if (label <= 0 || entry.Name.empty() || !voxplex::IsUTF8(entry.Name))
      {
        fuzz::Fail("label " + std::to_string(label) + " has the name '" + entry.Name + "'");
      }
      for (const double part : entry.Color.value_or(std::array<double, 3>{}))
      {
        if (!(part >= 0 && part <= 1))
        {
          fuzz::Fail("a part of a colour is " + std::to_string(part));
        }
      }
    }
  }
  catch (const voxplex::io::FileError& error)
  {
    fuzz::CheckRefusal(error.what(), path);
  }
  return 0;
}
