// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Job.h
 * @brief The module's work: a label map in, a mesh and its interfaces out.
 */
#ifndef voxplex_slicer_Job_h
#define voxplex_slicer_Job_h

namespace voxplex::slicer
{

class Arguments;

/**
 * Reads, meshes and writes, and reports its progress to the application that the arguments name, or to
 * standard output. All files appear at the end, or none. Warnings go to std::cerr, a summary to
 * std::cout. Errors of VTK's classes are not printed.
 *
 * @throws cli::RunError, cli::UsageError (formats), Aborted
 */
void RunJob(const Arguments& arguments);

} // namespace voxplex::slicer

#endif
