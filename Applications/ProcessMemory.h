// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ProcessMemory.h
 * @brief How the C library manages the memory of a program that meshes.
 */
#ifndef voxplex_cli_ProcessMemory_h
#define voxplex_cli_ProcessMemory_h

namespace voxplex::cli
{

/**
 * Tells the C library to keep freed memory for later allocations, where it can be told (glibc).
 *
 * Every check of the mesh allocates large arrays and frees them. By default, the C library returns
 * each large array to the system, and new arrays get new pages, which the system has to map and to
 * clear. In virtual machines this can take an eighth of the time of a run.
 *
 * Call it first in main(). A library must not call it: the process belongs to someone else.
 */
void KeepFreedMemory();

} // namespace voxplex::cli

#endif
