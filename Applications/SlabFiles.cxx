// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "SlabFiles.h"

#include "OutputFiles.h"

#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkSimplexMeshWriter.h>
#include <vtkUnstructuredGrid.h>

#include <filesystem>
#include <utility>

namespace voxplex::cli
{
namespace
{

/** Planes at the ends of the series are none, so there may be no plane. */
int NumberOfPlanes(vtkUnstructuredGrid* mesh)
{
  vtkDataArray* const planes = mesh->GetFieldData()->GetArray("TimePlanes");
  return planes ? static_cast<int>(planes->GetNumberOfTuples()) : 0;
}

} // namespace

SlabFiles::SlabFiles(std::string prefix, const std::string& output)
  : Prefix(std::move(prefix))
  , Extension(output.empty() ? ".vtu" : std::filesystem::path(output).extension().string())
{
}

std::string SlabFiles::NameOf(int slab) const
{
  return this->Prefix + std::to_string(slab) + this->Extension;
}

void SlabFiles::AnnounceFirst(io::WholeFiles& files) const
{
  AnnounceMesh(files, this->NameOf(0));
}

void SlabFiles::AnnounceOthers(io::WholeFiles& files, vtkUnstructuredGrid* mesh) const
{
  for (int slab = 1; slab <= NumberOfPlanes(mesh); ++slab)
  {
    AnnounceMesh(files, this->NameOf(slab));
  }
}

void SlabFiles::Write(
  vtkUnstructuredGrid* mesh, vtkUnstructuredGrid* boundary, const io::WholeFiles& files) const
{
  const int planes = NumberOfPlanes(mesh);
  for (int slab = 0; slab <= planes; ++slab)
  {
    WriteMeshFile(mesh, boundary, vtkSimplexMeshWriter::CONTENT_MESH, this->NameOf(slab), files,
      planes > 0 ? slab : -1);
  }
}

} // namespace voxplex::cli
