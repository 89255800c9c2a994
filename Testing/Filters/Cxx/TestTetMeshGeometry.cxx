// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// The mesh lies where the image lies: a ball given in physical space is sampled on grids that are
// shifted, anisotropic, rotated, left-handed and skewed; the mesh must always be that ball.
#include "FilterTesting.h"

#include "vtkImageData.h"
#include "vtkMath.h"
#include "vtkMatrix3x3.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <cmath>

using namespace testing;

namespace
{

const Vector Centre = { -31.0, 12.0, 205.0 };
constexpr double Radius = 9.0;

double BallLabel(const Vector& x)
{
  return std::hypot(x[0] - Centre[0], x[1] - Centre[1], x[2] - Centre[2]) < Radius ? 1.0 : 0.0;
}

/** Rows of a rotation about an oblique axis. */
std::array<double, 9> Rotation()
{
  const double a = 0.7;
  const double b = -0.4;
  const double ca = std::cos(a), sa = std::sin(a), cb = std::cos(b), sb = std::sin(b);
  return { ca, -sa * cb, sa * sb, sa, ca * cb, -ca * sb, 0, sb, cb };
}

/** Moves the origin so that the grid's middle is the ball's centre. */
Placement Centred(Placement p)
{
  Vector middle;
  for (std::size_t a = 0; a < 3; ++a)
  {
    middle[a] = p.Spacing[a] * 0.5 * (p.Extent[2 * a] + p.Extent[2 * a + 1]);
  }
  for (std::size_t r = 0; r < 3; ++r)
  {
    p.Origin[r] = Centre[r];
    for (std::size_t c = 0; c < 3; ++c)
    {
      p.Origin[r] -= p.Direction[3 * r + c] * middle[c];
    }
  }
  return p;
}

void TestPlacement(const char* name, const Placement& placement)
{
  const Placement p = Centred(placement);
  const auto filter = MakeFilter(MakeImage(p, BallLabel));
  filter->SetDelta(1.0);
  filter->Update();
  CheckMesh(filter); // positive tetrahedra and outward normals in physical space
  const Tetrahedra mesh = Read(filter->GetOutput());
  const double truth = 4.0 / 3.0 * vtkMath::Pi() * std::pow(Radius, 3);
  CHECK(std::abs(mesh.VolumeOf() / truth - 1.0) < 0.05, name, mesh.VolumeOf(), truth);
  const Vector centroid = mesh.Centroid();
  const double voxel = *std::max_element(p.Spacing.begin(), p.Spacing.end());
  for (std::size_t a = 0; a < 3; ++a)
  {
    CHECK(std::abs(centroid[a] - Centre[a]) < 0.15 * voxel, name, a, centroid[a]);
  }
  vtkPolyData* interfaces = filter->GetInterfaces();
  double worst = 0.0;
  double sum = 0.0;
  for (vtkIdType i = 0; i < interfaces->GetNumberOfPoints(); ++i)
  {
    Vector x;
    interfaces->GetPoint(i, x.data());
    const double r = std::hypot(x[0] - Centre[0], x[1] - Centre[1], x[2] - Centre[2]);
    worst = std::max(worst, std::abs(r - Radius));
    sum += std::abs(r - Radius);
  }
  CHECK(worst < voxel, name, worst);
  CHECK(sum / static_cast<double>(interfaces->GetNumberOfPoints()) < 0.2 * voxel, name, sum);
}

/** A direction stored in single precision, as many files do, must not make the grid skewed. */
void TestRoundedDirection()
{
  Placement exact;
  exact.Direction = Rotation();
  exact = Centred(exact);
  Placement rounded = exact;
  for (double& c : rounded.Direction)
  {
    c = static_cast<double>(static_cast<float>(c));
  }
  const auto filterA = MakeFilter(MakeImage(exact, BallLabel));
  const auto filterB = MakeFilter(MakeImage(rounded, BallLabel));
  filterA->Update();
  filterB->Update();
  const Tetrahedra a = Read(filterA->GetOutput());
  const Tetrahedra b = Read(filterB->GetOutput());
  CHECK(std::abs(a.VolumeOf() / b.VolumeOf() - 1.0) < 0.01, a.VolumeOf(), b.VolumeOf());
  CHECK(std::abs(double(a.Cells.size()) / double(b.Cells.size()) - 1.0) < 0.1, a.Cells.size(),
    b.Cells.size());
}

/** Moving the extent and the origin against each other changes nothing at all. */
void TestExtentOffset()
{
  Placement plain;
  Placement shifted;
  shifted.Extent = { -4, 27, 100, 131, 8, 39 };
  shifted.Origin = { 4, -100, -8 };
  const auto label = [](const Vector& x)
  { return std::hypot(x[0] - 15.5, x[1] - 15.5, x[2] - 15.5) < 9.0 ? 1.0 : 0.0; };
  const auto a = MakeFilter(MakeImage(plain, label));
  const auto b = MakeFilter(MakeImage(shifted, label));
  a->Update();
  b->Update();
  CheckMesh(b);
  CHECK(SameMesh(a->GetOutput(), b->GetOutput()));
  CHECK(SameMesh(a->GetInterfaces(), b->GetInterfaces()));
}

/** Cell scalars lie at the cell centres: half a voxel from point scalars of the same values. */
void TestCellsAgainstPoints()
{
  Placement points;
  points.Origin = { 0.5, 0.5, 0.5 };
  Placement cells;
  cells.Extent = { 0, 32, 0, 32, 0, 32 };
  cells.Cells = true;
  const auto label = [](const Vector& x)
  { return std::hypot(x[0] - 16, x[1] - 16, x[2] - 16) < 9.0 ? (x[2] < 14 ? 1.0 : 2.0) : 0.0; };
  const auto a = MakeFilter(MakeImage(points, label));
  const auto b = MakeFilter(MakeImage(cells, label));
  a->Update();
  b->Update();
  CheckMesh(b);
  CHECK(SameMesh(a->GetOutput(), b->GetOutput()));
}

} // namespace

