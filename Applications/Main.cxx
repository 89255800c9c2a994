// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Program.h"

int main(int argc, char* argv[])
{
  return voxplex::cli::RunProgram(argc, argv);
}
