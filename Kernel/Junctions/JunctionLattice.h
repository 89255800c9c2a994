// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file JunctionLattice.h
 * @brief Internal to JunctionCurves: the fine lattice, its labels, and the places of curves on it.
 */
#ifndef voxplex_JunctionLattice_h
#define voxplex_JunctionLattice_h

#include "Image/LabelImage.h"

#include <array>
#include <bit>
#include <cstdint>

namespace voxplex::junctions
{

using Index = GridGeometry<3>::Index;

/** Points of the fine lattice per voxel along each axis. */
inline constexpr std::int64_t Fine = 2;

/** The place of a point of a curve: a triangle or a tetrahedron of the subdivision. */
struct LatticeSimplex
{
  std::array<std::int64_t, 3> Base; ///< first corner, on the fine lattice
  std::uint8_t Second; ///< steps from the first corner to the second, one bit for each axis
  std::uint8_t Third;  ///< steps from the first corner to the third
  bool IsCorner;       ///< the place is a tetrahedron; Second and Third identify it
};

/** Places as numbers, for sorting and comparing. */
class Numbering
{
public:
  using Number = std::uint64_t;

  explicit Numbering(const Index& lattice)
    : Side{ static_cast<std::uint64_t>(Fine * lattice[0]),
      static_cast<std::uint64_t>(Fine * lattice[1]) }
    , Layers(static_cast<std::uint64_t>(Fine * lattice[2]))
  {
  }

  /** All numbers are below 2 to the power of Bits(). */
  unsigned Bits() const
  {
    return 7 + static_cast<unsigned>(std::bit_width(this->Side[0] * this->Side[1] * this->Layers));
  }

  Number Encode(const LatticeSimplex& place) const
  {
    const auto x = [&](unsigned a) { return static_cast<std::uint64_t>(place.Base[a]); };
    const std::uint64_t base = (x(2) * this->Side[1] + x(1)) * this->Side[0] + x(0);
    return base << 7 | static_cast<std::uint64_t>(place.Third) << 4 |
      static_cast<std::uint64_t>(place.Second) << 1 | (place.IsCorner ? 1 : 0);
  }
  LatticeSimplex Decode(Number number) const
  {
    const std::uint64_t base = number >> 7;
    const std::uint64_t row = base / this->Side[0];
    return { { static_cast<std::int64_t>(base % this->Side[0]),
               static_cast<std::int64_t>(row % this->Side[1]),
               static_cast<std::int64_t>(row / this->Side[1]) },
      static_cast<std::uint8_t>((number >> 1) & 7), static_cast<std::uint8_t>((number >> 4) & 7),
      IsCorner(number) };
  }
  static bool IsCorner(Number number) { return number & 1; }
  /**
   * Whether a triangle contains the diagonal along which a cube of the fine lattice is cut into
   * tetrahedra.
   */
  static bool IsInsideOfCube(Number number)
  {
    return !IsCorner(number) && ((number >> 4) & 7) == 7;
  }

private:
  std::array<std::uint64_t, 2> Side;
  std::uint64_t Layers;
};

/** The numbers of the two places that a segment joins, and the labels of their triangles. */
struct Segment
{
  std::array<Numbering::Number, 2> Ends;
  std::array<std::array<LabelId, 3>, 2> Labels;
};

//------------------------------------------------------------------------------------------------
/**
 * The labels of the lattice. If the image cuts the object at a face, the space behind it has a
 * label of its own, so that the edges of these faces are junctions, too.
 */
template <typename Field>
class LabelledSpace
{
public:
  LabelledSpace(const LabelImage<3>& image, const Field& field)
    : Image(image)
    , Interior(field)
    , FirstOutside(static_cast<LabelId>(image.NumberOfLabels() + 1))
  {
  }

  const Index& LatticeDimensions() const { return this->Interior.LatticeDimensions(); }
  Point<3> ToFrame(const Point<3>& x) const { return this->Interior.ToFrame(x); }

  /** Lattice coordinates of a point of the fine lattice. */
  static Point<3> OfFine(const Index& fine)
  {
    Point<3> x;
    for (std::size_t a = 0; a < 3; ++a)
    {
      x[a] = static_cast<double>(fine[a]) / Fine;
    }
    return x;
  }

  bool IsOutside(LabelId id) const { return id >= this->FirstOutside; }
  /** Whether three labels make a junction: they are different, and one of them is foreground. */
  bool IsJunction(const std::array<LabelId, 3>& l) const
  {
    return l[0] != l[1] && l[0] != l[2] && l[1] != l[2] &&
      (this->IsForeground(l[0]) || this->IsForeground(l[1]) || this->IsForeground(l[2]));
  }

  LabelId VoxelId(const Index& lattice) const
  {
    Point<3> x;
    for (std::size_t a = 0; a < 3; ++a)
    {
      x[a] = static_cast<double>(lattice[a]);
    }
    const LabelId behind = this->LabelBehind(x);
    return behind != 0 ? behind : this->Image.AtLattice(lattice);
  }

  /** The label at lattice coordinates. A point on a face belongs to the inside. */
  LabelId LabelAt(const Point<3>& x) const
  {
    const LabelId behind = this->LabelBehind(x);
    return behind != 0 ? behind : this->Interior.ExtendedLabelAt(x);
  }
  double MarginAt(const Point<3>& x, LabelId label) const
  {
    return this->Interior.ExtendedMarginAt(x, label);
  }
  std::array<double, 3> MarginsAt(const Point<3>& x, const std::array<LabelId, 3>& labels) const
  {
    return this->Interior.ExtendedMarginsAt(x, labels);
  }

  /** The label at a point of the fine lattice. Voxel centres keep their labels. */
  LabelId LabelAtFine(const Index& fine) const
  {
    static_assert(Fine == 2);
    if (((fine[0] | fine[1] | fine[2]) & 1) == 0)
    {
      return this->VoxelId({ fine[0] / 2, fine[1] / 2, fine[2] / 2 });
    }
    return this->LabelAt(OfFine(fine));
  }

  /**
   * The labels of a row of voxels, beginning at the first voxel of the bounding box; null if the
   * row is outside of the box.
   */
  const LabelId* RowOf(std::int64_t y, std::int64_t z) const
  {
    const Index& n = this->Image.CropDimensions();
    return y < 1 || y > n[1] || z < 1 || z > n[2]
      ? nullptr
      : this->Image.Ids().data() + ((z - 1) * n[1] + y - 1) * n[0];
  }

private:
  bool IsForeground(LabelId id) const { return id != 0 && !this->IsOutside(id); }

  /** The label of the first face that x lies beyond; background if there is none. */
  LabelId LabelBehind(const Point<3>& x) const
  {
    if (this->Interior.Borders().Exist())
    {
      for (unsigned face = 0; face < 6; ++face)
      {
        if (this->Interior.Borders().IsBeyond(x, face))
        {
          return static_cast<LabelId>(this->FirstOutside + face);
        }
      }
    }
    return 0;
  }

  const LabelImage<3>& Image;
  const Field& Interior;
  const LabelId FirstOutside;
};

} // namespace voxplex::junctions

#endif
