// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshReport.h
 * @brief The outcome of a mesh comparison, for people and for programs.
 */
#ifndef voxplex_MeshReport_h
#define voxplex_MeshReport_h

#include "MeshComparison.h"

#include <ostream>

namespace voxplex::benchmarks
{

/** A table on standard output: medians side by side, and ratios of `left` to `right`
 * (Statistics.h). */
void PrintTable(const Contestant& left, const Contestant& right);

/** A table on standard output: the medians of `one`, and how far the runs of `many` spread. */
void PrintSpread(const Contestant& one, const Contestant& many);

/** Size, medians and all runs as a JSON object; keys are those of `voxplex --stats` where these have
 * them. */
void WriteJson(std::ostream& stream, const Contestant& contestant);

/** Medians of the ratios of `left` to `right`, as a JSON object with the same keys; 0 unless both ran. */
void WriteRatios(std::ostream& stream, const Contestant& left, const Contestant& right);

} // namespace voxplex::benchmarks

#endif
