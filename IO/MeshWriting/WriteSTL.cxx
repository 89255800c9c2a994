// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// The .stl file: binary, all interfaces in one solid; SPACE in the header as 3D Slicer writes it.

#include "VTKWriting.h"
#include "Writers.h"

#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkSTLWriter.h>

namespace voxplex::io
{

void WriteSTL(const MeshData& mesh, const std::string& path)
{
  vtkNew<vtkSTLWriter> writer;
  writer->SetInputData(mesh.Interfaces);
  writer->SetFileTypeToBinary();
  writer->SetHeader(("Voxplex interfaces. SPACE=" + mesh.Space).c_str());
  RunWriter(writer.Get(), path);
}

} // namespace voxplex::io
