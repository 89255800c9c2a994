// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshingMessages.h
 * @brief Failures, refusals and warnings of filters, for InTermsOf() (MeshingParameters.h); without VTK.
 */
#ifndef voxplex_MeshingMessages_h
#define voxplex_MeshingMessages_h

#include "Base/Error.h"
#include "Mesher/MeshingStatistics.h"

#include <cstdint>
#include <exception>
#include <map>
#include <new>
#include <span>
#include <string>
#include <system_error>
#include <vector>

namespace voxplex
{

/**
 * Calls work().
 * @param outOfMemory what to say if there is not enough of it
 * @param failed begins what to say of exceptions that are no Error
 * @param isStopped receives whether Cancelled was thrown, which is no failure
 * @return the message for the user, for InTermsOf(); empty if nothing was thrown
 */
template <typename Work>
std::string CatchFailure(
  Work&& work, const char* outOfMemory, const std::string& failed, bool* isStopped = nullptr)
{
  try
  {
    work();
  }
  catch (const Error& error)
  {
    return error.what();
  }
  catch (const Cancelled& cancelled)
  {
    if (!isStopped)
    {
      return failed + cancelled.what();
    }
    *isStopped = true;
  }
  catch (const std::bad_alloc&)
  {
    return outOfMemory;
  }
  catch (const std::system_error& error)
  {
    const bool isThread = error.code() == std::errc::resource_unavailable_try_again;
    return failed +
      (isThread
          ? "a thread cannot be started; raise the limits of processes and memory (ulimit -u, "
            "-v), or lower {threads}."
          : error.what());
  }
  catch (const std::exception& error)
  {
    return failed + error.what();
  }
  catch (...) // of a size function; nothing else throws such things
  {
    return failed + "the size function threw something that is not a std::exception.";
  }
  return {};
}

///@{
/** What CatchFailure() is told of meshing. */
inline constexpr const char* NoMemoryForMesh =
  "There is not enough memory for this mesh; increase {delta}, or mesh fewer labels.";
inline constexpr const char* MeshingFailed = "Meshing failed: ";
///@}

/** Throws InputError unless low <= value <= high; `must` says what it must be. */
void CheckRange(double value, double low, double high, const char* name, const char* must);

/**
 * Throws InputError if the value is not in the range that the table of parameters has.
 * @param name in the table
 * @param force whether limits that Force lifts are lifted
 */
void CheckValue(const char* name, double value, bool force = false);

/** At most 20 labels, separated by commas. */
std::string ListLabels(std::span<const std::int64_t> labels);

/**
 * Throws InputError if a label was given a size but is not among those of the image.
 * @param method by which it was given
 * @param selected whether a part of the image's labels is meshed
 */
void CheckSizedLabel(std::int64_t label, const std::string& method, bool selected,
  std::span<const std::int64_t> labels);

/** Throws InputError if nothing was meshed. */
void CheckNotEmpty(const MeshingStatistics& run);

/**
 * How the mesh differs from what was asked for, a sentence or two each.
 * @param names of labels
 * @param contentionManager the one that was asked for
 * @param exactComponents whether ExactComponents was asked for: no warning suggests it then
 */
std::vector<std::string> WarningsOf(const MeshingStatistics& run,
  const std::map<std::int64_t, std::string>& names, const std::string& contentionManager,
  bool exactComponents);

} // namespace voxplex

#endif
