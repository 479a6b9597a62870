#pragma once

#include <memory>
#include <string>
#include <vector>

#include <boost/asio/ssl/context.hpp>

#include "core/base/result.h"
#include "farm/channel.h"

namespace hyades::coordinator {

/// TLS for the HTTP server, with the certificates of the day: files that change are read again.
class TlsContext {
 public:
  using Context = std::shared_ptr<boost::asio::ssl::context>;

  explicit TlsContext(const farm::Listen& listen) : listen_(listen) {}

  /// What the files say now; an error that names the one that is wrong.
  core::Result<Context> load() const;

  /// Whether a file is another than when this was last asked; reads none of them.
  bool changed();

 private:
  farm::Listen listen_;
  std::vector<std::string> stamps_;
};

}  // namespace hyades::coordinator
