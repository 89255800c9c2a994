// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Confinement.h
 * @brief Takes from a process what it does not need to read an image.
 */
#ifndef voxplex_io_Confinement_h
#define voxplex_io_Confinement_h

#include <cstdint>
#include <filesystem>

namespace voxplex::io
{

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool HasSanitizer = true;
#elif defined(__has_feature)
inline constexpr bool HasSanitizer =
  __has_feature(address_sanitizer) || __has_feature(thread_sanitizer);
#else
inline constexpr bool HasSanitizer = false;
#endif

/**
 * For the rest of its life this process
 * - may read the image, and no other file, and write none (Linux 5.13 and newer with Landlock; elsewhere it may do what
 *   its user may);
 * - starts no other process and none of its calls reaches one, nor the network, keys, mounts and what else of the system
 *   no reader needs: they fail with EPERM, and those that Linux has got since 5.1 with ENOSYS (seccomp on x86-64 and
 *   aarch64). Threads may be started;
 * - may take 512 MiB of memory and 16 times the size of the image, beside that of the voxels that it gives away;
 * - may compute for a minute and a second for each two megabytes of the image, or as long as AllowTimeFor() says, at
 *   most an hour.
 *
 * If the image is a folder, that is all in it and below, and what links in it lead to; its size is that of the files in
 * it. Builds with sanitizers have no limit of memory.
 */
void Confine(const std::filesystem::path& image);

/** Before voxels are read: a second more for each ten megabytes of them. A claim of them has been compared with the files. */
void AllowTimeFor(std::uint64_t bytesOfVoxels);

} // namespace voxplex::io

#endif
