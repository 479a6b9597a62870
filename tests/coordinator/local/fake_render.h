#pragma once

#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "coordinator/local/frame_work.h"
#include "coordinator/local/local_run.h"
#include "tests/coordinator/film_store/fake_film.h"

namespace hyades::coordinator {

/// A renderer without light, and where its films go.
class FakeRender final : public FrameSource, public FrameSink {
 public:
  explicit FakeRender(uint32_t samples) : samples_(samples) {}

  // What shall happen; to be set before the run.
  core::PixelRect splat_region;             ///< empty: there are none
  std::chrono::microseconds unit_delay{0};  ///< given up at once on stop
  std::chrono::milliseconds finish_delay{0};
  std::function<core::Status(const core::Unit&)> unit_fault;
  std::function<core::Film(const core::Unit&)> film_of;  ///< instead of fake ones
  std::function<core::Status(int32_t frame)> prepare_fault;
  std::function<core::Status(int32_t frame)> finish_fault;

  // What happened.
  std::map<int32_t, std::string> digests() const {
    const std::lock_guard lock(mutex_);
    return digests_;
  }
  void lose_output(int32_t frame) { digests_.erase(frame); }
  std::vector<int32_t> prepared() const {
    const std::lock_guard lock(mutex_);
    return prepared_;
  }
  int most_alive() const { return most_alive_; }
  uint64_t units() const { return units_; }
  bool prepared_while_rendering() const { return prepared_while_rendering_; }

  core::Result<std::shared_ptr<const FrameWork>> prepare(int32_t frame) override {
    if (prepare_fault) {
      if (auto fault = prepare_fault(frame); !fault) return fault.error();
    }
    const std::lock_guard lock(mutex_);
    prepared_.push_back(frame);
    prepared_while_rendering_ = prepared_while_rendering_ || rendering_ > 0;
    return std::shared_ptr<const FrameWork>(std::make_shared<Work>(*this));
  }

  core::Status finish(int32_t frame, const core::Film& film) override {
    std::this_thread::sleep_for(finish_delay);
    if (finish_fault) {
      if (auto fault = finish_fault(frame); !fault) return fault;
    }
    const std::lock_guard lock(mutex_);
    digests_[frame] = film.digest();
    return {};
  }

  bool outputs_exist(int32_t frame) override {
    const std::lock_guard lock(mutex_);
    return digests_.contains(frame);
  }

 private:
  class Work final : public FrameWork {
   public:
    explicit Work(FakeRender& owner) : owner_(owner) {
      const int alive = ++owner_.alive_;
      owner_.most_alive_ = std::max(owner_.most_alive_.load(), alive);
    }
    ~Work() override { --owner_.alive_; }

    core::Result<core::Film> render(const core::Unit& unit,
                                    const std::atomic<bool>& stop) const override {
      ++owner_.rendering_;
      auto film = render_slowly(unit, stop);
      --owner_.rendering_;
      return film;
    }

   private:
    core::Result<core::Film> render_slowly(const core::Unit& unit,
                                           const std::atomic<bool>& stop) const {
      if (owner_.unit_fault) {
        if (auto fault = owner_.unit_fault(unit); !fault) return fault.error();
      }
      const auto end = std::chrono::steady_clock::now() + owner_.unit_delay;
      while (!stop && std::chrono::steady_clock::now() < end) {
        std::this_thread::sleep_for(std::min(owner_.unit_delay, std::chrono::microseconds(2000)));
      }
      if (stop) return core::Error{"stopped"};
      ++owner_.units_;
      if (owner_.film_of) return owner_.film_of(unit);
      return fake_film(unit, owner_.samples_, owner_.splat_region);
    }

    FakeRender& owner_;
  };

  const uint32_t samples_;
  mutable std::mutex mutex_;
  std::map<int32_t, std::string> digests_;
  std::vector<int32_t> prepared_;
  std::atomic<bool> prepared_while_rendering_{false};
  std::atomic<int> alive_{0};
  std::atomic<int> most_alive_{0};
  std::atomic<int> rendering_{0};
  std::atomic<uint64_t> units_{0};
};

}  // namespace hyades::coordinator
