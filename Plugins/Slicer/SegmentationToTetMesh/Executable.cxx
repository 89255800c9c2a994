// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// The module as a process of its own. Ctrl-C removes what is not complete, and VTK's classes do not print:
// what matters reaches the user as the module's own message.

#include "Interruption.h"
#include "Module.h"
#include "ProcessMemory.h"

#include <vtkObject.h>

int main(int argc, char* argv[])
{
  voxplex::cli::KeepFreedMemory();
  voxplex::cli::Interruption::Install();
  vtkObject::GlobalWarningDisplayOff();
  return ModuleEntryPoint(argc, argv);
}
