// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "MeshFile.h"

#include "Errors.h"
#include "OutputFiles.h"

#include <vtkDataObject.h>
#include <vtkNew.h>
#include <vtkSimplexMeshWriter.h>

namespace voxplex::cli
{

void WriteMeshFile(vtkDataObject* mesh, vtkDataObject* interfaces, int content,
  const std::string& path, const OutputFiles& files)
{
  vtkNew<vtkSimplexMeshWriter> writer;
  writer->SetInputData(0, mesh);
  if (interfaces)
  {
    writer->SetInputData(1, interfaces);
  }
  writer->SetContent(content);
  writer->SetFileName(path.c_str());
  writer->SetTemporaryFileName(files.TemporaryPath(path).c_str());
  const std::string companion = vtkSimplexMeshWriter::CompanionOf(path);
  if (!companion.empty())
  {
    writer->SetTemporaryCompanionFileName(files.TemporaryPath(companion).c_str());
  }
  if (!writer->Write())
  {
    throw RunError(writer->GetErrorMessage());
  }
}

} // namespace voxplex::cli
