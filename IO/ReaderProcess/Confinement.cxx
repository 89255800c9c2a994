// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Confinement.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#if defined(__linux__)
#include <sys/prctl.h>
#include <sys/syscall.h>
#endif
#if defined(__linux__) && __has_include(<linux/landlock.h>)
#include <linux/landlock.h>
#endif

namespace fs = std::filesystem;

namespace voxplex::io
{
namespace
{

/** In bytes: that of the image, or of all in it if it is a folder. */
std::uint64_t BytesOf(const fs::path& image)
{
  std::error_code ignored;
  std::uint64_t sum = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(image, ignored))
  {
    std::error_code failed;
    const std::uintmax_t size = entry.is_regular_file(failed) ? entry.file_size(failed) : 0;
    sum += failed ? 0 : size;
  }
  const std::uintmax_t own = fs::file_size(image, ignored);
  return ignored ? sum : own;
}

/** The process may raise the limit up to `mostEver`. */
void Limit(int resource, std::uint64_t most, std::uint64_t mostEver)
{
  rlimit limit{};
  if (getrlimit(resource, &limit) == 0)
  {
    limit.rlim_max = std::min<rlim_t>(limit.rlim_max, mostEver);
    limit.rlim_cur = std::min<rlim_t>(limit.rlim_max, most);
    setrlimit(resource, &limit);
  }
}

#if defined(LANDLOCK_ACCESS_FS_EXECUTE) && defined(SYS_landlock_create_ruleset)

void Allow(int ruleset, const fs::path& path, std::uint64_t access)
{
  const int descriptor = open(path.c_str(), O_PATH | O_CLOEXEC);
  if (descriptor >= 0)
  {
    landlock_path_beneath_attr rule{};
    rule.allowed_access = access;
    rule.parent_fd = descriptor;
    syscall(SYS_landlock_add_rule, ruleset, LANDLOCK_RULE_PATH_BENEATH, &rule, 0);
    close(descriptor);
  }
}

void ForbidOtherFiles(const fs::path& image)
{
  const auto version = static_cast<int>(
    syscall(SYS_landlock_create_ruleset, nullptr, 0, LANDLOCK_CREATE_RULESET_VERSION));
  // The first version has 13 rights, the second one more, and the third one more: to cut files.
  const int rights = 12 + std::clamp(version, 1, 3);
  landlock_ruleset_attr attributes{};
  attributes.handled_access_fs = (1ULL << rights) - 1;
  const auto ruleset = static_cast<int>(
    syscall(SYS_landlock_create_ruleset, &attributes, sizeof attributes.handled_access_fs, 0));
  if (ruleset < 0)
  {
    return;
  }
  std::error_code ignored;
  Allow(ruleset, image,
    LANDLOCK_ACCESS_FS_READ_FILE |
      (fs::is_directory(image, ignored) ? LANDLOCK_ACCESS_FS_READ_DIR : 0));
  // A folder of slices may be one of links. They are read if they are DICOM, and by no name in another file.
  for (const fs::directory_entry& entry : fs::directory_iterator(image, ignored))
  {
    std::error_code failed;
    if (entry.is_symlink(failed) && entry.is_regular_file(failed))
    {
      Allow(ruleset, entry.path(), LANDLOCK_ACCESS_FS_READ_FILE);
    }
  }
  prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
  syscall(SYS_landlock_restrict_self, ruleset, 0);
  close(ruleset);
}

#else

void ForbidOtherFiles(const fs::path&) {}

#endif

} // namespace

void Confine(const fs::path& image)
{
  const std::uint64_t size = BytesOf(image);
  if (!HasSanitizer)
  {
    const std::uint64_t memory = (512ULL << 20) + 16 * size;
    Limit(RLIMIT_DATA, memory, memory);
  }
  constexpr std::uint64_t bytesInASecond = 2'000'000;
  constexpr std::uint64_t anHour = 3600;
  Limit(RLIMIT_CPU, 60 + size / bytesInASecond, anHour);
  Limit(RLIMIT_CORE, 0, 0);
  Limit(RLIMIT_FSIZE, RLIM_INFINITY, RLIM_INFINITY); // shared memory counts as a file, and is none
  ForbidOtherFiles(image);
}

void AllowTimeFor(std::uint64_t bytesOfVoxels)
{
  constexpr std::uint64_t bytesInASecond = 10'000'000;
  rlimit limit{};
  if (getrlimit(RLIMIT_CPU, &limit) == 0)
  {
    limit.rlim_cur =
      std::min<rlim_t>(limit.rlim_max, limit.rlim_cur + bytesOfVoxels / bytesInASecond);
    setrlimit(RLIMIT_CPU, &limit);
  }
}

} // namespace voxplex::io
