// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/** @file FuzzImage.cxx @brief vtkSegmentationReader on files with the extension VOXPLEX_FUZZ_EXTENSION. */
#include "Fuzzing.h"

#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkObject.h>
#include <vtkSegmentationReader.h>

#include <array>

namespace fuzz = voxplex::fuzz;

namespace
{

/** Beside the image, for headers that name it: 4 x 4 x 4 voxels of two bytes. */
void WriteData()
{
  const std::array<char, 128> zeros{};
  fuzz::Write(fuzz::PathOf("i.raw"), zeros.data(), zeros.size());
  fuzz::Write(fuzz::PathOf("i.img"), zeros.data(), zeros.size());
}

} // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***)
{
  vtkObject::GlobalWarningDisplayOff();
  WriteData();
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  const std::string path = fuzz::PathOf("i" VOXPLEX_FUZZ_EXTENSION);
  fuzz::Write(path, data, size);
  vtkNew<vtkSegmentationReader> reader;
  reader->SetFileName(path.c_str());
  reader->Update();
  if (!reader->GetErrorMessage().empty())
  {
    fuzz::CheckRefusal(reader->GetErrorMessage(), path);
  }
  else if (reader->GetOutput()->GetNumberOfPoints() == 0)
  {
    fuzz::Fail("an image without voxels was read");
  }
  return 0;
}
