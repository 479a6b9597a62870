#pragma once

#include <chrono>
#include <memory>
#include <optional>

#include "core/base/result.h"
#include "worker/clouds/cloud.h"
#include "worker/clouds/metadata.h"
#include "worker/clouds/notice.h"

namespace hyades::worker {

/// How one cloud is asked. Used by one thread.
class NoticeSource {
 public:
  virtual ~NoticeSource() = default;
  /// Asks once; may take as long as a request or two.
  virtual core::Result<std::optional<Notice>> look() = 0;
  /// How long to wait between two looks.
  virtual std::chrono::milliseconds pause() const = 0;
};

std::unique_ptr<NoticeSource> make_notice_source(Cloud cloud, const Metadata& metadata);

}  // namespace hyades::worker
