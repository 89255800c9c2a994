// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// What a confined process can still do: read the image, and nothing else.

#include "ReaderProcess/Confinement.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>
#include <thread>

#include <fcntl.h>
#include <sched.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
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

#if defined(__x86_64__) || defined(__aarch64__)

struct Attempt
{
  const char* Name;
  long Call;
  long First = 0;
  long Second = 0;
  int Error = EPERM;
};

/** Each fails as it is forbidden, and not for its arguments. Returns how many do not. */
int CountWhatIsNotForbidden(const char* file)
{
  constexpr long ioUringSetup = 425;
  constexpr long pidfdOpen = 434;
  constexpr long clone3 = 435;
  const auto path = reinterpret_cast<long>(file);
  const long parent = getppid();
  int wrong = 0;
  for (const Attempt& one : {
#if defined(__x86_64__)
         Attempt{ "fork", SYS_fork }, { "vfork", SYS_vfork }, { "chmod", SYS_chmod, path, 0600 },
           { "call of x32", 0x40000000L + SYS_getppid, 0, 0, ENOSYS },
#endif
           Attempt{ "clone", SYS_clone, SIGCHLD }, { "clone3", clone3, 0, 0, ENOSYS },
           { "execve", SYS_execve, path }, { "kill", SYS_kill, parent },
           { "kill of all", SYS_kill, -1 }, { "tkill", SYS_tkill, parent },
           { "tgkill", SYS_tgkill, parent, parent },
           { "rt_sigqueueinfo", SYS_rt_sigqueueinfo, parent },
           { "pidfd_open", pidfdOpen, parent, 0, ENOSYS }, { "prlimit64", SYS_prlimit64, parent },
           { "ptrace", SYS_ptrace, 0 }, { "process_vm_readv", SYS_process_vm_readv, getpid() },
           { "shmget", SYS_shmget, 0, 4096 }, { "socket", SYS_socket, AF_INET, SOCK_STREAM },
           { "socketpair", SYS_socketpair, AF_UNIX, SOCK_STREAM }, { "connect", SYS_connect, 0 },
           { "sendto", SYS_sendto, 0 }, { "truncate", SYS_truncate, path },
           { "fchmodat", SYS_fchmodat, AT_FDCWD, path }, { "setxattr", SYS_setxattr, path },
           { "mount", SYS_mount }, { "unshare", SYS_unshare }, { "keyctl", SYS_keyctl },
           { "bpf", SYS_bpf }, { "perf_event_open", SYS_perf_event_open },
           { "userfaultfd", SYS_userfaultfd }, { "io_uring_setup", ioUringSetup, 1, 0, ENOSYS },
       })
  {
    errno = 0;
    const long result = syscall(one.Call, one.First, one.Second, 0, 0, 0, 0);
    if (result == 0 && (one.Call == SYS_clone || std::string(one.Name).ends_with("fork")))
    {
      _exit(0); // the process that should not be
    }
    if (result != -1 || errno != one.Error)
    {
      std::cerr << one.Name << " is not forbidden: " << result << ", errno " << errno << "\n";
      ++wrong;
    }
  }
  int started = 0;
  std::thread([&started] { started = 1; }).join();
  return wrong + (started == 1 ? 0 : 1) + (kill(getpid(), 0) == 0 ? 0 : 1);
}

#else

int CountWhatIsNotForbidden(const char*)
{
  return 0;
}

#endif

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
  const int notForbidden = InAnotherProcess(
    [&]
    {
      voxplex::io::Confine(folder / "i.tif");
      return CountWhatIsNotForbidden((folder / "i.tif").c_str());
    });
  fs::remove_all(root);
  if (own != 0 || link != 0 || ofFolder != 0 || notForbidden != 0)
  {
    std::cerr << "wrong: " << own << " with a file, " << link << " with a link, " << ofFolder
              << " with a folder, of a file and a link, " << notForbidden << " calls\n";
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
