// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Image/Components.h"

#include "Base/DisjointSets.h"
#include "Base/Error.h"
#include "Base/GridIndex.h"
#include "Parallel/ParallelFor.h"

#include <algorithm>
#include <cmath>

namespace voxplex
{

namespace
{

/** For each axis, the area of a voxel's face that this axis crosses. */
template <int D>
Point<D> FaceAreas(const GridGeometry<D>& grid)
{
  // The height of a voxel over face a is 1 / VoxelsPerLength().
  Point<D> areas = grid.VoxelsPerLength();
  for (double& area : areas)
  {
    area *= grid.VoxelVolume();
  }
  return areas;
}

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
auto Components<D>::RunIndex(std::size_t run) const -> Index
{
  const auto after = std::upper_bound(
    this->FirstOfRow.begin(), this->FirstOfRow.end(), static_cast<std::uint32_t>(run));
  const auto row = static_cast<std::size_t>(after - this->FirstOfRow.begin() - 1);
  Index index = IndexAt(row * static_cast<std::size_t>(this->Dimensions[0]), this->Dimensions);
  index[0] = this->Runs[run].Start;
  return index;
}

//------------------------------------------------------------------------------------------------
// Every row has a run that starts at 0. If the next run starts at 0, it belongs to the next row,
// and this run ends at the end of its row. Otherwise this run ends where the next run starts.
template <int D>
std::uint32_t Components<D>::RunEnd(std::size_t run) const
{
  const std::uint32_t next = run + 1 < this->Runs.size() ? this->Runs[run + 1].Start : 0;
  return next != 0 ? next : static_cast<std::uint32_t>(this->Dimensions[0]);
}

//------------------------------------------------------------------------------------------------
template <int D>
std::vector<bool> Components<D>::FindWanted(std::int64_t fewestVoxels) const
{
  std::vector<bool> wanted(this->List.size());
  std::vector<std::uint32_t> largest; // the largest component of each label
  for (std::uint32_t c = 0; c < this->List.size(); ++c)
  {
    const Component<D>& component = this->List[c];
    wanted[c] = component.Voxels >= fewestVoxels;
    if (component.Label >= largest.size())
    {
      largest.resize(component.Label + std::size_t{ 1 }, None);
    }
    std::uint32_t& known = largest[component.Label];
    known = known == None || component.Voxels > this->List[known].Voxels ? c : known;
  }
  for (const std::uint32_t c : largest)
  {
    if (c != None)
    {
      wanted[c] = true;
    }
  }
  return wanted;
}

//------------------------------------------------------------------------------------------------
template <int D>
std::uint32_t Components<D>::At(const Index& voxel) const
{
  for (std::size_t a = 0; a < D; ++a)
  {
    if (voxel[a] < 0 || voxel[a] >= this->Dimensions[a])
    {
      return None;
    }
  }
  const std::size_t row = RowOf(voxel, this->Dimensions);
  const auto begin = this->Runs.begin() + this->FirstOfRow[row];
  const auto end = this->Runs.begin() + this->FirstOfRow[row + 1];
  const auto after = std::upper_bound(begin, end, static_cast<std::uint32_t>(voxel[0]),
    [](std::uint32_t x, const Run& run) { return x < run.Start; });
  return (after - 1)->Component;
}

//------------------------------------------------------------------------------------------------
template <int D>
Components<D>::Components(
  const LabelImage<D>& image, unsigned threads, const std::stop_token& stop, std::size_t extent)
  : Dimensions(image.CropDimensions())
  , JoinedAxes(extent)
{
  const std::vector<LabelId> labels = this->FindRuns(image, threads, stop);
  DisjointSets sets(this->Runs.size());
  const std::vector<double> surface =
    this->JoinRuns(FaceAreas(image.Grid()), labels, sets, threads, stop);
  this->MakeList(labels, surface, sets);
}

//------------------------------------------------------------------------------------------------
/** @return the label of each run */
template <int D>
std::vector<LabelId> Components<D>::FindRuns(
  const LabelImage<D>& image, unsigned threads, const std::stop_token& stop)
{
  const LabelId* ids = image.Ids().data();
  const auto length = static_cast<std::size_t>(this->Dimensions[0]);
  const std::size_t rows = CountCells(this->Dimensions) / length;
  this->FirstOfRow.resize(rows + 1, 0);
  ParallelFor(
    0, rows, RowsAtOnce, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t row = begin; row < end; ++row)
      {
        const LabelId* v = ids + row * length;
        std::uint32_t changes = 0;
        for (std::size_t i = 1; i < length; ++i)
        {
          changes += v[i] != v[i - 1] ? 1 : 0;
        }
        this->FirstOfRow[row + 1] = changes + 1;
      }
    },
    stop);
  std::uint64_t total = 0;
  for (std::size_t row = 0; row < rows; ++row)
  {
    total += this->FirstOfRow[row + 1];
    if (total >= None)
    {
      throw InputError("the image has too many runs of one label to tell its components apart");
    }
    this->FirstOfRow[row + 1] = static_cast<std::uint32_t>(total);
  }
  this->Runs.resize(total);
  std::vector<LabelId> labels(total);
  ParallelFor(
    0, rows, RowsAtOnce, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t row = begin; row < end; ++row)
      {
        const LabelId* v = ids + row * length;
        std::uint32_t run = this->FirstOfRow[row];
        for (std::size_t i = 0; i < length; ++i)
        {
          if (i == 0 || v[i] != v[i - 1])
          {
            this->Runs[run] = { static_cast<std::uint32_t>(i), None };
            labels[run++] = v[i];
          }
        }
      }
    },
    stop);
  return labels;
}

