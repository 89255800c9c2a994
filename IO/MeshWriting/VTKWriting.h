// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file VTKWriting.h
 * @brief Runs one of VTK's writers and turns its failure into an exception.
 */
#ifndef voxplex_io_VTKWriting_h
#define voxplex_io_VTKWriting_h

#include "FileError.h"

#include <vtkErrorCode.h>

#include <cerrno>
#include <cstring>
#include <string>

namespace voxplex::io
{

/** @throws FileError if the writer reports an error, such as a full disk */
template <typename TWriter>
void RunWriter(TWriter* writer, const std::string& path)
{
  errno = 0;
  writer->SetFileName(path.c_str());
  const int done = writer->Write();
  const unsigned long code = writer->GetErrorCode();
  if (!done || code != vtkErrorCode::NoError)
  {
    throw FileError(errno != 0 ? std::strerror(errno) : vtkErrorCode::GetStringFromErrorCode(code));
  }
}

} // namespace voxplex::io

#endif
