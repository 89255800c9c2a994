// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Time planes and periodic ends: see SpaceTime.md, "Slabs" and "A beat that repeats".
#include "Checks.h"

#include <algorithm>
#include <bit>
#include <map>
#include <set>
#include <string>

namespace voxplex::stress
{

namespace
{

/** A tetrahedron of constant time: corners in space to the bit, sorted, and the label of its pentatope. */
struct FlatFacet
{
  std::array<std::array<std::uint64_t, 3>, 4> Corners;
  std::int64_t Label;

  auto operator<=>(const FlatFacet&) const = default;
};

std::array<std::uint64_t, 3> BitsInSpace(const Vector<4>& p)
{
  return { std::bit_cast<std::uint64_t>(p[0]), std::bit_cast<std::uint64_t>(p[1]),
    std::bit_cast<std::uint64_t>(p[2]) };
}

/** The facets of a time, of the pentatopes before (-1) or after it (+1), sorted. */
std::vector<FlatFacet> FacetsAt(const SimplexMesh<4>& mesh, double time, int side)
{
  std::vector<FlatFacet> facets;
  for (std::size_t s = 0; s < mesh.Simplices.size(); ++s)
  {
    FlatFacet facet{ {}, mesh.Labels[s] };
    std::size_t flat = 0;
    std::size_t there = 0;
    for (const std::uint32_t v : mesh.Simplices[s])
    {
      const Vector<4>& p = mesh.Points[v];
      there += (p[3] - time) * side > 0.0 ? 1 : 0;
      if (p[3] == time && flat < 4)
      {
        facet.Corners[flat++] = BitsInSpace(p);
      }
    }
    if (flat == 4 && there == 1)
    {
      std::sort(facet.Corners.begin(), facet.Corners.end());
      facets.push_back(facet);
    }
  }
  std::sort(facets.begin(), facets.end());
  return facets;
}

/** The first and the last frame with foreground. */
std::array<std::int64_t, 2> FramesOfObject(const Volume<4>& image)
{
  std::array<std::int64_t, 2> frames = { image.Dimensions[3], -1 };
  image.ForEach(
    [&](const Volume<4>::Index& voxel, std::size_t i)
    {
      if (image.Labels[i] != 0)
      {
        frames[0] = std::min(frames[0], voxel[3]);
        frames[1] = std::max(frames[1], voxel[3]);
      }
    });
  return frames;
}

//------------------------------------------------------------------------------------------------
/** The planes are those that were asked for, except those beyond the object. */
void CheckTimes(const Subject<4>& subject, Findings& findings)
{
  const Volume<4>& image = subject.Of.Image;
  const TimePlaneOptions& options = subject.Of.Options.Planes;
  const TimePlaneStatistics& stats = subject.Stats.Planes;
  const auto add = [&](const std::string& what) { findings.Add("planes", what); };
  const double step = image.Axes[3][3];
  const double duration = step * static_cast<double>(image.Dimensions[3] - 1);
  const auto [first, last] = FramesOfObject(image);
  if (!std::is_sorted(stats.Times.begin(), stats.Times.end()) ||
    std::adjacent_find(stats.Times.begin(), stats.Times.end()) != stats.Times.end())
  {
    add("times do not ascend");
  }
  const auto has = [](const std::vector<double>& times, double time)
  { return std::find(times.begin(), times.end(), time) != times.end(); };
  // Half-way, where a periodic mesh gets a plane if it has none.
  const bool isHalfWay = stats.Periodic && stats.Times.size() == 1 &&
    std::abs(stats.Times[0] - 0.5 * duration) < 1e-9 * duration;
  for (const double time : stats.Times)
  {
    if (!(time > 0.0 && time < duration) || (!has(options.Times, time) && !isHalfWay))
    {
      add("nobody asked for a plane at " + Text(time, 17));
    }
  }
  if (image.Surface && image.Surface->SmoothingSigma > 0.0)
  {
    return; // where the object begins and ends is not known
  }
  for (const double time : options.Times)
  {
    const double margin = 1e-8 * duration;
    const bool isInside = time > margin && time < duration - margin &&
      time >= static_cast<double>(first) * step && time <= static_cast<double>(last) * step;
    if (isInside && !has(stats.Times, time))
    {
      add("there is no plane at " + Text(time, 17));
    }
  }
  const bool isPeriodic = options.Periodic && first == 0;
  if (stats.Periodic != isPeriodic)
  {
    add(isPeriodic ? "the mesh is not periodic" : "nobody asked for a periodic mesh");
  }
  if (isPeriodic && stats.Times.empty())
  {
    add("a periodic mesh has one slab only");
  }
}

/** No pentatope crosses a plane, and each has the number of its slab. */
void CheckSlabs(const Subject<4>& subject, Findings& findings)
{
  const SimplexMesh<4>& mesh = subject.Mesh;
  const std::vector<double>& times = subject.Stats.Planes.Times;
  const bool hasSlabs = !times.empty();
  if (mesh.Slabs.size() != (hasSlabs ? mesh.Simplices.size() : 0))
  {
    findings.Add("slab", std::to_string(mesh.Slabs.size()) + " numbers of slabs");
    return;
  }
  for (std::size_t s = 0; s < mesh.Simplices.size() && hasSlabs; ++s)
  {
    const auto corners = subject.Corners(s);
    const auto [low, high] = std::minmax_element(corners.begin(), corners.end(),
      [](const Vector<4>& p, const Vector<4>& q) { return p[3] < q[3]; });
    // The planes up to the lowest vertex, and those before the highest one.
    const auto slab = std::upper_bound(times.begin(), times.end(), (*low)[3]) - times.begin();
    const auto end = std::lower_bound(times.begin(), times.end(), (*high)[3]) - times.begin();
    if (slab != end)
    {
      findings.Add("crosses-plane",
        "pentatope " + std::to_string(s) + " lies on both sides of the plane at " +
          Text(times[static_cast<std::size_t>(slab)], 17));
    }
    else if (mesh.Slabs[s] != static_cast<std::uint32_t>(slab))
    {
      findings.Add("slab",
        "pentatope " + std::to_string(s) + " is in slab " + std::to_string(slab) + ", not in " +
          std::to_string(mesh.Slabs[s]));
    }
  }
}

/** Both sides of planes have the same tetrahedra with the same labels. @return the number of them */
std::size_t CheckSides(const Subject<4>& subject, Findings& findings)
{
  std::size_t count = 0;
  for (const double time : subject.Stats.Planes.Times)
  {
    const std::vector<FlatFacet> before = FacetsAt(subject.Mesh, time, -1);
    const std::vector<FlatFacet> after = FacetsAt(subject.Mesh, time, 1);
    count += before.size();
    if (before != after)
    {
      findings.Add("plane-sides",
        "the plane at " + Text(time, 17) + " has " + std::to_string(before.size()) +
          " tetrahedra before it and " + std::to_string(after.size()) +
          " after it, or others, or other labels");
    }
  }
  return count;
}

//------------------------------------------------------------------------------------------------
/** Pairs of twins are those of points at both ends that have the same place in space. */
void CheckTwins(const SimplexMesh<4>& mesh, double first, double last, Findings& findings)
{
  std::set<std::uint32_t> paired;
  for (const auto& [a, b] : mesh.Twins)
  {
    if (a >= mesh.Points.size() || b >= mesh.Points.size() || mesh.Points[a][3] != first ||
      mesh.Points[b][3] != last || BitsInSpace(mesh.Points[a]) != BitsInSpace(mesh.Points[b]))
    {
      findings.Add("twins",
        "points " + std::to_string(a) + " and " + std::to_string(b) + " are not at the same place");
    }
    if (!paired.insert(a).second || !paired.insert(b).second)
    {
      findings.Add("twins", "point " + std::to_string(a) + " has two twins");
    }
  }
  std::map<std::array<std::uint64_t, 3>, std::uint32_t> atFirst;
  for (std::uint32_t v = 0; v < mesh.Points.size(); ++v)
  {
    if (mesh.Points[v][3] == first)
    {
      atFirst.emplace(BitsInSpace(mesh.Points[v]), v);
    }
  }
  for (std::uint32_t v = 0; v < mesh.Points.size(); ++v)
  {
    const auto twin = atFirst.find(BitsInSpace(mesh.Points[v]));
    if (mesh.Points[v][3] == last && twin != atFirst.end() &&
      (!paired.contains(v) || !paired.contains(twin->second)))
    {
      findings.Add("twins", "point " + std::to_string(v) + " has a twin that is not listed");
    }
  }
}

/** Both ends of a periodic mesh are the same. @return the number of tetrahedra of an end */
std::size_t CheckPeriod(const Subject<4>& subject, Findings& findings)
{
  const SimplexMesh<4>& mesh = subject.Mesh;
  if (!subject.Stats.Planes.Periodic || mesh.Points.empty())
  {
    if (!mesh.Twins.empty())
    {
      findings.Add("twins", "a mesh that is not periodic has twins");
    }
    return 0;
  }
  const auto [low, high] = std::minmax_element(mesh.Points.begin(), mesh.Points.end(),
    [](const Point<4>& p, const Point<4>& q) { return p[3] < q[3]; });
  const double first = (*low)[3];
  const double last = (*high)[3];
  CheckTwins(mesh, first, last, findings);
  const std::vector<FlatFacet> start = FacetsAt(mesh, first, 1);
  const std::vector<FlatFacet> end = FacetsAt(mesh, last, -1);
  if (start != end)
  {
    findings.Add("period",
      "the first end has " + std::to_string(start.size()) + " tetrahedra, the last one " +
        std::to_string(end.size()) + ", or they differ, or have other labels");
  }
  return start.size();
}

} // namespace

//------------------------------------------------------------------------------------------------
void CheckTimePlanes(const Subject<4>& subject, Findings& findings)
{
  CheckTimes(subject, findings);
  CheckSlabs(subject, findings);
  const std::size_t facets = CheckSides(subject, findings) + CheckPeriod(subject, findings);
  const TimePlaneStatistics& stats = subject.Stats.Planes;
  if (stats.Pairs != subject.Mesh.Twins.size())
  {
    findings.Add("statistics", "the number of twins");
  }
  if (stats.Facets != facets)
  {
    findings.Add("statistics",
      std::to_string(facets) + " tetrahedra lie on planes, it says " +
        std::to_string(stats.Facets));
  }
}

} // namespace voxplex::stress
