// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// The fewest points that bring out a sheet, a rod and a grain.
#include "Domain/ImageDomain.h"
#include "Domain/ThinPart.h"
#include "Phantoms.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

using namespace voxplex;

namespace
{

using Index = GridGeometry<3>::Index;

/** Label 2 in a block of label 1, in as many voxels along each axis as given, around the middle. */
LabelImage<3> Inclusion(const std::array<double, 3>& size, const Point<3>& spacing)
{
  return phantoms::Make(GridGeometry<3>::Orthogonal({ 30, 30, 30 }, spacing),
    [&](const Point<3>& p) -> std::int16_t
    {
      bool isIn = true;
      for (std::size_t a = 0; a < 3; ++a)
      {
        isIn &= std::abs(p[a] / spacing[a] - 15.0) < 0.5 * size[a];
      }
      return isIn ? 2 : 1;
    });
}

} // namespace

//------------------------------------------------------------------------------------------------
TEST(ThinPart, HasEndsAlongThinAxesOnly)
{
  const Point<3> spacing{ 1.0, 0.5, 2.0 };
  const struct
  {
    std::array<double, 3> Size; ///< in voxels
    std::size_t Ends;
    double Thickness;
  } cases[] = { { { 1, 25, 25 }, 2, 1.0 }, { { 25, 25, 1 }, 2, 2.0 }, { { 1, 3, 25 }, 4, 1.0 },
    { { 3, 5, 1 }, 6, 2.0 }, { { 3, 15, 1 }, 4, 2.0 } };
  for (const auto& [size, ends, thickness] : cases)
  {
    SCOPED_TRACE(testing::Message() << size[0] << " x " << size[1] << " x " << size[2]);
    const LabelImage<3> image = Inclusion(size, spacing);
    const ImageDomain<3> domain(image, 0.0); // stairs: interfaces are the faces of voxels
    const ThinPart<3> part(image, domain, { 15, 15, 15 });
    EXPECT_NEAR(part.Thickness(), thickness, 0.02);
    ASSERT_EQ(part.Ends().size(), ends);
    const Point<3> centre = image.CentreOf({ 15, 15, 15 });
    for (std::size_t e = 0; e < ends; e += 2) // two opposite ones follow each other
    {
      const Point<3> middle = Interpolate(part.Ends()[e], part.Ends()[e + 1], 0.5);
      EXPECT_LT(Distance(middle, centre), 0.02);
      EXPECT_LE(Distance(part.Ends()[e], part.Ends()[e + 1]), 1.6 * thickness + 0.05);
    }
  }
}

//------------------------------------------------------------------------------------------------
TEST(ThinPart, FollowsALabelOnlySoFar)
{
  const LabelImage<3> image = Inclusion({ 25, 25, 25 }, { 1.0, 1.0, 1.0 });
  const ImageDomain<3> domain(image, 0.0);
  const ThinPart<3> inside(image, domain, { 15, 15, 15 });
  EXPECT_TRUE(inside.Ends().empty());
  EXPECT_DOUBLE_EQ(inside.Thickness(), 2.0 * static_cast<double>(ThinPart<3>::MostSteps));
}

//------------------------------------------------------------------------------------------------
TEST(ThinPart, IsBetterWhereTheLabelIsThickerOrTheRimFarther)
{
  const LabelImage<3> image = Inclusion({ 3, 9, 9 }, { 1.0, 1.0, 1.0 });
  const ImageDomain<3> domain(image, 0.0);
  const ThinPart<3> middle(image, domain, { 15, 15, 15 });
  const ThinPart<3> side(image, domain, { 14, 15, 15 }); // as thick, nearer to its face
  const ThinPart<3> rim(image, domain, { 15, 19, 15 });
  EXPECT_TRUE(middle.IsBetterThan(side));
  EXPECT_FALSE(side.IsBetterThan(middle));
  EXPECT_TRUE(middle.IsBetterThan(rim));
  const LabelImage<3> thick = Inclusion({ 5, 9, 9 }, { 1.0, 1.0, 1.0 });
  const ImageDomain<3> thickDomain(thick, 0.0);
  EXPECT_TRUE(ThinPart<3>(thick, thickDomain, { 13, 15, 15 }).IsBetterThan(middle));
}
