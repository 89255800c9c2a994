// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "StressCase.h"

#include "RandomImages.h"

#include <algorithm>
#include <limits>

namespace voxplex::stress
{

namespace
{

/** Each family has a stream of its own. */
Random StreamOf(const CaseId& id)
{
  return Random(id.Seed * 3 + static_cast<std::uint64_t>(id.Kind), id.Number);
}

Random LaterStreamOf(const CaseId& id)
{
  constexpr std::uint64_t salt = 0x5374726573733444;
  return Random(id.Seed * 3 + static_cast<std::uint64_t>(id.Kind), id.Number ^ salt);
}

/** Makes some images periodic. For a few, the options ask for a period that the image does not have. */
void DrawPeriod(StressCase<4>& of, Random& later)
{
  of.Options.Planes.Periodic = !of.Image.Surface && later.Chance(0.25);
  if (of.Options.Planes.Periodic && !later.Chance(0.02))
  {
    RepeatFirstFrame(of.Image);
  }
}

/** A SizeRequest as the size function that the kernel takes. */
template <int D>
class RequestedSize final : public SizeFunction<D>
{
public:
  explicit RequestedSize(const SizeRequest& request)
    : Request(request)
  {
  }
  double Evaluate(const Point<D>& p, std::int64_t label) const override
  {
    return this->Request.At(p[0], label);
  }
  bool DependsOnLabelAlone() const override { return this->Request.Slope == 0.0; }

private:
  SizeRequest Request;
};

} // namespace

//------------------------------------------------------------------------------------------------
std::string_view NameOf(Family family)
{
  return family == Family::Space ? "3" : family == Family::SpaceTime ? "4" : "iso";
}

//------------------------------------------------------------------------------------------------
double SizeRequest::At(double x, std::int64_t label) const
{
  double size = std::numeric_limits<double>::infinity();
  size = this->Everywhere > 0.0 ? this->Everywhere : size;
  size = this->OfLabel > 0.0 && label == this->Label ? std::min(size, this->OfLabel) : size;
  return this->Slope > 0.0 ? size + this->Slope * std::abs(x)
                           : size; // x is infinite for flat elements
}

//------------------------------------------------------------------------------------------------
template <int D>
MeshingOptions<D> StressCase<D>::AllOptions() const
{
  MeshingOptions<D> options = this->Options;
  if (this->Size.IsGiven())
  {
    options.Sampling.Size = std::make_shared<const RequestedSize<D>>(this->Size);
  }
  return options;
}

//------------------------------------------------------------------------------------------------
template <int D>
void StressCase<D>::Measure()
{
  const Volume<D>& image = this->Image;
  std::int64_t voxels = 0;
  std::array<std::int64_t, static_cast<std::size_t>(D)> faces{};
  image.ForEach(
    [&](typename Volume<D>::Index voxel, std::size_t i)
    {
      voxels += image.Labels[i] != 0 ? 1 : 0;
      for (std::size_t a = 0; a < faces.size(); ++a)
      {
        // The face before the voxel, and the image's last face, which borders on background.
        const bool last = voxel[a] + 1 == image.Dimensions[a];
        --voxel[a];
        faces[a] += image.LabelAt(voxel) != image.Labels[i] ? 1 : 0;
        faces[a] += last && image.Labels[i] != 0 ? 1 : 0;
        ++voxel[a];
      }
    });
  this->ObjectVolume = static_cast<double>(voxels) * image.VoxelVolume();
  this->InterfaceArea = 0.0;
  for (std::size_t a = 0; a < faces.size(); ++a)
  {
    this->InterfaceArea += static_cast<double>(faces[a]) * image.FaceArea(a);
  }
}

//------------------------------------------------------------------------------------------------
template <int D>
double StressCase<D>::Delta() const
{
  return this->Options.Sampling.Delta > 0.0 ? this->Options.Sampling.Delta
                                            : 2.0 * std::pow(this->Image.VoxelVolume(), 1.0 / D);
}

//------------------------------------------------------------------------------------------------
template <int D>
double StressCase<D>::ExpectedElements() const
{
  return this->ExpectedElements(D == 3);
}

template <int D>
double StressCase<D>::ExpectedElementsIfThin() const
{
  return this->ExpectedElements(true);
}

template <int D>
double StressCase<D>::ExpectedElements(bool isThin) const
{
  const double voxel = std::pow(this->Image.VoxelVolume(), 1.0 / D);
  double delta = this->Delta();
  for (const InterfaceSize& size : this->Options.Sampling.InterfaceSizes)
  {
    delta = std::min(delta, size.Size);
  }
  const double sampling = isThin ? std::min(delta, 2.0 * voxel) : delta;
  double elements = (D == 3 ? 8.0 : 4.0) * this->InterfaceArea / std::pow(sampling, D - 1);
  elements += (D == 3 ? 2.0 : 1.0) * this->ObjectVolume / std::pow(2.0 * delta, D);
  const double size = std::min(this->Size.Everywhere > 0.0 ? this->Size.Everywhere : 1e30,
    this->Size.OfLabel > 0.0 ? this->Size.OfLabel : 1e30);
  elements += (D == 3 ? 8.0 : 40.0) * this->ObjectVolume / std::pow(size, D);
  return std::max(elements, static_cast<double>(this->Options.Sampling.Elements));
}

//------------------------------------------------------------------------------------------------
bool IsSpaceTime(const CaseId& id)
{
  return id.Kind == Family::SpaceTime ||
    (id.Kind == Family::Isosurface && StreamOf(id).Chance(0.1));
}

//------------------------------------------------------------------------------------------------
template <int D>
StressCase<D> MakeCase(const CaseId& id)
{
  Random random = StreamOf(id);
  random.Next(); // skip the number that IsSpaceTime() takes
  StressCase<D> made;
  made.Id = id;
  made.Image = RandomGrid<D>(random);
  // Draws that were added later have a stream of their own, so that the others keep their meaning.
  Random later = LaterStreamOf(id);
  const bool isGrey =
    id.Kind == Family::Isosurface || (id.Kind == Family::SpaceTime && later.Chance(0.15));
  made.Kind = isGrey ? FillWithGreyValues(made.Image, random) : FillWithLabels(made.Image, random);
  if constexpr (D == 4)
  {
    DrawPeriod(made, later);
  }
  made.Measure();
  DrawOptions(made, random);
  if constexpr (D == 4)
  {
    made.Options.Interfaces.Manifold = later.Chance(0.9);
    DrawTimePlanes(made, later);
  }
  return made;
}

template struct StressCase<3>;
template struct StressCase<4>;
template StressCase<3> MakeCase<3>(const CaseId&);
template StressCase<4> MakeCase<4>(const CaseId&);

} // namespace voxplex::stress
