// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Outcomes.h
 * @brief How operations on a triangulation end.
 */
#ifndef voxplex_Outcomes_h
#define voxplex_Outcomes_h

namespace voxplex
{

enum class InsertionOutcome
{
  Inserted,
  NoConflict, ///< the point is not in conflict with the given simplex
  Duplicate,  ///< the point is already a vertex
  TooClose,   ///< the point is nearer than the clearance to a vertex that does not give way
  Rejected,   ///< the veto did not accept the new simplices
  Contended   ///< another worker owns a vertex of the cavity
};

enum class RemovalOutcome
{
  Removed,
  OnBox,    ///< the vertex is of kind Box or Shared, and cannot be removed
  Failed,   ///< the star could not be re-triangulated; the triangulation is unchanged
  Contended ///< another worker owns a vertex of the star; the triangulation is unchanged
};

enum class LockOutcome
{
  Locked,
  Dead,     ///< the simplex was deleted
  Contended ///< another worker owns one of its vertices
};

} // namespace voxplex

#endif
