// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "HDF5File.h"

#include "FileError.h"
#include "TextFile.h"

#include <vtk_hdf5.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace voxplex::io
{
namespace
{

/** HDF5 prints its errors unless told not to; what the rest of the process wants is put back. */
class Quiet
{
public:
  Quiet()
  {
    H5Eget_auto2(H5E_DEFAULT, &this->Function, &this->Data);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  ~Quiet() { H5Eset_auto2(H5E_DEFAULT, this->Function, this->Data); }
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;

private:
  H5E_auto2_t Function = nullptr;
  void* Data = nullptr;
};

/** Closes an identifier. */
class Handle
{
public:
  Handle(hid_t id, herr_t (*close)(hid_t))
    : Id(id)
    , CloseFunction(close)
  {
  }
  ~Handle() { this->Close(); }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;

  operator hid_t() const { return this->Id; }
  bool Close()
  {
    const bool done = this->Id >= 0 && this->CloseFunction(this->Id) >= 0;
    this->Id = -1;
    return done;
  }

private:
  hid_t Id;
  herr_t (*CloseFunction)(hid_t);
};

std::mutex& LibraryMutex()
{
  static std::mutex mutex;
  return mutex;
}

[[noreturn]] void Fail()
{
  Refuse("the HDF5 library reports an error");
}

/** As they are stored, and in memory. */
std::array<hid_t, 2> TypesOf(double)
{
  return { H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE };
}

std::array<hid_t, 2> TypesOf(std::int64_t)
{
  return { H5T_STD_I64LE, H5T_NATIVE_INT64 };
}

std::array<hid_t, 2> TypesOf(std::int32_t)
{
  return { H5T_STD_I32LE, H5T_NATIVE_INT32 };
}

} // namespace

HDF5File::HDF5File()
  : Lock(LibraryMutex())
{
  constexpr std::size_t growth = 1 << 20;
  constexpr hbool_t isKeptInMemory = 0; // no file behind it
  const Quiet quiet;
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_fapl_core(access, growth, isKeptInMemory);
  H5Pset_libver_bounds(access, H5F_LIBVER_EARLIEST, H5F_LIBVER_LATEST); // later groups have times: bytes of their own
  this->File = H5Fcreate("voxplex", H5F_ACC_TRUNC, H5P_DEFAULT, access);
  if (this->File < 0)
  {
    Fail();
  }
}

HDF5File::~HDF5File()
{
  if (this->File >= 0)
  {
    const Quiet quiet;
    H5Fclose(this->File);
  }
}

template <typename T>
void HDF5File::Write(const std::string& name, const std::vector<T>& values, std::size_t columns)
{
  const Quiet quiet;
  const auto [stored, type] = TypesOf(T());
  const std::array<hsize_t, 2> dimensions{ values.size() / columns, columns };
  const Handle space(H5Screate_simple(columns == 1 ? 1 : 2, dimensions.data(), nullptr), H5Sclose);
  const Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  H5Pset_create_intermediate_group(links, true);
  // Without the time, so that the same mesh gives the same file.
  const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(creation, false);
  Handle dataset(
    H5Dcreate2(this->File, name.c_str(), stored, space, links, creation, H5P_DEFAULT), H5Dclose);
  const bool done = dataset >= 0 &&
    (values.empty() || H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0);
  if (!done || !dataset.Close())
  {
    Fail();
  }
}

template void HDF5File::Write(const std::string&, const std::vector<double>&, std::size_t);
template void HDF5File::Write(const std::string&, const std::vector<std::int64_t>&, std::size_t);
template void HDF5File::Write(const std::string&, const std::vector<std::int32_t>&, std::size_t);

void HDF5File::Close(const std::string& path)
{
  std::vector<char> image;
  {
    const Quiet quiet;
    const bool isFlushed = H5Fflush(this->File, H5F_SCOPE_LOCAL) >= 0;
    const ssize_t size = isFlushed ? H5Fget_file_image(this->File, nullptr, 0) : -1;
    image.resize(static_cast<std::size_t>(std::max<ssize_t>(size, 0)));
    if (size < 0 || H5Fget_file_image(this->File, image.data(), image.size()) != size)
    {
      Fail();
    }
  }
  constexpr std::size_t blockSize = 1 << 16;
  TextFile file(path);
  for (std::size_t at = 0; at < image.size(); at += blockSize)
  {
    file << std::string_view(image.data() + at, std::min(blockSize, image.size() - at));
  }
  file.Close();
}

} // namespace voxplex::io
