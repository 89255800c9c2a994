// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// What a confined process can still do: read the image, and nothing else.

#include "ReaderProcess/Confinement.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

namespace fs = std::filesystem;

namespace
{

bool CanOpen(const fs::path& path, int flags)
{
  const int descriptor = open(path.c_str(), flags, 0600);
  if (descriptor >= 0)
  {
    close(descriptor);
  }
  return descriptor >= 0;
}

/** 0 without it. */
long LandlockVersion()
{
#if defined(SYS_landlock_create_ruleset)
  return std::max(0L, syscall(SYS_landlock_create_ruleset, nullptr, 0, 1));
#else
  return 0;
#endif
}

bool HasLandlock()
{
  return LandlockVersion() > 0;
}

/** In a process of its own, since there is no way back. Returns what is wrong, as an exit status. */
template <typename TFunction>
int InAnotherProcess(const TFunction& function)
{
  const pid_t child = fork();
  if (child == 0)
  {
    _exit(function());
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 100;
}

} // namespace

int TestConfinement(int, char*[])
{
  std::string pattern = (fs::temp_directory_path() / "voxplex-confined-XXXXXX").string();
  const fs::path root = mkdtemp(pattern.data());
  const fs::path folder = root / "images";
  fs::create_directories(folder / "slices");
  for (const fs::path& path :
    { folder / "i.tif", folder / "slices" / "1.dcm", root / "secret", root / "real.tif" })
  {
    std::ofstream(path) << "content";
  }
  fs::create_symlink(root / "real.tif", folder / "link.tif");
  fs::create_symlink(root / "real.tif", folder / "slices" / "2.dcm");

  // What is beside the image does not raise its limits.
  fs::resize_file(root / "secret", std::uintmax_t{ 50 } << 30);
  std::ofstream(folder / "large") << "content";
  fs::resize_file(folder / "large", std::uintmax_t{ 50 } << 30);

  const auto confined = [&](const char* image)
  {
    return InAnotherProcess(
      [&]
      {
        voxplex::io::Confine(folder / image);
        rlimit memory{};
        rlimit time{};
        getrlimit(RLIMIT_DATA, &memory);
        getrlimit(RLIMIT_CPU, &time);
        const bool isLimited = time.rlim_cur == 60 &&
          (voxplex::io::HasSanitizer ||
            (memory.rlim_cur < (600UL << 20) && memory.rlim_max == memory.rlim_cur));
        voxplex::io::AllowTimeFor(200'000'000);
        rlimit later{};
        getrlimit(RLIMIT_CPU, &later);
        return !CanOpen(folder / image, O_RDONLY)                                 ? 1
          : HasLandlock() && CanOpen(folder / "large", O_RDONLY)                  ? 2
          : HasLandlock() && CanOpen(root / "secret", O_RDONLY)                   ? 3
          : HasLandlock() && CanOpen(folder / "new", O_WRONLY | O_CREAT)          ? 4
          : HasLandlock() && CanOpen(folder / "i.tif", O_WRONLY)                  ? 5
          : LandlockVersion() >= 3 && truncate((root / "secret").c_str(), 0) == 0 ? 7
          : !isLimited                                                            ? 6
          : later.rlim_cur != 80 || later.rlim_max > 3600                         ? 8
                                                                                  : 0;
      });
  };
  const int own = confined("i.tif");
  const int link = confined("link.tif");
  const int ofFolder = InAnotherProcess(
    [&]
    {
      voxplex::io::Confine(folder / "slices");
      return CanOpen(folder / "slices" / "1.dcm", O_RDONLY) &&
          CanOpen(folder / "slices" / "2.dcm", O_RDONLY) &&
          (!HasLandlock() || !CanOpen(root / "secret", O_RDONLY))
        ? 0
        : 1;
    });
  fs::remove_all(root);
  if (own != 0 || link != 0 || ofFolder != 0)
  {
    std::cerr << "wrong: " << own << " with a file, " << link << " with a link, " << ofFolder
              << " with a folder, of a file and a link\n";
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
