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

template <int D>
void WriteAxes(const Volume<D>& image, std::ostream& to)
{
  to.precision(17);
  if constexpr (D == 3)
  {
    to << "space: left-posterior-superior\nspace directions:";
    for (std::size_t c = 0; c < 3; ++c)
    {
      to << " (" << image.Axes[0][c] << ',' << image.Axes[1][c] << ',' << image.Axes[2][c] << ')';
    }
    to << "\nspace origin: (0,0,0)\n";
  }
  else
  {
    to << "spacings:";
    for (std::size_t a = 0; a < 3; ++a)
    {
      to << ' ' << image.Spacing(a);
    }
    to << " 1\n";
  }
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
  to << (D == 3 ? "" : "kinds: domain domain domain time\n");
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
