// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "RandomImages.h"

#include <limits>
#include <numbers>

namespace voxplex::stress
{

namespace
{

template <int D>
using Index = typename Volume<D>::Index;

/** The number of labels; usually few. */
std::int32_t RandomLabelCount(Random& random)
{
  return static_cast<std::int32_t>(
    random.Chance(0.7) ? random.Integer(1, 4) : std::int64_t(random.LogUniform(2.0, 61.0)));
}

std::int32_t RandomLabel(Random& random, std::int32_t labels)
{
  return static_cast<std::int32_t>(random.Integer(1, labels));
}

template <int D>
Index<D> RandomVoxel(const Volume<D>& image, Random& random)
{
  Index<D> voxel;
  for (std::size_t a = 0; a < voxel.size(); ++a)
  {
    voxel[a] = random.Integer(0, image.Dimensions[a] - 1);
  }
  return voxel;
}

template <int D>
void Set(Volume<D>& image, const Index<D>& voxel, std::int32_t label)
{
  if (image.Contains(voxel))
  {
    image.Labels[image.At(voxel)] = label;
  }
}

/** A box of voxels, both corners included. */
template <int D>
void SetBox(Volume<D>& image, const Index<D>& low, const Index<D>& high, std::int32_t label)
{
  Index<D> voxel = low;
  for (bool more = true; more;)
  {
    Set(image, voxel, label);
    more = false;
    for (std::size_t a = 0; a < voxel.size() && !more; ++a)
    {
      more = ++voxel[a] <= high[a];
      voxel[a] = more ? voxel[a] : low[a];
    }
  }
}

//------------------------------------------------------------------------------------------------
/** Each voxel has an independent label. */
template <int D>
void FillIid(Volume<D>& image, Random& random, std::int32_t labels)
{
  const double background = random.Chance(0.3) ? 0.0 : random.Uniform(0.1, 0.9);
  for (std::int32_t& label : image.Labels)
  {
    label = random.Chance(background) ? 0 : RandomLabel(random, labels);
  }
}

/** Some single voxels in background, or in a label. */
template <int D>
void FillSparse(Volume<D>& image, Random& random, std::int32_t labels)
{
  const std::int32_t around = random.Chance(0.3) ? RandomLabel(random, labels) : 0;
  const double density = random.LogUniform(0.003, 0.15);
  for (std::int32_t& label : image.Labels)
  {
    label = random.Chance(density) ? RandomLabel(random, labels) : around;
  }
  Set(image, RandomVoxel(image, random), RandomLabel(random, labels));
}

/** Ellipsoids; later ones overwrite earlier ones, some are background. */
template <int D>
void FillBlobs(Volume<D>& image, Random& random, std::int32_t labels)
{
  const std::int64_t blobs = labels + random.Integer(0, 4);
  for (std::int64_t b = 0; b < blobs; ++b)
  {
    const Index<D> centre = RandomVoxel(image, random);
    std::array<double, static_cast<std::size_t>(D)> radius{};
    for (std::size_t a = 0; a < radius.size(); ++a)
    {
      radius[a] = random.Uniform(0.6, 0.6 + 0.5 * static_cast<double>(image.Dimensions[a]));
    }
    const std::int32_t label =
      b > 0 && random.Chance(0.15) ? 0 : static_cast<std::int32_t>(b % labels + 1);
    image.ForEach(
      [&](const Index<D>& voxel, std::size_t i)
      {
        double sum = 0.0;
        for (std::size_t a = 0; a < radius.size(); ++a)
        {
          const double x = static_cast<double>(voxel[a] - centre[a]) / radius[a];
          sum += x * x;
        }
        image.Labels[i] = sum <= 1.0 ? label : image.Labels[i];
      });
  }
}

/** Slabs, one or two voxels thick, flat or bent, at any angle. */
template <int D>
void FillSheets(Volume<D>& image, Random& random, std::int32_t labels)
{
  const std::int64_t sheets = random.Integer(1, 5);
  for (std::int64_t s = 0; s < sheets; ++s)
  {
    std::array<double, static_cast<std::size_t>(D)> normal{};
    const bool aligned = random.Chance(0.3);
    const std::size_t axis = static_cast<std::size_t>(random.Integer(0, D - 1));
    double length = 0.0;
    for (std::size_t a = 0; a < normal.size(); ++a)
    {
      normal[a] = aligned ? (a == axis ? 1.0 : 0.0) : random.Normal();
      length += normal[a] * normal[a];
    }
    const Index<D> through = RandomVoxel(image, random);
    const double bend = random.Chance(0.5) ? 0.0 : random.Uniform(0.0, 0.1);
    const double thickness = random.OneOf({ 0.5, 0.8, 1.0, 1.5, 2.0 });
    const std::int32_t label = RandomLabel(random, labels);
    image.ForEach(
      [&](const Index<D>& voxel, std::size_t i)
      {
        double height = 0.0;
        double distance2 = 0.0;
        for (std::size_t a = 0; a < normal.size(); ++a)
        {
          const double x = static_cast<double>(voxel[a] - through[a]);
          height += x * normal[a] / std::sqrt(length);
          distance2 += x * x;
        }
        height += bend * distance2;
        image.Labels[i] =
          height >= -0.5 * thickness && height < 0.5 * thickness ? label : image.Labels[i];
      });
  }
}

/** Voronoi cells; some are background. */
template <int D>
void FillCells(Volume<D>& image, Random& random, std::int32_t labels)
{
  std::vector<Index<D>> centres;
  std::vector<std::int32_t> cells;
  const std::int64_t count = labels + random.Integer(0, labels);
  for (std::int64_t c = 0; c < count; ++c)
  {
    centres.push_back(RandomVoxel(image, random));
    cells.push_back(c > 0 && random.Chance(0.2) ? 0 : static_cast<std::int32_t>(c % labels + 1));
  }
  image.ForEach(
    [&](const Index<D>& voxel, std::size_t i)
    {
      std::int64_t least = std::numeric_limits<std::int64_t>::max();
      for (std::size_t c = 0; c < centres.size(); ++c)
      {
        std::int64_t distance2 = 0;
        for (std::size_t a = 0; a < voxel.size(); ++a)
        {
          distance2 += (voxel[a] - centres[c][a]) * (voxel[a] - centres[c][a]);
        }
        image.Labels[i] = distance2 < least ? cells[c] : image.Labels[i];
        least = std::min(least, distance2);
      }
    });
}

/** Lines one voxel wide: walks along the axes, or with diagonal steps that touch at edges and corners only. */
template <int D>
void FillLines(Volume<D>& image, Random& random, std::int32_t labels)
{
  const std::int64_t lines = random.Integer(1, 6);
  const bool diagonal = random.Chance(0.5);
  const double turn = random.Uniform(0.0, 0.5);
  for (std::int64_t l = 0; l < lines; ++l)
  {
    Index<D> at = RandomVoxel(image, random);
    Index<D> step{};
    const std::int32_t label = RandomLabel(random, labels);
    std::int64_t length = 0;
    for (const std::int64_t n : image.Dimensions)
    {
      length += n;
    }
    for (std::int64_t i = 0; i < length && image.Contains(at); ++i)
    {
      if (i == 0 || random.Chance(turn))
      {
        step = {};
        for (std::size_t a = 0; a < step.size(); ++a)
        {
          step[a] = diagonal ? random.Integer(-1, 1) : 0;
        }
        step[static_cast<std::size_t>(random.Integer(0, D - 1))] = random.OneOf({ -1, 1 });
      }
      Set(image, at, label);
      for (std::size_t a = 0; a < step.size(); ++a)
      {
        at[a] += step[a];
      }
    }
  }
}

/** Boxes of alternating labels. */
template <int D>
void FillCheckerboard(Volume<D>& image, Random& random, std::int32_t labels)
{
  const std::int64_t period = random.Integer(1, 4);
  const bool withBackground = random.Chance(0.5);
  const double noise = random.Chance(0.3) ? random.Uniform(0.0, 0.1) : 0.0;
  image.ForEach(
    [&](const Index<D>& voxel, std::size_t i)
    {
      std::int64_t sum = 0;
      for (const std::int64_t v : voxel)
      {
        sum += v / period;
      }
      const auto k = static_cast<std::int32_t>(sum % (labels + 1));
      image.Labels[i] = random.Chance(noise) ? RandomLabel(random, labels)
        : withBackground                     ? k
        : k == 0                             ? labels
                                             : k;
    });
}

/** Boxes; each touches the previous one only at a corner, an edge or a face. */
template <int D>
void FillTouching(Volume<D>& image, Random& random, std::int32_t labels)
{
  Index<D> low = RandomVoxel(image, random);
  const std::int64_t boxes = random.Integer(2, 8);
  for (std::int64_t b = 0; b < boxes; ++b)
  {
    Index<D> high = low;
    for (std::size_t a = 0; a < low.size(); ++a)
    {
      high[a] += random.Integer(0, std::max<std::int64_t>(1, image.Dimensions[a] / 3));
    }
    SetBox(image, low, high, RandomLabel(random, labels));
    for (std::size_t a = 0; a < low.size(); ++a)
    {
      low[a] = random.Chance(0.75) ? high[a] + 1 : low[a];
    }
    if (!image.Contains(low))
    {
      low = RandomVoxel(image, random);
    }
  }
}

/** Layers across one axis, as in images with thick slices; shapes change from slice to slice. */
template <int D>
void FillSlices(Volume<D>& image, Random& random, std::int32_t labels)
{
  const std::size_t axis = static_cast<std::size_t>(random.Integer(0, D - 1));
  std::vector<std::array<double, 2>> waves;
  for (std::int64_t s = 0; s < image.Dimensions[axis]; ++s)
  {
    waves.push_back({ random.Uniform(0.0, 6.3), random.Uniform(0.1, 1.2) });
  }
  image.ForEach(
    [&](const Index<D>& voxel, std::size_t i)
    {
      const auto& wave = waves[static_cast<std::size_t>(voxel[axis])];
      double phase = wave[0];
      for (std::size_t a = 0; a < voxel.size(); ++a)
      {
        phase += a == axis ? 0.0 : wave[1] * static_cast<double>(voxel[a]) / double(a + 1);
      }
      image.Labels[i] =
        static_cast<std::int32_t>(std::floor(0.5 * (1.0 + std::sin(phase)) * (labels + 0.999)));
    });
}

/** Shells around a point, one or more voxels thick. */
template <int D>
void FillShells(Volume<D>& image, Random& random, std::int32_t labels)
{
  const Index<D> centre = RandomVoxel(image, random);
  const double thickness = random.LogUniform(0.9, 4.0);
  const bool maximum = random.Chance(0.3); // boxes instead of balls
  image.ForEach(
    [&](const Index<D>& voxel, std::size_t i)
    {
      double r = 0.0;
      for (std::size_t a = 0; a < voxel.size(); ++a)
      {
        const double x = std::abs(static_cast<double>(voxel[a] - centre[a]));
        r = maximum ? std::max(r, x) : std::hypot(r, x);
      }
      image.Labels[i] = static_cast<std::int32_t>(r / thickness) % (labels + 1);
    });
  Set(image, centre, 1);
}

/** A label everywhere, or a wedge of it. */
template <int D>
void FillSolid(Volume<D>& image, Random& random, std::int32_t labels)
{
  const bool wedge = random.Chance(0.5);
  const double slope = random.Uniform(0.2, 3.0);
  image.ForEach(
    [&](const Index<D>& voxel, std::size_t i)
    {
      const bool inside =
        !wedge || static_cast<double>(voxel[1]) <= slope * static_cast<double>(voxel[0]);
      image.Labels[i] = inside ? std::min(labels, 2) : 0;
    });
}

//------------------------------------------------------------------------------------------------
template <int D>
struct Kind
{
  const char* Name;
  void (*Fill)(Volume<D>&, Random&, std::int32_t labels);
};

template <int D>
const Kind<D>& RandomKind(Random& random)
{
  static const std::array<Kind<D>, 11> kinds = { { { "iid", FillIid<D> },
    { "sparse", FillSparse<D> }, { "blobs", FillBlobs<D> }, { "sheets", FillSheets<D> },
    { "cells", FillCells<D> }, { "lines", FillLines<D> }, { "checkerboard", FillCheckerboard<D> },
    { "touching", FillTouching<D> }, { "slices", FillSlices<D> }, { "shells", FillShells<D> },
    { "solid", FillSolid<D> } } };
  return kinds[static_cast<std::size_t>(random.Integer(0, std::int64_t(kinds.size()) - 1))];
}

/** Makes the outermost layers background, if some foreground remains. */
template <int D>
void ClearMargin(Volume<D>& image, std::int64_t width)
{
  const std::int64_t least =
    std::min({ image.Dimensions[0], image.Dimensions[1], image.Dimensions[2] });
  width = std::min(width, (least - 1) / 2);
  image.ForEach(
    [&](const Index<D>& voxel, std::size_t i)
    {
      for (std::size_t a = 0; a < 3; ++a) // not in time
      {
        if (voxel[a] < width || voxel[a] >= image.Dimensions[a] - width)
        {
          image.Labels[i] = 0;
        }
      }
    });
}

/** Renumbers labels with gaps: labels of real images are not numbered from 1 on. */
template <int D>
void SpreadLabelValues(Volume<D>& image, Random& random)
{
  const std::int32_t most = random.OneOf({ 1, 3, 100, 1000000 });
  std::vector<std::int32_t> value(1, 0);
  for (std::int32_t& label : image.Labels)
  {
    while (value.size() <= static_cast<std::size_t>(label))
    {
      value.push_back(value.back() + static_cast<std::int32_t>(random.Integer(1, most)));
    }
    label = value[static_cast<std::size_t>(label)];
  }
}

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
std::string FillWithLabels(Volume<D>& image, Random& random)
{
  image.Labels.assign(image.Size(), 0);
  const std::int32_t labels = RandomLabelCount(random);
  const Kind<D>& kind = RandomKind<D>(random);
  kind.Fill(image, random, labels);
  std::string name = kind.Name;
  if (random.Chance(0.15)) // half of the image is of another kind
  {
    Volume<D> other = image;
    std::fill(other.Labels.begin(), other.Labels.end(), 0);
    const Kind<D>& second = RandomKind<D>(random);
    second.Fill(other, random, labels);
    const std::size_t axis = static_cast<std::size_t>(random.Integer(0, D - 1));
    image.ForEach(
      [&](const Index<D>& voxel, std::size_t i)
      {
        const bool replace = 2 * voxel[axis] < image.Dimensions[axis];
        image.Labels[i] = replace ? other.Labels[i] : image.Labels[i];
      });
    name += std::string("+") + second.Name;
  }
  if (random.Chance(0.5))
  {
    ClearMargin(image, random.Integer(1, 2));
  }
  const bool isEmpty = std::all_of(
    image.Labels.begin(), image.Labels.end(), [](std::int32_t label) { return label == 0; });
  if (isEmpty && !random.Chance(0.02)) // an image without foreground is refused: a few are enough
  {
    Set(image, RandomVoxel(image, random), 1);
  }
  SpreadLabelValues(image, random);
  return name;
}

//------------------------------------------------------------------------------------------------
template <int D>
Volume<D> RandomGrid(Random& random)
{
  Volume<D> image;
  // The number of voxels, and the largest number along an axis.
  const double voxels = random.Chance(0.995) ? random.LogUniform(8.0, D == 3 ? 6000.0 : 3000.0)
                                             : random.LogUniform(2000.0, 60000.0);
  const std::int64_t most = D == 4 ? 18 : random.Chance(0.98) ? 30 : 80;
  const double side = std::pow(D == 3 ? voxels : voxels / 4.0, 1.0 / 3.0);
  for (std::size_t a = 0; a < 3; ++a)
  {
    const auto n = std::int64_t(std::lround(side * random.LogUniform(0.4, 2.5)));
    image.Dimensions[a] = std::clamp<std::int64_t>(n, random.Chance(0.01) ? 1 : 2, most);
  }
  const double unit = random.Chance(0.7) ? 1.0 : random.LogUniform(0.01, 100.0);
  const bool anisotropic = random.Chance(0.5);
  for (std::size_t a = 0; a < 3; ++a)
  {
    image.Axes[a][a] = anisotropic ? unit * random.LogUniform(0.4, 2.5) : unit;
  }
  if (random.Chance(0.2))
  {
    const double shear = random.OneOf({ 0.05, 0.3, 0.9 });
    image.Axes[0][1] = shear * random.Uniform(-1.0, 1.0) * image.Axes[1][1];
    image.Axes[0][2] = shear * random.Uniform(-1.0, 1.0) * image.Axes[2][2];
    image.Axes[1][2] = shear * random.Uniform(-1.0, 1.0) * image.Axes[2][2];
  }
  if constexpr (D == 4)
  {
    image.Dimensions[3] = random.Integer(2, 8);
    image.Axes[3][3] = unit * (random.Chance(0.3) ? 1.0 : random.LogUniform(0.3, 5.0));
  }
  return image;
}

//------------------------------------------------------------------------------------------------
namespace
{

using GreyFunction = float (*)(double x, double y, double z, double t, const double* parameters);

float Waves(double x, double y, double z, double t, const double* p)
{
  return static_cast<float>(std::sin(p[0] * x + p[1] * y + p[6] + t * p[7]) +
    std::sin(p[2] * y + p[3] * z + t * p[8]) + std::cos(p[4] * z + p[5] * x));
}

float Ball(double x, double y, double z, double t, const double* p)
{
  return static_cast<float>(
    std::hypot(p[0] * (x - p[9]), p[1] * (y - p[10]), p[2] * (z - p[11])) - t * p[7]);
}

float Ramp(double x, double y, double z, double t, const double* p)
{
  return static_cast<float>(p[0] * x + p[1] * y + p[2] * z + p[7] * t);
}

} // namespace

template <int D>
void ClassifyGreyValues(Volume<D>& image)
{
  const GreySurface& surface = *image.Surface;
  const auto label = static_cast<std::int32_t>(surface.Label);
  image.Labels.resize(image.Grey.size());
  for (std::size_t i = 0; i < image.Grey.size(); ++i)
  {
    const double value = image.Grey[i];
    const bool inside = surface.InsideIsAbove ? value >= surface.Value : value <= surface.Value;
    image.Labels[i] = inside ? label : 0; // a value that is not a number is outside
  }
}

template <int D>
std::string FillWithGreyValues(Volume<D>& image, Random& random)
{
  const auto kind = static_cast<std::size_t>(random.Integer(0, 4));
  std::array<double, 12> p{};
  for (std::size_t k = 0; k < p.size(); ++k)
  {
    p[k] = random.Uniform(0.1, 1.2);
  }
  for (std::size_t a = 0; a < 3; ++a)
  {
    p[9 + a] = random.Uniform(0.0, static_cast<double>(image.Dimensions[a]));
  }
  const double noise = random.Chance(0.5) ? 0.0 : random.LogUniform(0.001, 1.0);
  const double step = random.Chance(0.3) ? random.LogUniform(0.01, 1.0) : 0.0; // of values
  const double holes = random.Chance(0.1) ? 0.05 : 0.0;
  image.Grey.resize(image.Size());
  image.ForEach(
    [&](const Index<D>& voxel, std::size_t i)
    {
      const double t = D == 4 ? static_cast<double>(voxel[std::size_t(D) - 1]) : 0.0;
      const std::array<double, 3> x = { double(voxel[0]), double(voxel[1]), double(voxel[2]) };
      const GreyFunction f = kind == 0 ? Waves : kind == 1 ? Ball : Ramp;
      double value = kind < 3 ? f(x[0], x[1], x[2], t, p.data()) : 0.0;
      value += kind == 3 ? random.Normal() : kind == 4 ? double(random.Integer(0, 2)) : 0.0;
      value += noise * random.Normal();
      value = step > 0.0 ? step * std::round(value / step) : value;
      image.Grey[i] =
        random.Chance(holes) ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(value);
    });
  // Sometimes an isovalue that a voxel has, otherwise the mean of two values.
  GreySurface surface;
  const auto any = [&] { return image.Grey[image.At(RandomVoxel(image, random))]; };
  const double a = any();
  surface.Value = random.Chance(0.3) ? a : 0.5 * (a + any());
  surface.InsideIsAbove = random.Chance(0.5);
  surface.Label = random.OneOf({ 1, 1, 1, 7, 100000 });
  surface.SmoothingSigma = random.Chance(0.8) ? 0.0 : random.Uniform(0.2, 2.0);
  image.Surface = surface;
  ClassifyGreyValues(image);
  static const std::array<const char*, 5> names = { "waves", "ball", "ramp", "noise", "steps" };
  return names[kind];
}

void RepeatFirstFrame(Volume<4>& image)
{
  const auto frame = static_cast<std::ptrdiff_t>(image.Labels.size()) / image.Dimensions[3];
  std::copy_n(image.Labels.begin(), frame, image.Labels.end() - frame);
}

template Volume<3> RandomGrid<3>(Random&);
template Volume<4> RandomGrid<4>(Random&);
template std::string FillWithLabels<3>(Volume<3>&, Random&);
template std::string FillWithLabels<4>(Volume<4>&, Random&);
template std::string FillWithGreyValues<3>(Volume<3>&, Random&);
template std::string FillWithGreyValues<4>(Volume<4>&, Random&);
template void ClassifyGreyValues<3>(Volume<3>&);
template void ClassifyGreyValues<4>(Volume<4>&);

} // namespace voxplex::stress
