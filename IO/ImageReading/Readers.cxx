// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Readers.h"

#include "DICOMDataSet.h"

#include <algorithm>
#include <array>
#include <new>
#include <string_view>

namespace voxplex::io
{

void Reading::Tell(double part) const
{
  if (this->Request.Proceed && !this->Request.Proceed(part))
  {
    throw Stopped();
  }
}

ImageAnswer ReadBy(Reader reader, Reading reading)
{
  ImageAnswer answer;
  try
  {
    answer.Image = reader(reading.Request.Path, reading);
  }
  catch (const FileError&)
  {
    throw;
  }
  catch (const std::bad_alloc&)
  {
    Refuse("it does not fit into memory");
  }
  catch (const std::exception& error)
  {
    Refuse("it is damaged (", error.what(), ")");
  }
  answer.Image.HasPlace = reading.HasPlace && reading.PlaceGuesses.empty();
  answer.Image.HasSpacing = reading.SpacingGuesses.empty();
  answer.Image.Unit = reading.Unit;
  static_cast<ImageNotes&>(answer) = std::move(reading);
  return answer;
}

void WarnOfSpacing(Reading& reading)
{
  reading.SpacingGuesses.push_back(
    "its header gives no spacing of the voxels, which is taken to be 1; set it with SetSpacing()");
}

bool IsDICOM(const InputFile& file)
{
  return DICOMDataSet::Recognize(file);
}

bool IsTIFF(const InputFile& file)
{
  constexpr std::array<std::string_view, 4> beginnings{ { { "II*\0", 4 }, { "MM\0*", 4 },
    { "II+\0", 4 }, { "MM\0+", 4 } } };
  return std::find(beginnings.begin(), beginnings.end(), file.Beginning(4)) != beginnings.end();
}

} // namespace voxplex::io
