// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "NrrdFile.h"

#include <bit>
#include <fstream>
#include <ostream>
#include <stdexcept>

namespace voxplex::stress
{

namespace
{

/** One vector for each axis. */
template <int D>
void WriteAxes(const Volume<D>& image, std::ostream& to)
{
  to.precision(17);
  to << "space: left-posterior-superior" << (D == 4 ? "-time" : "") << "\nspace directions:";
  for (std::size_t c = 0; c < static_cast<std::size_t>(D); ++c)
  {
    for (std::size_t r = 0; r < static_cast<std::size_t>(D); ++r)
    {
      const bool isStep = r == 3 && c == 3;
      to << (r == 0 ? " (" : ",") << (isStep ? 1.0 : image.Axes[r][c]);
    }
    to << ')';
  }
  to << "\nspace origin: (0,0,0" << (D == 4 ? ",0" : "") << ")\n";
}

template <typename T>
void WriteBytes(const std::vector<T>& values, std::ostream& to)
{
  to.write(reinterpret_cast<const char*>(values.data()),
    static_cast<std::streamsize>(values.size() * sizeof(T)));
}

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
void WriteNrrd(const Volume<D>& image, const std::string& path)
{
  std::ofstream to(path, std::ios::binary);
  to << "NRRD0004\ntype: " << (image.Surface ? "float" : "int32") << "\ndimension: " << D << '\n';
  to << "kinds: domain domain domain" << (D == 4 ? " domain" : "") << '\n';
  to << "sizes:";
  for (const std::int64_t n : image.Dimensions)
  {
    to << ' ' << n;
  }
  to << '\n';
  WriteAxes(image, to);
  to << "endian: " << (std::endian::native == std::endian::little ? "little" : "big")
     << "\nencoding: raw\n\n";
  if (image.Surface)
  {
    WriteBytes(image.Grey, to);
  }
  else
  {
    WriteBytes(image.Labels, to);
  }
  to.close();
  if (!to)
  {
    throw std::runtime_error("cannot write " + path);
  }
}

template void WriteNrrd<3>(const Volume<3>&, const std::string&);
template void WriteNrrd<4>(const Volume<4>&, const std::string&);

} // namespace voxplex::stress
