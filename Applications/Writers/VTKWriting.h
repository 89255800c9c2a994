// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file VTKWriting.h
 * @brief Runs one of VTK's writers and turns its failure into an exception.
 */
#ifndef voxplex_cli_VTKWriting_h
#define voxplex_cli_VTKWriting_h

#include "Errors.h"

#include <vtkErrorCode.h>

#include <cerrno>
#include <cstring>
#include <string>

namespace voxplex::cli
{

/** @throws RunError if the writer reports an error, such as a full disk */
template <typename TWriter>
void RunWriter(TWriter* writer, const std::string& path)
{
  errno = 0;
  writer->SetFileName(path.c_str());
  const int done = writer->Write();
  const unsigned long code = writer->GetErrorCode();
  if (!done || code != vtkErrorCode::NoError)
  {
    throw RunError(errno != 0 ? std::strerror(errno) : vtkErrorCode::GetStringFromErrorCode(code));
  }
}

} // namespace voxplex::cli

#endif
