// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshReport.h
 * @brief The result of a mesh comparison, as tables and as JSON.
 */
#ifndef voxplex_MeshReport_h
#define voxplex_MeshReport_h

#include "MeshComparison.h"

#include <ostream>

namespace voxplex::benchmarks
{

/**
 * Prints a table on standard output: medians side by side, and ratios of `left` to `right`
 * (Statistics.h).
 */
void PrintTable(const Contestant& left, const Contestant& right);

/** Prints a table on standard output: the medians of `one`, and the range of the runs of `many`. */
void PrintSpread(const Contestant& one, const Contestant& many);

/**
 * Writes size, medians and all runs as a JSON object. Where possible, keys are those of `voxplex
 * --stats`.
 */
void WriteJson(std::ostream& stream, const Contestant& contestant);

/**
 * Writes medians of the ratios of `left` to `right` as a JSON object with the same keys; 0 unless
 * both ran.
 */
void WriteRatios(std::ostream& stream, const Contestant& left, const Contestant& right);

} // namespace voxplex::benchmarks

#endif
