#include "core/base/io_reason.h"

#include <cerrno>
#include <system_error>

namespace hyades::core {

std::string io_reason(int error) {
  switch (error) {
    case ENOSPC:
      return "the disk is full";
    case EDQUOT:
      return "the disk quota is used up";
    case EFBIG:
      return "the file would be larger than is allowed (ulimit -f)";
    case EROFS:
      return "the file system is read-only";
    case EACCES:
    case EPERM:
      return "permission denied";
    case ENOENT:
      return "the folder does not exist";
    case ENOTDIR:
      return "a part of the path is not a folder";
    case ENAMETOOLONG:
      return "the name is too long";
    default:
      return std::generic_category().message(error);
  }
}

std::string lock_reason(int error) {
  return error == EWOULDBLOCK ? "another process has it and does not let go" : io_reason(error);
}

}  // namespace hyades::core
