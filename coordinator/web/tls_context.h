#pragma once

#include <memory>
#include <string>
#include <vector>

#include <boost/asio/ssl/context.hpp>

#include "core/base/mutex.h"
#include "core/base/result.h"
#include "farm/channel.h"

namespace hyades::coordinator {

/// TLS for the HTTP server, with the certificates of the day: files that change are read again.
/// Thread-safe.
class TlsContext {
 public:
  using Context = std::shared_ptr<boost::asio::ssl::context>;
  using Stamps = std::vector<std::string>;  ///< others whenever a file is another

  /// `listen` names the files: certificate, key and, where clients have to show one, authority.
  explicit TlsContext(const farm::Listen& listen) : listen_(listen) {}

  /// Reads the files as they are now. The error names the one that is wrong.
  core::Result<Context> load() const;

  /// The stamps of the files as they are, to be asked for before load(). Reads no file.
  Stamps stamps() const;

  /// Whether a file has changed since the last taken().
  bool changed() const;
  /// Says that what load() gave after `stamps` were asked for is in use.
  void taken(const Stamps& stamps);

 private:
  farm::Listen listen_;
  mutable core::Mutex mutex_;
  Stamps taken_ HYADES_GUARDED_BY(mutex_);
};

}  // namespace hyades::coordinator
