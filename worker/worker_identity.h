#pragma once

#include <string>
#include <utility>

#include "core/base/descriptor.h"
#include "core/base/result.h"

namespace hyades::worker {

/// What a worker is called by the coordinator: 32 random hexadecimal digits that stay the same when
/// it is started again, so that a quarantine holds. Kept in the cache folder, one file for each of
/// the workers that share it; a worker takes the first that no running one has. Where the folder
/// has come from another machine (an image with a filled cache) the name is made anew.
class WorkerIdentity {
 public:
  /// An error where the folder cannot be written.
  /// `machine`: as machine_name() has it.
  static core::Result<WorkerIdentity> take(const std::string& cache_folder,
                                           const std::string& machine);

  /// A new one, where another worker was found to have this one: a copy that machine_name() does
  /// not tell apart. An error where it cannot be written.
  core::Status renew();

  const std::string& text() const { return text_; }

  /// The file beside the id's for the token of the worker of this id (worker_token.h).
  std::string token_file() const;

 private:
  WorkerIdentity(std::string path, std::string machine, core::Descriptor lock)
      : path_(std::move(path)), machine_(std::move(machine)), lock_(std::move(lock)) {}

  std::string path_;
  std::string machine_;
  std::string text_;
  core::Descriptor lock_;  ///< of the file: released when the process ends, however that happens
};

/// What tells this machine from others, as one word: its host's name and, where `id_file` can be
/// read, a hash of what it says. Two machines made from one image may have the same.
std::string machine_name(const std::string& host, const std::string& id_file = "/etc/machine-id");

}  // namespace hyades::worker
