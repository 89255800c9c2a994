// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SmpThreads.h
 * @brief vtkSMPTools' number of threads, for sources that are C++20.
 *
 * vtkSMPTools.h of VTK 9.0 and 9.1 is not valid C++20 (a constructor named by a template-id), so it
 * is included in one source only, which is compiled as C++17.
 */
#ifndef voxplex_SmpThreads_h
#define voxplex_SmpThreads_h

namespace voxplex
{

/** vtkSMPTools::GetEstimatedNumberOfThreads(), at least 1. */
int SmpThreads();

} // namespace voxplex

#endif
