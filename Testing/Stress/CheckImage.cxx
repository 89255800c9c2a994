// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Compares a mesh with its image: interfaces, extent, volumes, connected components.
#include "Checks.h"

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <string>

namespace voxplex::stress
{

namespace
{

template <int D>
using Index = typename Volume<D>::Index;

/** Tolerance of points on interfaces, in voxels. */
constexpr double SearchPrecision = 0.02;
/**
 * The same for isosurfaces. A search ends where the interpolant differs from the isovalue by a
 * thousandth of the cell's range. At a corner where the isovalue is nearly reached this can be a
 * tenth of a voxel away, the cube root of it.
 */
constexpr double SearchPrecisionOfIsosurfaces = 0.1;
/** Distance by which optimisation may move vertices off interfaces, in deltas. */
constexpr double OptimisationTolerance = 0.25;

/** How far FitInterfaces() may move vertices along each axis, in voxels. */
template <int D>
constexpr double FitTolerance = D == 3 ? 1.0 : 0.5;

/** The same of OptimisePentatopes(). */
constexpr double MoveTolerance = 0.5;

/**
 * Calls f for each index of a box, ends included, until f returns false.
 * @return whether f never returned false
 */
template <int D, typename Function>
bool AllInBox(const Index<D>& low, const Index<D>& high, Function f)
{
  Index<D> voxel = low;
  for (bool more = true; more;)
  {
    if (!f(voxel))
    {
      return false;
    }
    more = false;
    for (std::size_t a = 0; a < voxel.size() && !more; ++a)
    {
      more = ++voxel[a] <= high[a];
      voxel[a] = more ? voxel[a] : low[a];
    }
  }
  return true;
}

/** Whether the label of each voxel is known. It is not if grey values were smoothed. */
template <int D>
bool KnowsLabels(const Volume<D>& image)
{
  return !image.Surface || image.Surface->SmoothingSigma == 0.0;
}

//------------------------------------------------------------------------------------------------
/** Whether the voxels around a point have different labels. If not, no interface can be there. */
template <int D>
bool MayBeOnInterface(
  const Volume<D>& image, const Vector<D>& p, double precision, double tolerance)
{
  const Vector<D> at = image.ToIndex(p);
  Index<D> low;
  Index<D> high;
  for (std::size_t a = 0; a < low.size(); ++a)
  {
    const double reach = precision + tolerance / image.LayerDistance(a);
    low[a] = static_cast<std::int64_t>(std::floor(at[a] - reach));
    high[a] = static_cast<std::int64_t>(std::floor(at[a] + reach)) + 1;
  }
  const std::int32_t first = image.LabelAt(low);
  return !AllInBox<D>(
    low, high, [&](const Index<D>& voxel) { return image.LabelAt(voxel) == first; });
}

/** How far optimisation may have moved vertices off the interfaces. */
template <int D>
double ToleranceOf(const Subject<D>& subject)
{
  return D == 3 && subject.Of.Options.Optimisation.Run ? OptimisationTolerance * subject.Stats.Delta
                                                       : 0.0;
}

template <int D>
void CheckInterfaceVertices(const Subject<D>& subject, Findings& findings)
{
  const SimplexMesh<D>& mesh = subject.Mesh;
  const Volume<D>& image = subject.Of.Image;
  std::vector<char> onFacet(mesh.Points.size(), 0);
  for (const auto& facet : mesh.Facets)
  {
    for (const std::uint32_t v : facet)
    {
      onFacet[v] = 1;
    }
  }
  const MeshingOptions<D>& options = subject.Of.Options;
  const double tolerance = ToleranceOf(subject);
  const double precision = (image.Surface ? SearchPrecisionOfIsosurfaces : SearchPrecision) +
    (subject.IsFitted() ? FitTolerance<D> : 0.0) +
    (D == 4 && options.Optimisation.Run ? MoveTolerance : 0.0);
  std::uint64_t off = 0;
  std::size_t first = 0;
  for (std::size_t v = 0; v < mesh.Points.size(); ++v)
  {
    if (onFacet[v] && !MayBeOnInterface<D>(image, mesh.Points[v], precision, tolerance))
    {
      first = off++ == 0 ? v : first;
    }
  }
  if (off > subject.Excused())
  {
    findings.Add("off-interface",
      std::to_string(off) + " vertices of facets (" + std::to_string(subject.Excused()) +
        " excused) are where the image has one label, the first is point " + std::to_string(first));
  }
}

//------------------------------------------------------------------------------------------------
/**
 * The mesh is where the object is, to a voxel and what optimisation may move vertices; its ends in time
 * are those of the image.
 */
template <int D>
void CheckExtent(const Subject<D>& subject, Findings& findings)
{
  const Volume<D>& image = subject.Of.Image;
  Index<D> low;
  Index<D> high;
  low.fill(std::numeric_limits<std::int64_t>::max());
  high.fill(std::numeric_limits<std::int64_t>::min());
  image.ForEach(
    [&](const Index<D>& voxel, std::size_t i)
    {
      for (std::size_t a = 0; image.Labels[i] != 0 && a < low.size(); ++a)
      {
        low[a] = std::min(low[a], voxel[a]);
        high[a] = std::max(high[a], voxel[a]);
      }
    });
  const double tolerance = ToleranceOf(subject);
  std::uint64_t outside = 0;
  for (const Vector<D>& p : subject.Mesh.Points)
  {
    const Vector<D> at = image.ToIndex(p);
    for (std::size_t a = 0; a < low.size(); ++a)
    {
      const bool isTime = a == 3;
      const double reach = 1.0 + SearchPrecision + tolerance / image.LayerDistance(a);
      const double before = isTime && low[a] == 0 ? 1e-9 : reach;
      const double after = isTime && high[a] + 1 == image.Dimensions[a] ? 1e-9 : reach;
      if (at[a] < static_cast<double>(low[a]) - before ||
        at[a] > static_cast<double>(high[a]) + after)
      {
        ++outside;
        break;
      }
    }
  }
  if (outside > subject.Excused())
  {
    findings.Add(
      "outside", std::to_string(outside) + " points are more than a voxel off the object");
  }
}

//------------------------------------------------------------------------------------------------
/** Volumes of labels differ by at most the area of the boundary times its likely error. */
template <int D>
void CheckVolumes(const Subject<D>& subject, Findings& findings)
{
  const Volume<D>& image = subject.Of.Image;
  std::map<std::int64_t, Real> volume; // volume in the mesh minus volume in the image
  for (std::size_t s = 0; s < subject.Mesh.Simplices.size(); ++s)
  {
    volume[subject.Mesh.Labels[s]] += VolumeOf<D>(subject.Corners(s));
  }
  std::map<std::int64_t, Real> area; // area of the boundary's voxel faces
  image.ForEach(
    [&](const Index<D>& voxel, std::size_t i)
    {
      const std::int32_t label = image.Labels[i];
      if (label == 0)
      {
        return;
      }
      volume[label] -= image.VoxelVolume();
      for (std::size_t a = 0; a < voxel.size(); ++a)
      {
        for (const std::int64_t step : { -1, 1 })
        {
          Index<D> other = voxel;
          other[a] += step;
          area[label] += image.LabelAt(other) != label ? image.FaceArea(a) : 0.0;
        }
      }
    });
  const double delta = std::max(subject.Stats.Delta, subject.Stats.LargestDelta);
  for (const auto& [label, difference] : volume)
  {
    const Real most = area[label] * (image.LargestSpacing() + 0.5 * delta);
    if (std::abs(difference) > most)
    {
      findings.Add("volume",
        "label " + std::to_string(label) + " has " + Text(static_cast<double>(difference)) +
          " more than in the image, where " + Text(static_cast<double>(most)) + " is plausible");
    }
  }
}

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
void CheckAgainstImage(const Subject<D>& subject, Findings& findings)
{
  if (KnowsLabels(subject.Of.Image))
  {
    CheckInterfaceVertices(subject, findings);
    CheckExtent(subject, findings);
    CheckVolumes(subject, findings);
  }
}

//------------------------------------------------------------------------------------------------
namespace
{

/** Connected components through the faces that some axes cross, the first ones. */
template <int D>
class VoxelComponents
{
public:
  VoxelComponents(const Volume<D>& image, std::size_t axes)
    : Of(image)
    , Parent(image.Size())
    , Voxels(image.Size(), 0)
  {
    std::iota(this->Parent.begin(), this->Parent.end(), std::size_t{ 0 });
    image.ForEach(
      [&](Index<D> voxel, std::size_t i)
      {
        for (std::size_t a = 0; a < axes; ++a)
        {
          --voxel[a];
          if (image.Contains(voxel) && image.LabelAt(voxel) == image.Labels[i])
          {
            this->Parent[this->Find(i)] = this->Find(image.At(voxel));
          }
          ++voxel[a];
        }
      });
    for (std::size_t i = 0; i < this->Parent.size(); ++i)
    {
      ++this->Voxels[this->Find(i)];
    }
  }

