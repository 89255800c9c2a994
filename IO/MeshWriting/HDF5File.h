// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file HDF5File.h
 * @brief Writes arrays of numbers to an HDF5 file.
 */
#ifndef voxplex_io_HDF5File_h
#define voxplex_io_HDF5File_h

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

namespace voxplex::io
{

/**
 * Datasets are contiguous and little-endian. Call Close() at the end, or there is no file.
 *
 * The file is put together in memory, which takes twice its size: HDF5 does not survive a full disk (it
 * keeps what it could not write, and crashes when the process ends).
 *
 * The HDF5 library is not thread-safe unless built so: a second object waits until the first one is
 * destroyed. It cannot wait for users of the library elsewhere in the process.
 */
class HDF5File
{
public:
  /** Begins an empty file. @throws FileError */
  HDF5File();
  ~HDF5File();
  HDF5File(const HDF5File&) = delete;
  HDF5File& operator=(const HDF5File&) = delete;

  /**
   * Writes a dataset of two dimensions, or of one if there is one column. Groups are made where there are none.
   *
   * @tparam T double, std::int64_t or std::int32_t
   * @param name with its group: "mesh/topology"
   * @throws FileError
   */
  template <typename T>
  void Write(const std::string& name, const std::vector<T>& values, std::size_t columns);

  /** Writes the file, in place of an existing one. @throws FileError */
  void Close(const std::string& path);

private:
  std::unique_lock<std::mutex> Lock; ///< of all objects of this class
  std::int64_t File;                 ///< HDF5's identifier; negative if closed
};

} // namespace voxplex::io

#endif
