// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "OutputFiles.h"

#include "FileError.h"
#include "Interruption.h"
#include "WholeFiles.h"

#include <vtkDataObject.h>
#include <vtkNew.h>
#include <vtkSimplexMeshWriter.h>

namespace voxplex::cli
{

void AnnounceFile(io::WholeFiles& files, const std::string& path)
{
  if (path.empty())
  {
    return;
  }
  const Interruption::Deferral deferral;
  files.Add(path);
  Interruption::AddTemporary(files.TemporaryPath(path));
}

void AnnounceMesh(io::WholeFiles& files, const std::string& path)
{
  if (path.empty())
  {
    return;
  }
  const std::string companion = vtkSimplexMeshWriter::CompanionOf(path);
  const Interruption::Deferral deferral;
  files.Add(path, companion);
  Interruption::AddTemporary(files.TemporaryPath(path));
  if (!companion.empty())
  {
    Interruption::AddTemporary(files.TemporaryPath(companion));
  }
}

void WriteMeshFile(vtkDataObject* mesh, vtkDataObject* interfaces, int content,
  const std::string& path, const io::WholeFiles& files, int slab, bool compress)
{
  if (path.empty())
  {
    return;
  }
  vtkNew<vtkSimplexMeshWriter> writer;
  writer->SetInputData(0, mesh);
  if (interfaces)
  {
    writer->SetInputData(1, interfaces);
  }
  writer->SetContent(content);
  writer->SetSlab(slab);
  writer->SetCompress(compress);
  writer->SetFileName(path.c_str());
  writer->SetTemporaryFileName(files.TemporaryPath(path).c_str());
  const std::string companion = vtkSimplexMeshWriter::CompanionOf(path);
  if (!companion.empty())
  {
    writer->SetTemporaryCompanionFileName(files.TemporaryPath(companion).c_str());
  }
  if (!writer->Write())
  {
    throw io::FileError(writer->GetErrorMessage());
  }
}

void CommitFiles(io::WholeFiles& files)
{
  const Interruption::Deferral deferral;
  files.Commit();
}

} // namespace voxplex::cli
