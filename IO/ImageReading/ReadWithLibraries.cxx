// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Readers.h"

#include <filesystem>

namespace voxplex::io
{

ScalarImage ReadWithLibraries(const std::string& path, Reading& reading)
{
  if (std::error_code ignored; std::filesystem::is_directory(path, ignored))
  {
    const std::vector<std::string> slices =
      reading.Request.Series.empty() ? ListSlices(path) : std::vector<std::string>();
    return slices.empty() ? ReadDICOMFolder(path, reading) : ReadSlices(slices, reading);
  }
  const InputFile file(path);
  return IsDICOM(file) ? ReadDICOMFile(path, reading)
    : IsTIFF(file)     ? ReadTIFF(path, reading)
                       : ReadVTK(path, reading);
}

} // namespace voxplex::io
