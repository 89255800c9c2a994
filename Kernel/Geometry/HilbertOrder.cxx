// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause

#include "Geometry/HilbertOrder.h"

#include <algorithm>
#include <array>
#include <utility>

namespace voxplex
{

namespace
{

/**
 * @brief The path of a Hilbert curve through the parts of a cube, as a finite automaton.
 *
 * A state is the symmetry of the cube that maps the curve through the whole cube to the curve
 * through a part: the axes are permuted, and some are reversed. The states follow from the
 * exchanges and inversions of lower bits in J. Skilling, "Programming the Hilbert curve", AIP Conf.
 * Proc. 707 (2004).
 */
template <int D>
class HilbertAutomaton
{
public:
  static constexpr unsigned Axes = static_cast<unsigned>(D);
  static constexpr unsigned Parts = 1u << Axes;

  constexpr HilbertAutomaton()
  {
    std::array<Symmetry, MostStates> states{};
    std::array<std::uint16_t, MostCodes> numbers{}; // by code, state number + 1; 0: no state yet
    for (unsigned a = 0; a < Axes; ++a)
    {
      states[0].Axis[a] = a;
    }
    numbers[states[0].Code()] = 1;
    unsigned known = 1;
    for (unsigned s = 0; s < known; ++s)
    {
      for (unsigned part = 0; part < Parts; ++part)
      {
        const unsigned seen = states[s].Apply(part);
        const Symmetry next = states[s].Next(seen);
        std::uint16_t& number = numbers[next.Code()];
        if (number == 0)
        {
          states[known] = next;
          number = static_cast<std::uint16_t>(++known);
        }
        this->Steps[s][part] = static_cast<std::uint16_t>((number - 1u) * Parts + GrayCode(seen));
      }
    }
  }

  /**
   * The place of a part along the curve, and the state inside the part. After each odd place, all
   * bits of the following places must be inverted; HilbertIndex() does this.
   * @param part bit a is 1 in the upper half along axis a
   */
  void Step(unsigned part, unsigned& state, unsigned& place) const
  {
    const unsigned step = this->Steps[state][part];
    state = step / Parts;
    place = step % Parts;
  }

private:
  static constexpr unsigned MostStates = D == 3 ? 48 : 384; ///< symmetries of a cube
  static constexpr unsigned MostCodes = 1u << (3 * Axes);

  struct Symmetry
  {
    std::array<unsigned, Axes> Axis{};    ///< for each axis of the curve, the axis of the cube
    std::array<unsigned, Axes> Reverse{}; ///< 1 if the axis is reversed, else 0

    constexpr unsigned Code() const
    {
      unsigned code = 0;
      for (unsigned a = 0; a < Axes; ++a)
      {
        code = code << 3 | this->Axis[a] << 1 | this->Reverse[a];
      }
      return code;
    }
    /** The part in the axes of the curve. */
    constexpr unsigned Apply(unsigned part) const
    {
      unsigned seen = 0;
      for (unsigned a = 0; a < Axes; ++a)
      {
        seen |= (((part >> this->Axis[a]) & 1u) ^ this->Reverse[a]) << a;
      }
      return seen;
    }
    /**
     * The symmetry inside a part. For each axis: if the part is in the upper half, the first axis
     * is reversed; otherwise the first axis is exchanged with this axis.
     */
    constexpr Symmetry Next(unsigned seen) const
    {
      Symmetry next = *this;
      for (unsigned a = 0; a < Axes; ++a)
      {
        if ((seen >> a) & 1u)
        {
          next.Reverse[0] ^= 1u;
        }
        else
        {
          std::swap(next.Axis[0], next.Axis[a]);
          std::swap(next.Reverse[0], next.Reverse[a]);
        }
      }
      return next;
    }
  };

  /** The place of a part: the inverse of the Gray code. The first axis has the highest bit. */
  static constexpr unsigned GrayCode(unsigned seen)
  {
    unsigned code = 0;
    unsigned bit = 0;
    for (unsigned a = 0; a < Axes; ++a)
    {
      bit ^= (seen >> a) & 1u;
      code = code << 1 | bit;
    }
    return code;
  }

  std::array<std::array<std::uint16_t, Parts>, MostStates> Steps{}; ///< next state and place
};

} // namespace

template <int D>
std::uint64_t HilbertIndex(const Point<D>& p, const Box<D>& box)
{
  static const HilbertAutomaton<D> automaton;
  constexpr unsigned Axes = static_cast<unsigned>(D);
  constexpr unsigned Bits = 63 / Axes;
  double side = 0.0;
  for (unsigned a = 0; a < Axes; ++a)
  {
    side = std::max(side, box.Max[a] - box.Min[a]);
  }
  constexpr double Largest = static_cast<double>((1u << Bits) - 1);
  std::array<std::uint32_t, Axes> x;
  for (unsigned a = 0; a < Axes; ++a)
  {
    const double t = (p[a] - box.Min[a]) / side * Largest;
    x[a] = static_cast<std::uint32_t>(std::clamp(t, 0.0, Largest));
  }

  std::uint64_t index = 0;
  unsigned state = 0;
  unsigned reversed = 0; // all bits or none
  for (unsigned b = Bits; b-- > 0;)
  {
    unsigned part = 0;
    for (unsigned a = 0; a < Axes; ++a)
    {
      part |= ((x[a] >> b) & 1u) << a;
    }
    unsigned place = 0;
    automaton.Step(part, state, place);
    index = index << Axes | (place ^ reversed);
    reversed ^= (0u - (place & 1u)) & (HilbertAutomaton<D>::Parts - 1u);
  }
  return index;
}

template std::uint64_t HilbertIndex<3>(const Point<3>&, const Box<3>&);
template std::uint64_t HilbertIndex<4>(const Point<4>&, const Box<4>&);

} // namespace voxplex
