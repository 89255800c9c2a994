// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file BorderedField.h
 * @brief A field of labels and margins, cut by the border of the image.
 */
#ifndef voxplex_BorderedField_h
#define voxplex_BorderedField_h

#include "Domain/BorderPlanes.h"
#include "Domain/TiledLattice.h"

#include <array>
#include <cstddef>

namespace voxplex
{

/**
 * @brief Base class of LabelField and ScalarField. It cuts the object at the border of the image.
 *
 * The labels and margins of the derived classes (Extended...) continue beyond the border's planes.
 *
 * Lattice coordinates are those of TiledLattice. Immutable after construction.
 *
 * @tparam Field the derived class. It has ExtendedLabelAt(x), ExtendedMarginAt(x, label) and
 *   ExtendedMarginGradientAt(x, label, gradient)
 */
template <int D, typename Sample, typename Field>
class BorderedField : public TiledLattice<D, Sample>
{
public:
  /** The planes on which the image cuts the object; in 4D there are none. */
  const BorderPlanes<D>& Borders() const { return this->Planes; }

  /** Label of a point of the frame. Outside of the lattice it is background. */
  LabelId Label(const Point<D>& p) const { return this->LabelAt(this->ToLattice(p)); }

  /**
   * Margin of a label at a point of the frame: positive exactly where Label(p) == label, else zero
   * or negative. See ExtendedMarginAt() of the field for its unit.
   */
  double Margin(const Point<D>& p, LabelId label) const
  {
    return this->MarginAt(this->ToLattice(p), label);
  }

  /** Label() at lattice coordinates. */
  LabelId LabelAt(const Point<D>& x) const
  {
    return this->Planes.Exist() && !(this->Planes.Distance(x) > 0.0)
      ? LabelId{ 0 }
      : this->Self().ExtendedLabelAt(x);
  }

  /** Margin() at lattice coordinates. */
  double MarginAt(const Point<D>& x, LabelId label) const
  {
    return this->Planes.Margin(x, label, this->Self().ExtendedMarginAt(x, label));
  }

  /**
   * Gradient of MarginAt() with respect to lattice coordinates, or a multiple of it.
   * @return false if it is unknown: in a uniform tile away from borders, or if the tile does not
   *   have `label`
   */
  bool MarginGradientAt(const Point<D>& x, LabelId label, Point<D>& gradient) const
  {
    return (this->Planes.Exist() &&
             this->Planes.Gradient(x, label, this->Self().ExtendedMarginAt(x, label), gradient)) ||
      this->Self().ExtendedMarginGradientAt(x, label, gradient);
  }

protected:
  using Base = TiledLattice<D, Sample>;

  explicit BorderedField(const LabelImage<D>& image)
    : Base(image)
    , Planes(image)
  {
  }

private:
  const Field& Self() const { return static_cast<const Field&>(*this); }

  BorderPlanes<D> Planes;
};

} // namespace voxplex

#endif
