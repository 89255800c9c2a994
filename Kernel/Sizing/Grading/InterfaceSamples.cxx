// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Sizing/Grading/InterfaceSamples.h"

#include "Base/GridIndex.h"
#include "Base/MixBits.h"
#include "Parallel/ParallelFor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace voxplex
{

namespace
{

/** Largest displacement of a point along an axis, in smallest voxel spacings. */
constexpr double Jitter = 1e-3;

/** A step from a voxel to the next one along an axis. */
template <int D>
struct Step
{
  LabelId From = 0;
  LabelId To = 0;
  double Distance2 =
    std::numeric_limits<double>::infinity(); ///< to the centre of the cell, squared
  typename GridGeometry<D>::Index Voxel{};
  std::size_t Axis = 0;
};

/**
 * The best step of one cell for each ordered pair of labels. If a cell has more pairs than fit, the
 * rest are left out.
 */
template <int D>
class BestSteps
{
public:
  void Consider(const Step<D>& step)
  {
    for (std::size_t i = 0; i < this->Count; ++i)
    {
      Step<D>& best = this->Best[i];
      if (best.From == step.From && best.To == step.To)
      {
        if (step.Distance2 < best.Distance2)
        {
          best = step;
        }
        return;
      }
    }
    if (this->Count < this->Best.size())
    {
      this->Best[this->Count++] = step;
    }
  }

  const Step<D>* begin() const { return this->Best.data(); }
  const Step<D>* end() const { return this->Best.data() + this->Count; }
  void Clear() { this->Count = 0; }

private:
  std::array<Step<D>, 8> Best;
  std::size_t Count = 0;
};

/** A number in (-1, 1), uniformly distributed, from a voxel and a stream. */
template <std::size_t D>
double PseudoRandom(const std::array<std::int64_t, D>& voxel, std::uint64_t stream)
{
  std::uint64_t h = stream;
  for (const std::int64_t x : voxel)
  {
    h = MixBits((h + GoldenGamma) ^ static_cast<std::uint64_t>(x));
  }
  return static_cast<double>(h >> 11) * 0x1p-52 - 1.0;
}

/** Samples the layers of cells of one image. Several threads may call the methods at once. */
template <int D>
class Sampler
{
public:
  Sampler(const LabelImage<D>& image, const Domain<D>& domain, double spacing)
    : Image(image)
    , Surfaces(domain)
  {
    this->SmallestSpacing = std::numeric_limits<double>::infinity();
    for (std::size_t a = 0; a < D; ++a)
    {
      this->Spacing[a] = image.Grid().Spacing(static_cast<int>(a));
      this->SmallestSpacing = std::min(this->SmallestSpacing, this->Spacing[a]);
      const std::int64_t n =
        image.CropDimensions()[a] + 1; // steps begin in the layer before the crop
      this->Edge[a] =
        std::clamp<std::int64_t>(std::llround(std::min(spacing / this->Spacing[a], 1e9)), 1, n);
      this->Cells[a] = (n - 1) / this->Edge[a] + 1;
    }
  }

  /** Layers along the last axis. */
  std::size_t NumberOfLayers() const { return static_cast<std::size_t>(this->Cells[D - 1]); }

  void SampleLayer(std::size_t layer, LabelChanges<D>& changes) const
  {
    std::vector<BestSteps<D>> row(static_cast<std::size_t>(this->Cells[0]));
    Index first{}; // the cells at the beginnings of rows
    Index last;
    for (std::size_t a = 0; a < D; ++a)
    {
      last[a] = a == 0 ? 0 : this->Cells[a] - 1;
    }
    first[D - 1] = last[D - 1] = static_cast<std::int64_t>(layer);
    ForEachIndex(first, last,
      [&](const Index& cell)
      {
        Index low{}; // the voxels at the beginnings of rows
        Index high{};
        for (std::size_t a = 1; a < D; ++a)
        {
          low[a] = cell[a] * this->Edge[a] - 1;
          high[a] = low[a] + this->Edge[a] - 1;
        }
        ForEachIndex(low, high, [&](const Index& voxel) { this->SearchVoxels(voxel, row); });
        for (BestSteps<D>& steps : row)
        {
          for (const Step<D>& step : steps)
          {
            this->AddPoint(step, changes);
          }
          steps.Clear();
        }
      });
  }

private:
  using Index = typename GridGeometry<D>::Index;

  /** The row of the crop with a voxel; null for a row of the layer of background around it. */
  const LabelId* RowAt(const Index& voxel) const
  {
    const Index& n = this->Image.CropDimensions();
    for (std::size_t a = 1; a < D; ++a)
    {
      if (voxel[a] < 0 || voxel[a] >= n[a])
      {
        return nullptr;
      }
    }
    return this->Image.Ids().data() + RowOf(voxel, n) * static_cast<std::size_t>(n[0]);
  }

  /** Whether the object is cut between this voxel and the next: it has a flat face there. */
  bool IsCutBehind(std::size_t axis, std::int64_t voxel) const
  {
    const auto isCut = [&](unsigned end)
    {
      return D == 4 ? axis == 3 && this->Image.ReachesBorderInTime(end)
                    : this->Image.ReachesBorder(axis, end);
    };
    return (voxel == -1 && isCut(0)) ||
      (voxel == this->Image.CropDimensions()[axis] - 1 && isCut(1));
  }

  void SearchVoxels(Index voxel, std::vector<BestSteps<D>>& cells) const
  {
    std::array<const LabelId*, static_cast<std::size_t>(D)>
      next; // row of the next voxel along each axis
    bool any = false;
    for (std::size_t a = 0; a < D; ++a)
    {
      Index beside = voxel;
      beside[a] += a == 0 ? 0 : 1;
      next[a] = this->RowAt(beside);
      any = any || next[a];
    }
    if (!any)
    {
      return;
    }
    const LabelId* here = next[0];
    const std::int64_t n = this->Image.CropDimensions()[0];
    const auto at = [n](const LabelId* row, std::int64_t x)
    { return row && x >= 0 && x < n ? row[x] : LabelId(0); };
    for (voxel[0] = -1; voxel[0] < n; ++voxel[0])
    {
      const std::int64_t x = voxel[0];
      const LabelId id = at(here, x);
      for (std::size_t a = 0; a < D; ++a)
      {
        const LabelId other = at(next[a], a == 0 ? x + 1 : x);
        if (other != id && !this->IsCutBehind(a, voxel[a]))
        {
          Step<D> step{ id, other, 0.0, voxel, a };
          for (std::size_t b = 0; b < D; ++b)
          {
            const double inCell =
              static_cast<double>((step.Voxel[b] + 1) % this->Edge[b]) + (a == b ? 0.5 : 0.0);
            const double d =
              (inCell - 0.5 * static_cast<double>(this->Edge[b] - 1)) * this->Spacing[b];
            step.Distance2 += d * d;
          }
          cells[static_cast<std::size_t>((x + 1) / this->Edge[0])].Consider(step);
        }
      }
    }
  }

  void AddPoint(const Step<D>& step, LabelChanges<D>& changes) const
  {
    Index next = step.Voxel;
    ++next[step.Axis];
    Point<D> z;
    if (this->Surfaces.FirstCrossing(
          this->Image.CentreOf(step.Voxel), step.From, this->Image.CentreOf(next), z))
    {
      for (std::size_t a = 0; a < D; ++a)
      {
        z[a] += Jitter * this->SmallestSpacing * PseudoRandom(step.Voxel, D * step.Axis + a);
      }
      changes.Points.push_back(z);
      changes.Labels.push_back({ std::min(step.From, step.To), std::max(step.From, step.To) });
    }
  }

  const LabelImage<D>& Image;
  const Domain<D>& Surfaces;
  Point<D> Spacing;
  double SmallestSpacing;
  Index Edge{};  ///< of a cell, in voxels
  Index Cells{}; ///< along each axis
};

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
LabelChanges<D> SampleLabelChanges(const LabelImage<D>& image, const Domain<D>& domain,
  double spacing, unsigned threads, const std::stop_token& stop)
{
  const Sampler<D> sampler(image, domain, spacing);
  std::vector<LabelChanges<D>> layers(sampler.NumberOfLayers());
  ParallelFor(
    0, layers.size(), 1, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t layer = begin; layer < end; ++layer)
      {
        sampler.SampleLayer(layer, layers[layer]);
      }
    },
    stop);
  LabelChanges<D> changes;
  for (const LabelChanges<D>& layer : layers)
  {
    changes.Points.insert(changes.Points.end(), layer.Points.begin(), layer.Points.end());
    changes.Labels.insert(changes.Labels.end(), layer.Labels.begin(), layer.Labels.end());
  }
  return changes;
}

template LabelChanges<3> SampleLabelChanges<3>(
  const LabelImage<3>&, const Domain<3>&, double, unsigned, const std::stop_token&);
template LabelChanges<4> SampleLabelChanges<4>(
  const LabelImage<4>&, const Domain<4>&, double, unsigned, const std::stop_token&);

} // namespace voxplex
