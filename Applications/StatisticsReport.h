// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file StatisticsReport.h
 * @brief What --stats writes, and the paragraph that the program ends with.
 */
#ifndef voxplex_cli_StatisticsReport_h
#define voxplex_cli_StatisticsReport_h

#include "LabelSelection.h"
#include "LabelTable.h"
#include "Parameters.h"

#include <nlohmann/json.hpp>

#include <string>

class vtkMeshingStatistics;
class vtkUnstructuredGrid;

namespace voxplex::io
{
class WholeFiles;
}

namespace voxplex::cli
{

/** What is known of the labels. */
struct LabelReport
{
  ParameterValues Selection; ///< what has labels, see SelectLabels()
  LabelTable Names;
  std::string Source; ///< the file that the names are from; may be empty
};

/** Wall-clock seconds of what happens outside of the filter. */
struct InputOutputTimes
{
  double Read = 0.0;
  double Write = 0.0; ///< mesh and interfaces
};

/**
 * The statistics as Documentation/Reference.md lists them: those of the filter, with times,
 * rates and memory of the whole program and the parameters of the command.
 */
nlohmann::ordered_json MakeReport(vtkMeshingStatistics* statistics, const Parameters& parameters,
  const LabelReport& labels, const InputOutputTimes& times);

/** @throws io::OutputError */
void WriteReport(
  const nlohmann::ordered_json& report, const std::string& path, const io::WholeFiles& files);

/** One paragraph for people, from a report. */
std::string Summarize(const nlohmann::ordered_json& report);

/**
 * One line for people, of a mesh that was there.
 *
 * @param measurement of vtkSimplexMeshQuality; null: it was not measured
 */
std::string SummarizeMesh(vtkUnstructuredGrid* mesh, int dimension,
  const nlohmann::ordered_json& measurement, const InputOutputTimes& times);

} // namespace voxplex::cli

#endif
