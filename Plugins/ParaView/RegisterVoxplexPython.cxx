// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "RegisterVoxplexPython.h"

#include "voxplex_paraview_source.h"

#include "vtkNew.h"
#include "vtkPVPythonModule.h"

void RegisterVoxplexPython()
{
  vtkNew<vtkPVPythonModule> module;
  module->SetFullName("voxplex_paraview");
  module->SetSource(voxplex_paraview_source);
  vtkPVPythonModule::RegisterModule(module);
}
