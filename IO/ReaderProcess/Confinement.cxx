// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Confinement.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#if defined(__linux__)
#include <sched.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#endif
#if defined(__linux__) && __has_include(<linux/landlock.h>)
#include <linux/landlock.h>
#endif
#if defined(__linux__) && (defined(__x86_64__) || defined(__aarch64__))
#define VOXPLEX_FILTERS_CALLS
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
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

#if defined(VOXPLEX_FILTERS_CALLS)

#if defined(__x86_64__)
constexpr std::uint32_t Architecture = AUDIT_ARCH_X86_64;
#else
constexpr std::uint32_t Architecture = AUDIT_ARCH_AARCH64;
#endif

constexpr std::uint32_t Denied = SECCOMP_RET_ERRNO | EPERM;
constexpr std::uint32_t Unknown = SECCOMP_RET_ERRNO | ENOSYS;

/** What no reader calls. */
constexpr auto Forbidden = std::to_array<std::uint32_t>({
#if defined(__x86_64__) // where others have fewer calls
  SYS_fork, SYS_vfork, SYS_chmod, SYS_chown, SYS_lchown, SYS_utime, SYS_utimes, SYS_futimesat,
#endif
    // other programs and processes
    SYS_execve, SYS_execveat, SYS_tkill, SYS_rt_sigqueueinfo, SYS_rt_tgsigqueueinfo, SYS_ptrace,
    SYS_process_vm_readv, SYS_process_vm_writev, SYS_kcmp, SYS_shmget, SYS_shmat, SYS_semget,
    SYS_msgget, SYS_mq_open,
    // the network
    SYS_socket, SYS_socketpair, SYS_connect, SYS_bind, SYS_listen, SYS_accept, SYS_accept4,
    SYS_sendto, SYS_sendmsg, SYS_sendmmsg,
    // files, as far as Landlock does not keep from them
    SYS_truncate, SYS_fchmod, SYS_fchmodat, SYS_fchown, SYS_fchownat, SYS_utimensat, SYS_setxattr,
    SYS_lsetxattr, SYS_fsetxattr, SYS_removexattr, SYS_lremovexattr, SYS_fremovexattr,
    SYS_open_by_handle_at,
    // the system
    SYS_mount, SYS_umount2, SYS_pivot_root, SYS_chroot, SYS_setns, SYS_unshare, SYS_keyctl,
    SYS_add_key, SYS_request_key, SYS_bpf, SYS_perf_event_open, SYS_userfaultfd, SYS_init_module,
    SYS_finit_module, SYS_delete_module, SYS_kexec_load
});

/** A thread may be started, by clone(): of clone3(), whose flags a filter cannot see, libraries learn that it is not there. */
void ForbidSystemCalls()
{
  constexpr std::uint32_t firstNew = 424; // of Linux 5.1, as on all architectures
  const auto self = static_cast<std::uint32_t>(getpid());
  std::vector<sock_filter> filter;
  const auto add = [&filter](unsigned code, std::uint32_t value, unsigned char ifTrue = 0,
                     unsigned char ifFalse = 0) {
    filter.push_back({ static_cast<std::uint16_t>(code), ifTrue, ifFalse, value });
  };
  const auto answer = [&add](std::uint32_t action) { add(BPF_RET | BPF_K, action); };
  const auto load = [&add](std::size_t offset)
  { add(BPF_LD | BPF_W | BPF_ABS, static_cast<std::uint32_t>(offset)); };
  // The call is allowed if the test of its first argument holds. The lower half comes first on both architectures.
  const auto allowOnly = [&](std::uint32_t call, unsigned test, std::uint32_t value)
  {
    add(BPF_JMP | BPF_JEQ | BPF_K, call, 0, 4);
    load(offsetof(seccomp_data, args));
    add(BPF_JMP | test | BPF_K, value, 0, 1);
    answer(SECCOMP_RET_ALLOW);
    answer(Denied);
  };

  load(offsetof(seccomp_data, arch));
  add(BPF_JMP | BPF_JEQ | BPF_K, Architecture, 1, 0);
  answer(Denied);
  load(offsetof(seccomp_data, nr));
  add(BPF_JMP | BPF_JGE | BPF_K, firstNew, 0, 1); // as on older systems; on x86, those of x32, too
  answer(Unknown);
  allowOnly(SYS_clone, BPF_JSET, CLONE_THREAD);
  allowOnly(SYS_kill, BPF_JEQ, self);
  allowOnly(SYS_tgkill, BPF_JEQ, self); // abort()
  allowOnly(SYS_prlimit64, BPF_JEQ, 0);
  for (const std::uint32_t call : Forbidden)
  {
    add(BPF_JMP | BPF_JEQ | BPF_K, call, 0, 1);
    answer(Denied);
  }
  answer(SECCOMP_RET_ALLOW);

  const sock_fprog program{ static_cast<unsigned short>(filter.size()), filter.data() };
  prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
  prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program);
}

#else

void ForbidSystemCalls() {}

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
  ForbidSystemCalls();
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
