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
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkType.h"
#include "vtkUnstructuredGrid.h"

#include <array>
#include <functional>
#include <iostream>
#include <string>
#include <vector>

class vtkImageData;

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

template <std::size_t D>
using Simplex = std::array<std::array<double, D>, D + 1>;

/** Signed; positive for a simplex in positive order. */
template <std::size_t D>
double Volume(const Simplex<D>& simplex);

/** The mesh of a vtkUnstructuredGrid in plain arrays; the last of four coordinates is the time. */
template <std::size_t D>
struct Simplices
{
  std::vector<std::array<double, D>> Points;
  std::vector<std::array<vtkIdType, D + 1>> Cells;
  std::vector<long long> Labels;

  Simplex<D> Corners(std::size_t cell) const;
  /** Sum of the volumes of one label, or of all for label 0. */
  double VolumeOf(long long label = 0) const;
  /** Centroid of everything. */
  std::array<double, D> Centroid() const;
};
using Tetrahedra = Simplices<3>;
using Pentatopes = Simplices<4>;
Tetrahedra Read(vtkUnstructuredGrid* grid);
Pentatopes ReadPentatopes(vtkUnstructuredGrid* grid);

/**
 * Checks all that holds for every mesh: array names, cell and array types, positive simplices, no unused or
 * double point, conforming, the second output exactly the facets between labels, each with its labels, its
 * order, which puts the normal outside of the first label, and its points, and closed around each label.
 */
void CheckMesh(vtkImageToSimplexMeshFilter* filter);

/** Whether two meshes, or both outputs of two filters, are the same in every bit. */
bool SameMesh(vtkPointSet* a, vtkPointSet* b);
bool SameMesh(vtkImageToSimplexMeshFilter* a, vtkImageToSimplexMeshFilter* b);

/** Whether both outputs are empty. */
bool Empty(vtkImageToSimplexMeshFilter* filter);

} // namespace testing

#endif
