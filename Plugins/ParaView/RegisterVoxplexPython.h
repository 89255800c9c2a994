// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#ifndef RegisterVoxplexPython_h
#define RegisterVoxplexPython_h

/** Makes voxplex_paraview.py, which the plugin carries, a module that ParaView's Python imports. */
void RegisterVoxplexPython();

#endif
