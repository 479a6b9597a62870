#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <utility>

#include "core/base/address.h"
#include "core/base/descriptor.h"
#include "core/base/result.h"

namespace hyades::cli {

/// A TCP connection to a viewer, for one thread.
class ViewerLink {
 public:
  /// `give_up` is asked every tenth of a second while a name, a connection or a viewer that reads
  /// slowly is waited for.
  ViewerLink(core::Address address, std::function<bool()> give_up)
      : address_(std::move(address)), give_up_(std::move(give_up)) {}

  /// Connects; the error says why not.
  core::Status open();
  void close() { socket_.close(); }

  /// Whether a viewer is there, as far as can be told without sending.
  bool is_open();

  /// Sends all of `bytes`; false, and closed, where the viewer is gone or giving up came first.
  bool send(const std::string& bytes);

 private:
  bool wait_until_writable();

  core::Address address_;
  std::function<bool()> give_up_;
  core::Descriptor socket_;
};

}  // namespace hyades::cli