  /** The component of a voxel: the number of one of its voxels. */
  std::size_t Find(std::size_t i)
  {
    while (this->Parent[i] != i)
    {
      i = this->Parent[i] = this->Parent[this->Parent[i]];
    }
    return i;
  }

  /** The number of voxels of a component. */
  std::int64_t SizeOf(std::size_t component) const { return this->Voxels[component]; }

private:
  const Volume<D>& Of;
  std::vector<std::size_t> Parent;
  std::vector<std::int64_t> Voxels;
};

/**
 * The centroids of the corners of an element's cuts at all frames, as indices. Nothing if a cut is
 * less than a tetrahedron.
 */
std::vector<Vector<4>> CentresOfCuts(const Subject<4>& subject, std::size_t element)
{
  constexpr double tiny = 1e-9; // frames
  std::vector<Vector<4>> corners;
  for (const Vector<4>& corner : subject.Corners(element))
  {
    corners.push_back(subject.Of.Image.ToIndex(corner));
  }
  std::vector<Vector<4>> centres;
  for (std::int64_t frame = 0; frame < subject.Of.Image.Dimensions[3]; ++frame)
  {
    Vector<4> sum{};
    double count = 0.0;
    const auto add = [&](const Vector<4>& p, const Vector<4>& q, double weight)
    {
      for (std::size_t a = 0; a < 4; ++a)
      {
        sum[a] += (1.0 - weight) * p[a] + weight * q[a];
      }
      count += 1.0;
    };
    for (const Vector<4>& p : corners)
    {
      const double before = static_cast<double>(frame) - p[3];
      if (std::abs(before) <= tiny)
      {
        add(p, p, 0.0);
        continue;
      }
      for (const Vector<4>& q : corners)
      {
        const double after = q[3] - static_cast<double>(frame);
        if (before > tiny && after > tiny)
        {
          add(p, q, before / (before + after));
        }
      }
    }
    if (count >= 4.0)
    {
      for (double& x : sum)
      {
        x /= count;
      }
      centres.push_back(sum);
    }
  }
  return centres;
}

template <int D>
Vector<D> CentreOf(const Subject<D>& subject, std::size_t element)
{
  Vector<D> centroid{};
  for (const Vector<D>& corner : subject.Corners(element))
  {
    for (std::size_t a = 0; a < centroid.size(); ++a)
    {
      centroid[a] += corner[a] / (D + 1);
    }
  }
  return subject.Of.Image.ToIndex(centroid);
}

/**
 * Components with an element of their label that is at most about a voxel away: its centroid, or, if
 * components are those of frames, the centroid of its cut.
 */
template <int D>
std::vector<char> FindPresent(
  const Subject<D>& subject, VoxelComponents<D>& components, std::size_t axes)
{
  const Volume<D>& image = subject.Of.Image;
  std::vector<char> present(image.Size(), 0);
  const auto look = [&](const Vector<D>& at, std::size_t s)
  {
    Index<D> low;
    Index<D> high;
    for (std::size_t a = 0; a < low.size(); ++a)
    {
      const std::int64_t reach = a < axes ? 1 : 0;
      low[a] = std::lround(at[a] - 1e-6) - reach;
      high[a] = std::lround(at[a] + 1e-6) + reach;
    }
    AllInBox<D>(low, high,
      [&](const Index<D>& voxel)
      {
        if (image.LabelAt(voxel) == subject.Mesh.Labels[s] && image.Contains(voxel))
        {
          present[components.Find(image.At(voxel))] = 1;
        }
        return true;
      });
  };
  for (std::size_t s = 0; s < subject.Mesh.Simplices.size(); ++s)
  {
    if (axes == D)
    {
      look(CentreOf(subject, s), s);
    }
    else if constexpr (D == 4)
    {
      for (const Vector<D>& centre : CentresOfCuts(subject, s))
      {
        look(centre, s);
      }
    }
  }
  return present;
}

/** Whether all components are there, or listed as lost. */
template <int D>
void CheckComponents(const Subject<D>& subject, std::size_t axes,
  const std::vector<ComponentReport>& lost, Findings& findings)
{
  const std::int64_t smallest = subject.Of.Options.Components.Smallest;
  const Volume<D>& image = subject.Of.Image;
  VoxelComponents<D> components(image, axes);
  const std::vector<char> present = FindPresent(subject, components, axes);
  std::vector<char> listed(image.Size(), 0);
  for (const ComponentReport& report : lost)
  {
    Index<D> voxel{};
    std::copy_n(report.Voxel.begin(), std::min(report.Voxel.size(), voxel.size()), voxel.begin());
    const std::size_t at = image.Contains(voxel) ? image.At(voxel) : 0;
    const std::size_t component = components.Find(at);
    if (image.LabelAt(voxel) != report.Label || components.SizeOf(component) != report.Voxels)
    {
      findings.Add("lost-list", "a component is listed as lost that the image has not");
      continue;
    }
    listed[component] = 1;
  }
  for (std::size_t i = 0; i < image.Size(); ++i)
  {
    const bool counts =
      components.Find(i) == i && image.Labels[i] != 0 && components.SizeOf(i) >= smallest;
    if (counts && !present[i] && !listed[i])
    {
      findings.Add("lost",
        "a component of label " + std::to_string(image.Labels[i]) + " with " +
          std::to_string(components.SizeOf(i)) + " voxels is neither there nor listed" +
          (axes < D ? ", in a frame" : ""));
    }
  }
}

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
void CheckComponents(const Subject<D>& subject, MeshFigures& figures, Findings& findings)
{
  const MeshingStatistics& stats = subject.Stats;
  figures.Lost = stats.Components.Lost.size() + stats.FrameComponents.Lost.size();
  if (subject.Of.Options.Components.Smallest == 0 || !KnowsLabels(subject.Of.Image))
  {
    return;
  }
  CheckComponents(subject, D, stats.Components.Lost, findings);
  if (D == 4)
  {
    CheckComponents(subject, D - 1, stats.FrameComponents.Lost, findings);
  }
}

template void CheckAgainstImage<3>(const Subject<3>&, Findings&);
template void CheckAgainstImage<4>(const Subject<4>&, Findings&);
template void CheckComponents<3>(const Subject<3>&, MeshFigures&, Findings&);
template void CheckComponents<4>(const Subject<4>&, MeshFigures&, Findings&);

} // namespace voxplex::stress
