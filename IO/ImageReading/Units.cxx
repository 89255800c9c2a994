// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Units.h"

#include "Text.h"

#include <algorithm>
#include <string_view>

namespace voxplex::io
{
namespace
{

struct Unit
{
  std::string_view Name; ///< in the plural
  double Metres;
  std::string_view Spellings; ///< between blanks
};

constexpr std::array<Unit, 10> Lengths{
  Unit{ "picometres", 1e-12, " pm picometer picometers picometre picometres " },
  Unit{ "angstroms", 1e-10, " \u00C5 \u212B A angstrom angstroms " },
  Unit{ "nanometres", 1e-9, " nm nanometer nanometers nanometre nanometres " },
  // ImageJ escapes the micro sign, and older programs have it in Latin-1.
  Unit{ "micrometres", 1e-6,
    " um \u00B5m \u03BCm \\u00B5m \\u00b5m \xB5m micron microns micrometer micrometers micrometre "
    "micrometres " },
  Unit{ "millimetres", 1e-3, " mm millimeter millimeters millimetre millimetres " },
  Unit{ "centimetres", 1e-2, " cm centimeter centimeters centimetre centimetres " },
  Unit{ "decimetres", 1e-1, " dm decimeter decimeters decimetre decimetres " },
  Unit{ "metres", 1.0, " m meter meters metre metres " },
  Unit{ "thousandths of an inch", 0.0000254, " thou mil mils " },
  Unit{ "inches", 0.0254, " in inch inches " },
};

bool IsAmong(const std::string& word, std::string_view all)
{
  const std::vector<std::string_view> words = Words(all);
  return std::find(words.begin(), words.end(), word) != words.end();
}

/** Null if it is no unit that is known here. */
const Unit* FindUnit(const std::string& text)
{
  const auto unit = std::find_if(Lengths.begin(), Lengths.end(),
    [&text](const Unit& each) { return IsAmong(text, each.Spellings); });
  return unit == Lengths.end() ? nullptr : &*unit;
}

} // namespace

bool IsUnitOfLength(const std::string& unit)
{
  return !unit.empty() && !IsAmong(unit, "pixel pixels voxel voxels null none ???");
}

Vector3 ToUnitOfFirst(const std::array<std::string, 3>& units, Reading& reading)
{
  Vector3 factors{ 1.0, 1.0, 1.0 };
  const Unit* const first = FindUnit(units[0]);
  for (std::size_t axis = 1; axis < 3; ++axis)
  {
    const Unit* const own = FindUnit(units[axis]);
    if (first && own)
    {
      factors[axis] = first == own ? 1.0 : own->Metres / first->Metres;
    }
    else if (units[axis] != units[0])
    {
      reading.SpacingGuesses.push_back("its axes have the units '" + Excerpt(units[0]) + "' and '" +
        Excerpt(units[axis]) +
        "', and how one is converted is not known: give the size of voxels with SetSpacing()");
    }
  }
  return factors;
}

void WarnOfLengths(const std::string& unit, Reading& reading)
{
  const Unit* const known = FindUnit(unit);
  if (!unit.empty() && (!known || known->Name != "millimetres"))
  {
    reading.Unit = known ? std::string(known->Name) : "'" + Excerpt(unit) + "'";
    reading.Warnings.push_back("its lengths are in " + reading.Unit + ", and so is the mesh");
  }
}

void WarnOfTimes(const std::string& unit, Reading& reading)
{
  if (!unit.empty() && !IsAmong(unit, "s sec secs second seconds null none ???"))
  {
    reading.Warnings.push_back(
      "its times are in '" + Excerpt(unit) + "', and so are those of the mesh");
  }
}

} // namespace voxplex::io
