// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Private/MeshingMessages.h"

#include "Base/NumberText.h"
#include "MeshingParameters.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace voxplex
{
namespace
{

/** With the order of its axes, which arrays of Python have reversed. */
std::string DescribeVoxel(const std::vector<std::int64_t>& voxel)
{
  std::string text = voxel.size() > 3 ? "(i, j, k, t) = (" : "(i, j, k) = (";
  for (const std::int64_t& i : voxel)
  {
    text += (&i == voxel.data() ? "" : ", ") + std::to_string(i);
  }
  return text + ")";
}

std::string Describe(const ComponentReport& component)
{
  return std::to_string(component.Voxels) + " voxels of label " + std::to_string(component.Label) +
    " at " + DescribeVoxel(component.Voxel);
}

/** The places of the first few, and how many there are. */
std::string Describe(const std::vector<RelaxationReport>& regions)
{
  constexpr std::size_t Most = 5;
  std::string text;
  std::size_t count = 0;
  for (const RelaxationReport& region : regions)
  {
    if (region.Step == 1 && ++count <= Most)
    {
      text += (text.empty() ? "" : ", ") + DescribeVoxel(region.Voxel);
    }
  }
  return std::to_string(count) + (count == 1 ? " region (at voxel " : " regions (at voxels ") +
    text + (count > Most ? ", ...)" : ")");
}

/** At most 20 items, separated by commas, and how many there are. */
template <typename Item, typename Describer>
std::string ListSome(std::span<const Item> items, const Describer& describe)
{
  constexpr std::size_t shown = 20;
  std::string text;
  for (std::size_t i = 0; i < std::min(shown, items.size()); ++i)
  {
    text.append(i ? ", " : "").append(describe(items[i]));
  }
  if (items.size() > shown)
  {
    text.append(", ... (").append(std::to_string(items.size())).append(" in all)");
  }
  return text;
}

} // namespace

void CheckRange(double value, double low, double high, const char* name, const char* must)
{
  if (!(value >= low && value <= high))
  {
    throw InputError(std::string(name) + " is " + NumberText(value) + "; it must be " + must + ".");
  }
}

void CheckValue(const char* name, double value, bool force)
{
  const std::string fault = FaultOf(FindParameter(name), value, force);
  if (!fault.empty())
  {
    throw InputError(fault);
  }
}

std::string ListLabels(std::span<const std::int64_t> labels)
{
  return ListSome(labels, [](std::int64_t label) { return std::to_string(label); });
}

void CheckSizedLabel(std::int64_t label, const std::string& method, bool selected,
  std::span<const std::int64_t> labels)
{
  if (!std::binary_search(labels.begin(), labels.end(), label))
  {
    throw InputError(method + " gives a size to label " + std::to_string(label) + ", which " +
      (selected ? "is not among the labels to mesh; these are "
                : "does not occur in the image; its labels are ") +
      ListLabels(labels) + ".");
  }
}

void CheckNotEmpty(const MeshingStatistics& run)
{
  if (run.Elements == 0)
  {
    throw InputError("The mesh is empty, because every label is too small for a {delta} of " +
      NumberText(run.Delta) + "; use a smaller one.");
  }
}

std::vector<std::string> WarningsOf(const MeshingStatistics& run,
  const std::map<std::int64_t, std::string>& names, const std::string& contentionManager,
  bool exactComponents)
{
  const auto describeLabel = [&names](std::int64_t label)
  {
    const auto name = names.find(label);
    return std::to_string(label) + (name == names.end() ? "" : " (" + name->second + ")");
  };
  std::vector<std::string> warnings;
  if (run.SizesRaisedTo > 0.0)
  {
    warnings.push_back("Some element sizes are below a tenth of {delta} and were raised to " +
      NumberText(run.SizesRaisedTo) + "; use a smaller {delta} for smaller elements.");
  }
  if (!run.LostLabels.empty())
  {
    warnings.push_back(
      "The mesh lacks these labels of the image, which are too small for a {delta} of " +
      NumberText(run.Delta) + ": " +
      ListSome(std::span<const std::int64_t>(run.LostLabels), describeLabel) + ".");
  }
  if (!run.ShrunkLabels.empty())
  {
    const auto describe = [&describeLabel](const ShrunkLabel& label)
    {
      return describeLabel(label.Label) + " (" +
        std::to_string(std::lround(100.0 * label.Fraction)) + " %)";
    };
    warnings.push_back("The mesh lacks a tenth or more of the volume of these labels, which are "
                       "small or thin for a {delta} of " +
      NumberText(run.Delta) + " (with what it has, the worst first): " +
      ListSome(std::span<const ShrunkLabel>(run.ShrunkLabels), describe) +
      (exactComponents ? ". A smaller {delta} keeps them."
                       : ". {exact-components} or a smaller {delta} keeps them."));
  }
  else if (run.VolumeShare <= ShrunkFractionOfAll)
  {
    warnings.push_back("The mesh has " + std::to_string(std::lround(100.0 * run.VolumeShare)) +
      " % of the volume of all labels together, whose parts are small or thin for a {delta} of " +
      NumberText(run.Delta) + ". A smaller {delta} keeps more of them.");
  }
  if (run.FramesOff.Number > 0)
  {
    warnings.push_back("Volumes are off by 3 % or more in " + std::to_string(run.FramesOff.Number) +
      (run.FramesOff.Number == 1 ? " frame" : " frames") + ", most in frame " +
      std::to_string(run.FramesOff.Frame) + " (from 0 on), where the mesh has " +
      std::to_string(std::lround(100.0 * run.FramesOff.Share)) + " % of label " +
      describeLabel(run.FramesOff.Label) +
      ". A larger {time-scale} follows the motion better, a smaller {delta} the shape.");
  }
  const auto warnOfLost = [&](const ComponentStatistics& components, const char* of)
  {
    if (!components.Lost.empty())
    {
      const auto describe = [](const ComponentReport& component) { return Describe(component); };
      warnings.push_back("The mesh lacks these connected components of " + std::string(of) + ": " +
        ListSome(std::span<const ComponentReport>(components.Lost), describe) + ".");
    }
  };
  warnOfLost(run.Components, "the image");
  if (!run.Components.Broken.empty())
  {
    const auto describe = [](const BrokenComponent& component)
    { return Describe(component.Component) + " in " + std::to_string(component.Fragments); };
    warnings.push_back(std::string(run.Dimension == 4 ? "Pentatopes" : "Tetrahedra") +
      " of these connected components of the image are in several pieces that no common faces "
      "connect: " +
      ListSome(std::span<const BrokenComponent>(run.Components.Broken), describe) +
      (exactComponents ? ". A smaller {delta}, or an image with smaller voxels, may connect them."
                       : ". {exact-components} or a smaller {delta} connects them."));
  }
  if (!run.Components.United.empty())
  {
    const auto describe = [](const UnitedComponents& piece)
    { return Describe(piece.Component) + " with " + std::to_string(piece.Number - 1) + " more"; };
    warnings.push_back("These connected components are one piece with others of their label that "
                       "they do not touch in "
                       "the image: " +
      ListSome(std::span<const UnitedComponents>(run.Components.United), describe) +
      (exactComponents ? ". A smaller {delta} may separate them."
                       : ". {exact-components} or a smaller {delta} separates them."));
  }
  if (!run.Components.Contacts.empty())
  {
    const auto describe = [&](const FalseContact& contact)
    {
      const auto side = [&](std::int64_t label)
      { return label == 0 ? std::string("background") : describeLabel(label); };
      return side(contact.Labels[0]) + " and " + side(contact.Labels[1]) + " at " +
        DescribeVoxel(contact.Voxel) + " (" + NumberText(contact.Area) + ")";
    };
    warnings.push_back(
      "Interfaces of the mesh are between labels that do not touch there in the image "
      "(with their " +
      std::string(run.Dimension == 4 ? "volume" : "area") +
      "): " + ListSome(std::span<const FalseContact>(run.Components.Contacts), describe) +
      (exactComponents ? ". A smaller {delta} may separate them."
                       : ". {exact-components} or a smaller {delta} separates them."));
  }
  warnOfLost(run.FrameComponents, "frames of the image");
  if (!run.RelaxedRegions.empty())
  {
    warnings.push_back("In " + Describe(run.RelaxedRegions) +
      " refinement took many times the work that it should need, and stopped improving shapes "
      "there: elements and interface triangles may be out of bounds. A smaller {delta}, or more "
      "smoothing of the labels, helps where the image is rougher than {delta}.");
  }
  if (run.Planes.Refused > 0)
  {
    warnings.push_back(
      "Slabs asked each other for points on their time planes again and again, until the planes "
      "took none any more; slabs match, but elements beside planes may be out of bounds. "
      "Thicker slabs or a smaller {delta} help.");
  }
  if (run.SwitchedToLocal)
  {
    std::uint64_t rollbacks = 0;
    for (const ThreadStatistics& thread : run.Threads)
    {
      rollbacks += thread.Rollbacks;
    }
    warnings.push_back("The threads made no progress with the contention manager '" +
      contentionManager + "' (" + std::to_string(rollbacks) +
      " rollbacks), which cannot exclude a livelock, and the local one took over; set "
      "{contention} to local.");
  }
  return warnings;
}

} // namespace voxplex
