// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "FilesOfFolder.h"

#include "FileError.h"
#include "InputFile.h"

#include <vtkNew.h>
#include <vtkSortFileNames.h>
#include <vtkStringArray.h>

namespace voxplex::io
{

bool IsDICOMFile(const std::string& path)
{
  try
  {
    constexpr std::size_t preamble = 128;
    return InputFile(path).Beginning(preamble + 4).find("DICM", preamble) == preamble;
  }
  catch (const FileError&) // what cannot be opened is no reason to take the folder for one of DICOM
  {
    return false;
  }
}

std::vector<std::string> SortByNumbers(const std::vector<std::string>& names)
{
  vtkNew<vtkStringArray> array;
  for (const std::string& name : names)
  {
    array->InsertNextValue(name);
  }
  vtkNew<vtkSortFileNames> sort;
  sort->NumericSortOn();
  sort->SetInputFileNames(array);
  std::vector<std::string> sorted;
  for (vtkIdType i = 0; i < array->GetNumberOfValues(); ++i)
  {
    sorted.push_back(sort->GetFileNames()->GetValue(i));
  }
  return sorted;
}

} // namespace voxplex::io