int TestTetMeshGeometry(int, char*[])
{
  Placement plain;
  TestPlacement("plain", plain);

  Placement anisotropic;
  anisotropic.Spacing = { 0.7, 1.0, 1.6 };
  TestPlacement("anisotropic", anisotropic);

  Placement rotated = anisotropic;
  rotated.Direction = Rotation();
  TestPlacement("rotated", rotated);

  Placement leftHanded = rotated;
  for (std::size_t r = 0; r < 3; ++r)
  {
    leftHanded.Direction[3 * r + 1] *= -1.0;
  }
  TestPlacement("left-handed", leftHanded);

  Placement mirrored; // as NIfTI and DICOM often store it
  mirrored.Direction = { -1, 0, 0, 0, -1, 0, 0, 0, -1 };
  TestPlacement("mirrored", mirrored);

  Placement permuted;
  permuted.Direction = { 0, 0, 1, 1, 0, 0, 0, 1, 0 };
  TestPlacement("permuted", permuted);

  Placement skewed; // a gantry tilt
  skewed.Direction = { 1, 0, 0, 0, 1, std::sin(0.35), 0, 0, std::cos(0.35) };
  TestPlacement("skewed", skewed);

  Placement skewedLeft = skewed;
  skewedLeft.Direction[0] = -1.0;
  skewedLeft.Spacing = { 1.0, 0.8, 1.3 };
  TestPlacement("skewed left-handed", skewedLeft);

  Placement cells = rotated;
  cells.Cells = true;
  TestPlacement("cells", cells);

  Placement offset = rotated;
  offset.Extent = { 10, 41, -50, -19, 3, 34 };
  TestPlacement("offset", offset);

  Placement offsetCells = offset;
  offsetCells.Cells = true;
  TestPlacement("offset cells", offsetCells);

  TestRoundedDirection();
  TestExtentOffset();
  TestCellsAgainstPoints();
  return Result();
}
