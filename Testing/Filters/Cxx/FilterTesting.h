// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FilterTesting.h
 * @brief What the filter tests share: checks that count, phantoms, mesh invariants, error
 * collection.
 */
#ifndef FilterTesting_h
#define FilterTesting_h

#include "vtkCommand.h"
#include "vtkImageToTetMeshFilter.h"
#include "vtkSmartPointer.h"
#include "vtkType.h"

#include <array>
#include <functional>
#include <iostream>
#include <string>
#include <vector>

class vtkImageData;
class vtkPolyData;
class vtkUnstructuredGrid;

namespace testing
{

using Vector = std::array<double, 3>;

/** Failed checks so far; a test returns Result(). */
int& Failures();
int Result();

/** Counts and prints a check that does not hold; unlike assert() also in release builds. */
#define CHECK(condition, ...)                                                                      \
  ((condition)                                                                                     \
      ? true                                                                                       \
      : (::testing::Report(__FILE__, __LINE__, #condition __VA_OPT__(, ) __VA_ARGS__), false))

template <typename... Rest>
void Report(const char* file, int line, const char* condition, const Rest&... rest)
{
  ++Failures();
  std::cerr << file << ":" << line << ": failed: " << condition;
  ((std::cerr << " | " << rest), ...);
  std::cerr << "\n";
}

/** How an image lies in space; by default unit voxels at the origin. */
struct Placement
{
  std::array<int, 6> Extent = { 0, 31, 0, 31, 0, 31 };
  Vector Origin = { 0, 0, 0 };
  Vector Spacing = { 1, 1, 1 };
  std::array<double, 9> Direction = { 1, 0, 0, 0, 1, 0, 0, 0, 1 }; ///< rows
  bool Cells = false; ///< labels on cells; the extent stays that of the points
};

/**
 * An image whose value at the physical position x of each voxel is label(x). Positions come from
 * VTK's own index-to-physical transform, so they do not share code with the filter. The scalars are
 * of this VTK type and are called "Segmentation".
 */
vtkSmartPointer<vtkImageData> MakeImage(const Placement& placement,
  const std::function<double(const Vector& x)>& label, int type = VTK_UNSIGNED_CHAR);

/** Unit voxels, 32^3, a ball of this radius and label in the middle (15.5, 15.5, 15.5). */
vtkSmartPointer<vtkImageData> MakeBall(double radius = 10.0, double label = 1.0);

/** The same ball, label 1 where x < 15.5, label 2 elsewhere. */
vtkSmartPointer<vtkImageData> MakeTwoLabels(double radius = 10.0);

/** A filter on this image, one thread. */
vtkSmartPointer<vtkImageToTetMeshFilter> MakeFilter(vtkImageData* image);

/** Collects the text of error events of an algorithm, keeps them off the screen and counts them. */
class ErrorCollector : public vtkCommand
{
public:
  static ErrorCollector* New() { return new ErrorCollector; }
  void Execute(vtkObject* caller, unsigned long event, void* data) override;
  /** Watches the filter and its executive. */
  void Watch(vtkAlgorithm* algorithm);

  std::vector<std::string> FromFilter;
  std::vector<std::string> FromOthers;

private:
  vtkAlgorithm* Filter = nullptr;
};

/**
 * The filter must fail with one message of its own that has all of these words in it. Then, with
 * `repair` undoing the damage, it must work.
 */
void ExpectError(const char* name, vtkImageToSimplexMeshFilter* filter,
  const std::vector<std::string>& words, const std::function<void()>& repair = nullptr);

/** Calls a function with the fraction on each progress event. */
vtkSmartPointer<vtkCommand> Observe(
  vtkAlgorithm* filter, std::function<void(vtkAlgorithm*, double)> function);

double Volume(const Vector& a, const Vector& b, const Vector& c, const Vector& d);

struct Circumball
{
  Vector Centre;
  double Radius;
};
Circumball CircumballOf(const std::array<Vector, 4>& tetrahedron);

/** The mesh of a vtkUnstructuredGrid in plain arrays. */
struct Tetrahedra
{
  std::vector<Vector> Points;
  std::vector<std::array<vtkIdType, 4>> Cells;
  std::vector<long long> Labels;

  std::array<Vector, 4> Corners(std::size_t cell) const;
  /** Sum of the volumes of one label, or of all for label 0. */
  double VolumeOf(long long label = 0) const;
  /** Centroid of everything. */
  Vector Centroid() const;
};
Tetrahedra Read(vtkUnstructuredGrid* grid);

/**
 * Checks all that holds for every mesh: array names and types, positive tetrahedra, no unused or
 * double point, conforming, the interfaces exactly the faces between labels, each with its labels,
 * its normal out of the first label, and its points those of the volume mesh.
 */
void CheckMesh(vtkImageToTetMeshFilter* filter);

/** Whether two meshes are the same in every bit. */
bool SameMesh(vtkUnstructuredGrid* a, vtkUnstructuredGrid* b);
bool SameMesh(vtkPolyData* a, vtkPolyData* b);

/** Whether both outputs are empty. */
bool Empty(vtkImageToSimplexMeshFilter* filter);

} // namespace testing

#endif
