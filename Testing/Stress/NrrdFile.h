// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file NrrdFile.h
 * @brief Writes the image of a case as a file that voxplex reads.
 */
#ifndef voxplex_stress_NrrdFile_h
#define voxplex_stress_NrrdFile_h

#include "Volume.h"

#include <string>

namespace voxplex::stress
{

/**
 * Raw NRRD: labels as int32, grey values as float. In 4D the time step is 1, so voxplex's
 * --time-scale is the length of a frame.
 * @throws std::runtime_error
 */
template <int D>
void WriteNrrd(const Volume<D>& image, const std::string& path);

} // namespace voxplex::stress

#endif
