#pragma once

#include <sys/types.h>

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/descriptor.h"
#include "core/base/result.h"

namespace hyades::core {

/// The first executable file called `name` in the folders of PATH.
std::optional<std::string> find_program(const std::string& name);

/// A program that runs as a child: fed through its standard input, its complaints (standard output
/// and error) kept. Started with arguments, without a shell. Used by one thread.
class ChildProcess {
 public:
  /// Asked many times a second while somebody waits; an error ends the child and is returned.
  using MayGoOn = std::function<Status()>;

  /// Starts the program at `path`; the error says why it could not be. Errors call it `name`, or as
  /// its file is called.
  static Result<ChildProcess> start(const std::string& path,
                                    const std::vector<std::string>& arguments,
                                    const std::string& name = {});

  ChildProcess(ChildProcess&& other) noexcept;
  ChildProcess& operator=(ChildProcess&&) = delete;
  /// Ends the child with SIGKILL if it runs still.
  ~ChildProcess();

  /// Writes to the child's standard input. False where it reads no more: finish() tells why.
  Result<bool> feed(std::span<const std::byte> bytes, const MayGoOn& may_go_on);

  /// Closes its standard input and waits for its end. An error where it failed, with the end of its
  /// complaints.
  Status finish(const MayGoOn& may_go_on);

  /// Bytes that the child has taken so far.
  size_t fed() const { return fed_; }

 private:
  ChildProcess() = default;
  void listen();
  Status wait(const MayGoOn& may_go_on, short events);

  std::string name_;
  pid_t pid_ = -1;
  Descriptor input_;
  Descriptor said_pipe_;
  std::string said_;
  size_t fed_ = 0;
};

}  // namespace hyades::core