//------------------------------------------------------------------------------------------------
/**
 * Runs of neighbouring rows belong together if they overlap and have the same label. First, each
 * thread joins runs inside its slab of rows, so no set extends beyond a slab. Then runs of
 * different slabs are joined.
 * @return the surface of each run, without the faces between joined runs
 */
template <int D>
std::vector<double> Components<D>::JoinRuns(const Point<D>& areas,
  const std::vector<LabelId>& labels, DisjointSets& sets, unsigned threads,
  const std::stop_token& stop)
{
  const std::size_t rows = this->NumberOfRows();
  std::vector<double> surface(this->Runs.size());
  const auto joinRows = [&](std::size_t row, std::size_t stride, double area)
  {
    std::uint32_t a = this->FirstOfRow[row - stride];
    std::uint32_t b = this->FirstOfRow[row];
    const std::uint32_t endOfA = this->FirstOfRow[row - stride + 1];
    const std::uint32_t endOfB = this->FirstOfRow[row + 1];
    while (a < endOfA && b < endOfB)
    {
      const std::uint32_t stopA = this->RunEnd(a);
      const std::uint32_t stopB = this->RunEnd(b);
      if (labels[a] == labels[b] && labels[a] != 0)
      {
        const std::uint32_t from = std::max(this->Runs[a].Start, this->Runs[b].Start);
        surface[b] -= 2.0 * area * static_cast<double>(std::min(stopA, stopB) - from);
        sets.Join(a, b);
      }
      a += stopA <= stopB ? 1 : 0;
      b += stopB <= stopA ? 1 : 0;
    }
  };
  const auto joinAxes = [&](std::size_t row, std::size_t firstRowOfSlab, bool within)
  {
    std::size_t stride = 1;
    for (std::size_t a = 1; a < this->JoinedAxes; ++a)
    {
      const auto n = static_cast<std::size_t>(this->Dimensions[a]);
      if (row / stride % n != 0 && (row - stride >= firstRowOfSlab) == within)
      {
        joinRows(row, stride, areas[a]);
      }
      stride *= n;
    }
  };
  const std::size_t slab =
    std::max<std::size_t>(RowsAtOnce, (rows - 1) / std::max(1u, 4 * NumberOfThreads(threads)) + 1);
  ParallelFor(
    0, rows, slab, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t row = begin; row < end; ++row)
      {
        double faces = 2.0 * areas[0]; // at both ends of a run
        for (std::uint32_t r = this->FirstOfRow[row]; r < this->FirstOfRow[row + 1]; ++r)
        {
          const double voxels = this->RunEnd(r) - this->Runs[r].Start;
          surface[r] = faces;
          for (std::size_t a = 1; a < D; ++a)
          {
            surface[r] += 2.0 * areas[a] * voxels;
          }
        }
        joinAxes(row, begin, true);
      }
    },
    stop);
  for (std::size_t begin = 0; begin < rows; begin += slab)
  {
    for (std::size_t row = begin; row < std::min(rows, begin + slab); ++row)
    {
      joinAxes(row, begin, false);
    }
  }
  return surface;
}

//------------------------------------------------------------------------------------------------
template <int D>
void Components<D>::MakeList(
  const std::vector<LabelId>& labels, const std::vector<double>& surface, DisjointSets& sets)
{
  this->NextRun.assign(this->Runs.size(), NoRun);
  std::vector<std::uint32_t> lastRun;
  for (std::uint32_t r = 0; r < this->Runs.size(); ++r)
  {
    if (labels[r] == 0)
    {
      continue;
    }
    const std::uint32_t root = sets.Find(r);
    if (root == r)
    {
      this->Runs[r].Component = static_cast<std::uint32_t>(this->List.size());
      this->List.push_back({ labels[r], 0, 0.0, {} });
      this->FirstRun.push_back(r);
      lastRun.push_back(r);
    }
    else
    {
      this->Runs[r].Component = this->Runs[root].Component;
      this->NextRun[lastRun[this->Runs[r].Component]] = r;
      lastRun[this->Runs[r].Component] = r;
    }
    Component<D>& component = this->List[this->Runs[r].Component];
    component.Voxels += this->RunEnd(r) - this->Runs[r].Start;
    component.Surface += surface[r];
  }
  for (std::size_t c = 0; c < this->List.size(); ++c)
  {
    this->List[c].First = this->RunIndex(this->FirstRun[c]);
  }
}

template class Components<3>;
template class Components<4>;

} // namespace voxplex
