#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "coordinator/controller/controller.h"
#include "coordinator/web/exchange.h"

namespace hyades::coordinator {

/// What happens to one job (openapi.yaml, /jobs/{job}/events), for one reader, as fast as he reads:
/// a job may have a million frames, and readers may be many and slow.
class JobEvents final : public BodySource {
 public:
  /// `controller` outlives it.
  JobEvents(Controller& controller, uint64_t job);
  ~JobEvents() override;
  JobEvents(const JobEvents&) = delete;
  JobEvents& operator=(const JobEvents&) = delete;

  std::optional<std::string> next() override;
  std::optional<uint64_t> size() const override { return std::nullopt; }
  uint64_t bytes_kept() const override { return text_.size(); }
  uint64_t bytes_needed() const override;
  bool goes_on() const override { return !over_; }
  bool has_news() const override { return *changed_; }

 private:
  grpc::Status read();
  void read_snapshot(const v1::WatchEvent& event);
  void read_change(const v1::WatchEvent& event, const ChangeCursor& before);

  Controller& controller_;
  const uint64_t job_;
  const std::shared_ptr<std::atomic<bool>> changed_ = std::make_shared<std::atomic<bool>>(true);
  uint64_t watch_ = 0;
  ChangeCursor cursor_;
  std::string text_;         ///< that has been read and not been sent
  bool begun_ = false;       ///< the snapshot has
  bool has_frames_ = false;  ///< the snapshot, as far as it has been read
  bool told_ = false;        ///< the snapshot is
  bool rests_ = false;       ///< a change has just been told
  bool ended_ = false;       ///< the job has
  bool over_ = false;        ///< nothing follows
};

}  // namespace hyades::coordinator
