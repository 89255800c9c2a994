// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Sizing/Grading/InterfaceSamples.h"

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

using Index = GridGeometry<3>::Index;

/** Largest displacement of a point along an axis, in smallest voxel spacings. */
constexpr double Jitter = 1e-3;

/** A step from a voxel to the next one along an axis. */
struct Step
{
  LabelId From = 0;
  LabelId To = 0;
  double Distance2 =
    std::numeric_limits<double>::infinity(); ///< to the centre of the cell, squared
  Index Voxel{};
  std::size_t Axis = 0;
};

/**
 * The best step of one cell for each ordered pair of labels. If a cell has more pairs than fit, the
 * rest are left out.
 */
class BestSteps
{
public:
  void Consider(const Step& step)
  {
    for (std::size_t i = 0; i < this->Count; ++i)
    {
      Step& best = this->Best[i];
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

  const Step* begin() const { return this->Best.data(); }
  const Step* end() const { return this->Best.data() + this->Count; }
  void Clear() { this->Count = 0; }

private:
  std::array<Step, 8> Best;
  std::size_t Count = 0;
};

/** A number in (-1, 1), uniformly distributed, from a voxel and a stream. */
double PseudoRandom(const Index& voxel, std::uint64_t stream)
{
  std::uint64_t h = stream;
  for (const std::int64_t x : voxel)
  {
    h = MixBits((h + GoldenGamma) ^ static_cast<std::uint64_t>(x));
  }
  return static_cast<double>(h >> 11) * 0x1p-52 - 1.0;
}

/** Samples the layers of cells of one image. Several threads may call the methods at once. */
class Sampler
{
public:
  Sampler(const LabelImage<3>& image, const Domain<3>& domain, double spacing)
    : Image(image)
    , Surfaces(domain)
  {
    this->SmallestSpacing = std::numeric_limits<double>::infinity();
    for (std::size_t a = 0; a < 3; ++a)
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

  std::size_t NumberOfLayers() const { return static_cast<std::size_t>(this->Cells[2]); }

  void SampleLayer(std::size_t layer, LabelChanges& changes) const
  {
    std::vector<BestSteps> row(static_cast<std::size_t>(this->Cells[0]));
    for (std::int64_t y = 0; y < this->Cells[1]; ++y)
    {
      Index cell{ 0, y, static_cast<std::int64_t>(layer) };
      for (std::int64_t k = 0; k < this->Edge[2]; ++k)
      {
        for (std::int64_t j = 0; j < this->Edge[1]; ++j)
        {
          this->SearchVoxels(cell[1] * this->Edge[1] + j - 1, cell[2] * this->Edge[2] + k - 1, row);
        }
      }
      for (BestSteps& steps : row)
      {
        for (const Step& step : steps)
        {
          this->AddPoint(step, changes);
        }
        steps.Clear();
      }
    }
  }

private:
  /** A row of the crop; null for a row of the layer of background around it. */
  const LabelId* RowAt(std::int64_t y, std::int64_t z) const
  {
    const Index& n = this->Image.CropDimensions();
    return y < 0 || z < 0 || y >= n[1] || z >= n[2]
      ? nullptr
      : this->Image.Ids().data() + (z * n[1] + y) * n[0];
  }

  /** Whether the border of the image is half a voxel beyond this voxel. */
  bool ReachesBorder(std::size_t axis, std::int64_t voxel) const
  {
    return (voxel == -1 && this->Image.ReachesBorder(axis, 0)) ||
      (voxel == this->Image.CropDimensions()[axis] - 1 && this->Image.ReachesBorder(axis, 1));
  }

  void SearchVoxels(std::int64_t y, std::int64_t z, std::vector<BestSteps>& cells) const
  {
    const LabelId* here = this->RowAt(y, z);
    const std::array<const LabelId*, 3> next = { here, this->RowAt(y + 1, z),
      this->RowAt(y, z + 1) };
    const std::int64_t n = this->Image.CropDimensions()[0];
    const auto at = [n](const LabelId* row, std::int64_t x)
    { return row && x >= 0 && x < n ? row[x] : LabelId(0); };
    if (!here && !next[1] && !next[2])
    {
      return;
    }
    for (std::int64_t x = -1; x < n; ++x)
    {
      const LabelId id = at(here, x);
      for (std::size_t a = 0; a < 3; ++a)
      {
        const LabelId other = at(next[a], a == 0 ? x + 1 : x);
        if (other != id && !this->ReachesBorder(a, std::array{ x, y, z }[a]))
        {
          Step step{ id, other, 0.0, { x, y, z }, a };
          for (std::size_t b = 0; b < 3; ++b)
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

  void AddPoint(const Step& step, LabelChanges& changes) const
  {
    Index next = step.Voxel;
    ++next[step.Axis];
    Point<3> z;
    if (this->Surfaces.FirstCrossing(
          this->Image.CentreOf(step.Voxel), step.From, this->Image.CentreOf(next), z))
    {
      for (std::size_t a = 0; a < 3; ++a)
      {
        z[a] += Jitter * this->SmallestSpacing * PseudoRandom(step.Voxel, 3 * step.Axis + a);
      }
      changes.Points.push_back(z);
      changes.Labels.push_back({ std::min(step.From, step.To), std::max(step.From, step.To) });
    }
  }

  const LabelImage<3>& Image;
  const Domain<3>& Surfaces;
  Point<3> Spacing;
  double SmallestSpacing;
  Index Edge{};  ///< of a cell, in voxels
  Index Cells{}; ///< along each axis
};

} // namespace

//------------------------------------------------------------------------------------------------
LabelChanges SampleLabelChanges(const LabelImage<3>& image, const Domain<3>& domain, double spacing,
  unsigned threads, const std::stop_token& stop)
{
  const Sampler sampler(image, domain, spacing);
  std::vector<LabelChanges> layers(sampler.NumberOfLayers());
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
  LabelChanges changes;
  for (const LabelChanges& layer : layers)
  {
    changes.Points.insert(changes.Points.end(), layer.Points.begin(), layer.Points.end());
    changes.Labels.insert(changes.Labels.end(), layer.Labels.begin(), layer.Labels.end());
  }
  return changes;
}

} // namespace voxplex
