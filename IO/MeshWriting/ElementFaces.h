// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ElementFaces.h
 * @brief The faces of tetrahedra that interface triangles are.
 */
#ifndef voxplex_io_ElementFaces_h
#define voxplex_io_ElementFaces_h

#include <vector>

#include <vtkType.h>

namespace voxplex::io
{

class MeshView;

struct ElementFace
{
  vtkIdType Tetrahedron;
  int OppositeVertex; ///< 0 to 3: the vertex of the tetrahedron that the face does not have
};

/**
 * For each triangle the tetrahedron with the first, larger label of its pair. Its normal points out
 * of this tetrahedron. Complexity: expected O(n) in the number of tetrahedra.
 *
 * @throws FileError: a triangle is no face of such a tetrahedron, so these are not the interfaces
 *   of this mesh
 */
std::vector<ElementFace> FindElementFaces(const MeshView& view);

} // namespace voxplex::io

#endif
