#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <boost/asio/ssl/context.hpp>

#include "core/base/result.h"
#include "farm/channel.h"

namespace hyades::coordinator {

/// TLS for the HTTP server, with the certificates of the day: files that change are read again.
/// Thread-safe.
class TlsContext {
 public:
  using Context = std::shared_ptr<boost::asio::ssl::context>;
  using Stamps = std::vector<std::string>;  ///< others whenever a file is another

  explicit TlsContext(const farm::Listen& listen) : listen_(listen) {}

  /// What the files say now; an error that names the one that is wrong.
  core::Result<Context> load() const;

  /// Of the files as they are; to be asked for before they are read. Reads none of them.
  Stamps stamps() const;

  /// Whether a file is another than when what was read was last taken.
  bool changed() const;
  /// What was read after `stamps` is in use.
  void taken(const Stamps& stamps);

 private:
  farm::Listen listen_;
  mutable std::mutex mutex_;
  Stamps taken_;
};

}  // namespace hyades::coordinator
