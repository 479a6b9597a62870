#pragma once

#include <string>
#include <utility>

#include "core/base/result.h"

namespace hyades::worker {

/// What a worker shows the coordinator: the token of a machine of its own, which it was given when
/// it joined, or else the one that it joins with. Its own is kept in a file (0600) out of reach of
/// the rendering child; the other one's file may go once the worker has joined.
class WorkerToken {
 public:
  /// `join_file`: as farm::read_token() has it. `own_file`: where the own token is kept.
  WorkerToken(std::string join_file, std::string own_file)
      : join_file_(std::move(join_file)), own_file_(std::move(own_file)) {}

  /// Reads what there is; an error where neither token can be read. An own one counts if it is of
  /// this worker and made from the join token that there is now.
  core::Status read(const std::string& worker_id);

  /// To be shown; empty: no token file is given.
  const std::string& text() const { return own_.empty() || joins_ ? join_ : own_; }

  /// Keeps the own token of the worker of this id from now on. An error where it is no such token,
  /// which a coordinator may say all the same, or cannot be written.
  core::Status keep(const std::string& own, const std::string& worker_id);

  /// The coordinator does not know what was shown: whether there is another one to show at once,
  /// which is text() from now on. Nothing is lost: the own token is the next to be tried again, as
  /// a coordinator may have another folder, or clock, for a while.
  bool replace(const std::string& worker_id);

 private:
  std::string join_file_;
  std::string own_file_;
  std::string join_;
  std::string own_;
  bool joins_ = false;  ///< the own token is not shown, as it is not known
};

}  // namespace hyades::worker
