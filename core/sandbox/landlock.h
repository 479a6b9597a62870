#pragma once

#include <string>
#include <vector>

#include "core/base/result.h"

namespace hyades::core {

/// What a process may do with a file, or with all that is below a folder.
enum class FileAccess {
  read,   ///< files and lists of folders
  run,    ///< read, and start as programs
  write,  ///< read, make, write, rename and remove files and folders
};

struct FileRule {
  std::string path;
  FileAccess access = FileAccess::read;
  bool must_exist = false;  ///< otherwise a path that is not there is passed over
};

/// What any program needs to read: programs, libraries, and what the kernel tells of this process
/// and of the machine. Not /etc, not /home and not what /proc tells of others: there are keys and
/// tokens.
std::vector<FileRule> system_files();

/// From now on the calling thread, and those that it starts, reach no file but those of `rules`,
/// signal no other process (where the kernel has Landlock's ABI 6, since Linux 6.12), and can gain
/// no privileges (no_new_privs). There is no way back. Landlock, since Linux 5.13; its ABI 1 is
/// enough (https://docs.kernel.org/userspace-api/landlock.html). What is open stays open. Errors:
/// why the kernel does not.
Status restrict_files(const std::vector<FileRule>& rules);

/// Empty where this machine can restrict_files(), else why not.
std::string landlock_lacks();

}  // namespace hyades::core
