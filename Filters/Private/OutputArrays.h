// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file OutputArrays.h
 * @brief What outputs of 3D and 4D meshes are made of: points, cells, labels, by several threads.
 */
#ifndef voxplex_OutputArrays_h
#define voxplex_OutputArrays_h

#include "Base/UninitialisedVector.h"
#include "Mesh/SimplexMesh.h"
#include "Parallel/ChunkCounts.h"
#include "Parallel/ParallelFor.h"

#include "vtkCellArray.h"
#include "vtkDoubleArray.h"
#include "vtkIdTypeArray.h"
#include "vtkIntArray.h"
#include "vtkLongLongArray.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkSmartPointer.h"
#include "vtkTypeInt64Array.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <tuple>
#include <type_traits>
#include <utility>

namespace voxplex
{

/** Points or cells that a thread takes at a time; fewer do not pay for starting one. */
inline constexpr std::size_t OutputGrain = 32768;

/** Releases a vector's memory. */
template <typename T>
void Release(UninitialisedVector<T>& v)
{
  UninitialisedVector<T>().swap(v);
}

/** n points, the i-th of which lies at position(i), a Point<3>. */
template <typename PositionAt>
vtkSmartPointer<vtkPoints> MakePoints(std::size_t n, unsigned threads, PositionAt&& position)
{
  vtkNew<vtkDoubleArray> coordinates;
  coordinates->SetNumberOfComponents(3);
  coordinates->SetNumberOfTuples(static_cast<vtkIdType>(n));
  double* const out = coordinates->GetPointer(0);
  ParallelFor(0, n, OutputGrain, threads,
    [&](std::size_t first, std::size_t last)
    {
      for (std::size_t i = first; i < last; ++i)
      {
        const Point<3> x = position(i);
        std::copy(x.begin(), x.end(), out + 3 * i);
      }
    });
  auto result = vtkSmartPointer<vtkPoints>::New();
  result->SetData(coordinates);
  return result;
}

/** Cells of N vertices each; `flip` lets the last two change places. */
template <typename Cells, typename PointId>
vtkSmartPointer<vtkCellArray> MakeCells(
  const Cells& cells, bool flip, unsigned threads, PointId&& pointId)
{
  constexpr std::size_t N = std::tuple_size_v<typename Cells::value_type>;
  vtkNew<vtkTypeInt64Array> offsets; // by SetData(N, connectivity) it would be made by one thread
  offsets->SetNumberOfValues(static_cast<vtkIdType>(cells.size() + 1));
  vtkNew<vtkTypeInt64Array> connectivity;
  connectivity->SetNumberOfValues(static_cast<vtkIdType>(cells.size() * N));
  vtkTypeInt64* const begin = offsets->GetPointer(0);
  vtkTypeInt64* const ids = connectivity->GetPointer(0);
  ParallelFor(0, cells.size(), OutputGrain, threads,
    [&](std::size_t first, std::size_t last)
    {
      for (std::size_t c = first; c < last; ++c)
      {
        begin[c] = static_cast<vtkTypeInt64>(c * N);
        vtkTypeInt64* const out = ids + c * N;
        for (std::size_t i = 0; i < N; ++i)
        {
          out[i] = pointId(cells[c][i]);
        }
        if (flip)
        {
          std::swap(out[N - 2], out[N - 1]);
        }
      }
    });
  begin[cells.size()] = static_cast<vtkTypeInt64>(cells.size() * N);
  auto result = vtkSmartPointer<vtkCellArray>::New();
  result->SetData(offsets, connectivity);
  return result;
}

/** Labels of one or two components, as Array. */
template <typename Array, typename Values>
vtkSmartPointer<vtkDataArray> CopyLabels(const Values& values, const char* name, unsigned threads)
{
  auto result = vtkSmartPointer<Array>::New();
  result->SetName(name);
  constexpr bool isPair = !std::is_arithmetic_v<typename Values::value_type>;
  result->SetNumberOfComponents(isPair ? 2 : 1);
  result->SetNumberOfTuples(static_cast<vtkIdType>(values.size()));
  auto* const out = result->GetPointer(0);
  using Value = typename Array::ValueType;
  ParallelFor(0, values.size(), OutputGrain, threads,
    [&](std::size_t first, std::size_t last)
    {
      for (std::size_t i = first; i < last; ++i)
      {
        if constexpr (isPair)
        {
          out[2 * i] = static_cast<Value>(values[i][0]);
          out[2 * i + 1] = static_cast<Value>(values[i][1]);
        }
        else
        {
          out[i] = static_cast<Value>(values[i]);
        }
      }
    });
  return result;
}

/** Whether int holds all of these labels. */
template <typename Values>
bool FitInt(const Values& labels)
{
  const auto largest = std::max_element(labels.begin(), labels.end());
  return largest == labels.end() || *largest <= std::numeric_limits<int>::max();
}

/** Labels of one or two components, as ints if they fit. */
template <typename Values>
vtkSmartPointer<vtkDataArray> MakeLabels(
  const Values& values, const char* name, bool fitInt, unsigned threads)
{
  return fitInt ? CopyLabels<vtkIntArray>(values, name, threads)
                : CopyLabels<vtkLongLongArray>(values, name, threads);
}

/** Numbers of the interfaces' points in the order of the mesh's points, which keeps neighbours near. */
template <int D>
class InterfacePoints
{
public:
  InterfacePoints(const SimplexMesh<D>& mesh, unsigned threads)
    : Numbers(mesh.Points.size())
  {
    const std::size_t n = this->Numbers.size();
    ParallelFor(0, n, OutputGrain, threads,
      [this](std::size_t first, std::size_t last)
      { std::fill(this->Numbers.data() + first, this->Numbers.data() + last, Unused); });
    ParallelFor(0, mesh.Facets.size(), OutputGrain, threads,
      [&](std::size_t first, std::size_t last)
      {
        for (std::size_t f = first; f < last; ++f)
        {
          for (const std::uint32_t id : mesh.Facets[f])
          {
            // Relaxed: all write the same, and the loop's end comes before it is read.
            std::atomic_ref<vtkTypeInt64>(this->Numbers[id]).store(0, std::memory_order_relaxed);
          }
        }
      });
    ChunkCounts places(n);
    ParallelFor(0, n, ChunkCounts::Grain, threads,
      [&](std::size_t first, std::size_t last)
      {
        const vtkTypeInt64* const numbers = this->Numbers.data();
        places.OfChunk(first) = last - first -
          static_cast<std::size_t>(std::count(numbers + first, numbers + last, Unused));
      });
    this->Ids->SetName("PointIds");
    this->Ids->SetNumberOfValues(static_cast<vtkIdType>(places.TurnIntoPlaces()));
    vtkIdType* const ids = this->Ids->GetPointer(0);
    ParallelFor(0, n, ChunkCounts::Grain, threads,
      [&](std::size_t first, std::size_t last)
      {
        std::size_t place = places.OfChunk(first);
        for (std::size_t id = first; id < last; ++id)
        {
          if (this->Numbers[id] != Unused)
          {
            this->Numbers[id] = static_cast<vtkTypeInt64>(place);
            ids[place++] = static_cast<vtkIdType>(id);
          }
        }
      });
  }

  /** Of a point of the mesh that an interface uses. */
  vtkTypeInt64 Number(std::uint32_t id) const { return this->Numbers[id]; }
  /** The mesh's point of each. */
  vtkIdTypeArray* MeshIds() const { return this->Ids; }

private:
  static constexpr vtkTypeInt64 Unused = -1;
  UninitialisedVector<vtkTypeInt64> Numbers;
  vtkNew<vtkIdTypeArray> Ids;
};

} // namespace voxplex

#endif
