#include "core/sandbox/private_root.h"

#include <fcntl.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <span>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/base/descriptor.h"
#include "core/base/posix_file.h"

namespace hyades::core {
namespace {

namespace fs = std::filesystem;

/// Where the new root is put together: a folder that every system has. What stood there is hidden
/// only within the namespace.
constexpr const char* kRoot = "/tmp";

Error no_namespace(const std::string& what) {
  return Error{"namespaces: " + what + ": " + std::strerror(errno)};
}

bool write_text(const char* path, const std::string& text) {
  const Descriptor file = open_file(path, O_WRONLY);
  return file.valid() && write_all(file.get(), std::as_bytes(std::span(text)));
}

/// Namespaces of this process' own, in which it is who it was.
Status enter_namespaces() {
  const uid_t user = ::geteuid();
  const gid_t group = ::getegid();
  if (::unshare(CLONE_NEWUSER | CLONE_NEWNS) != 0) {
    return no_namespace("not allowed here");
  }
  if (!write_text("/proc/self/setgroups", "deny") ||
      !write_text("/proc/self/uid_map", fmt::format("{} {} 1", user, user)) ||
      !write_text("/proc/self/gid_map", fmt::format("{} {} 1", group, group))) {
    return no_namespace("users cannot be mapped");
  }
  return {};
}

/// A place that will stand in the new root, opened while the old one is there.
struct Shown {
  fs::path path;  ///< absolute, without links' detours
  FileAccess access = FileAccess::read;
  Descriptor place;
};

Result<std::vector<Shown>> open_places(const std::vector<FileRule>& rules) {
  std::vector<Shown> places;
  for (const FileRule& rule : rules) {
    // What lies below another place is there with it.
    const bool there = std::ranges::any_of(rules, [&](const FileRule& other) {
      return rule.access != FileAccess::write && rule.path.starts_with(other.path + "/");
    });
    if (there) continue;
    Descriptor place = open_file(rule.path, O_PATH);
    if (place.valid()) {
      std::error_code none;
      places.push_back(
          {fs::absolute(rule.path, none).lexically_normal(), rule.access, std::move(place)});
    } else if (rule.must_exist) {
      return no_namespace(rule.path);
    }
  }
  return places;
}

/// Flags of a mount that a namespace must keep when it changes others.
unsigned long kept_flags(const fs::path& path) {
  struct statvfs info {};
  if (::statvfs(path.c_str(), &info) != 0) return 0;
  unsigned long flags = 0;
  for (const auto& [has, flag] : {std::pair<unsigned long, unsigned long>{ST_NOSUID, MS_NOSUID},
                                  {ST_NODEV, MS_NODEV},
                                  {ST_NOEXEC, MS_NOEXEC},
                                  {ST_NOATIME, MS_NOATIME},
                                  {ST_NODIRATIME, MS_NODIRATIME},
                                  {ST_RELATIME, MS_RELATIME}}) {
    if ((info.f_flag & has) != 0) flags |= flag;
  }
  return flags;
}

Status show(const Shown& shown) {
  struct stat info {};
  std::error_code error;
  const fs::path target = kRoot + shown.path.string();
  fs::create_directories(target.parent_path(), error);
  if (::fstat(shown.place.get(), &info) != 0) return no_namespace(shown.path);
  if (S_ISDIR(info.st_mode)) {
    fs::create_directories(target, error);
  } else {
    (void)open_file(target, O_CREAT | O_WRONLY, 0600);
  }
  const std::string source = fmt::format("/proc/self/fd/{}", shown.place.get());
  if (::mount(source.c_str(), target.c_str(), nullptr, MS_BIND | MS_REC, nullptr) != 0) {
    return no_namespace(shown.path);
  }
  if (shown.access != FileAccess::write) {
    // What is mounted further below stays as it was; Landlock lets nobody write there either.
    (void)::mount(nullptr, target.c_str(), nullptr,
                  MS_BIND | MS_REMOUNT | MS_RDONLY | kept_flags(target), nullptr);
  }
  return {};
}

}  // namespace

Status hide_other_files(const std::vector<FileRule>& rules) {
  std::error_code none;
  const fs::path here = fs::current_path(none);
  if (Status entered = enter_namespaces(); !entered) return entered;
  if (::mount(nullptr, "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0) return no_namespace("/");
  // Of the mounts of this namespace, as only they can be bound.
  auto places = open_places(rules);
  if (!places) return places.error();
  if (::mount("tmpfs", kRoot, "tmpfs", MS_NOSUID | MS_NODEV, "size=1m,mode=755") != 0) {
    return no_namespace(kRoot);
  }
  for (const Shown& shown : *places) {
    if (Status done = show(shown); !done) {
      ::umount2(kRoot, MNT_DETACH);
      return done;
    }
  }
  // Relative paths go on meaning what they meant.
  fs::create_directories(kRoot + here.string(), none);
  // The old root comes to lie on the new one, and goes.
  if (::chdir(kRoot) != 0 || ::syscall(SYS_pivot_root, ".", ".") != 0) {
    const Error error = no_namespace("the root cannot be changed");
    ::umount2(kRoot, MNT_DETACH);
    return error;
  }
  if (::umount2(".", MNT_DETACH) != 0) return no_namespace("the old root stays");
  (void)::mount(nullptr, "/", nullptr, MS_REMOUNT | MS_BIND | MS_RDONLY | MS_NOSUID | MS_NODEV,
                nullptr);
  if (::chdir(here.c_str()) != 0) return no_namespace(here);
  return {};
}

}  // namespace hyades::core
