#include "coordinator/controller/controller_context.h"

#include <utility>

#include <fmt/format.h>

#include "coordinator/controller/active_job.h"
#include "coordinator/meters/meters.h"
#include "core/base/wall_clock.h"

namespace hyades::coordinator {

ControllerContext::ControllerContext(ControllerOptions options_, std::unique_ptr<JobStore> store_,
                                     std::unique_ptr<FilmLogs> films_,
                                     std::unique_ptr<farm::ContentStore> assets_,
                                     uint64_t incarnation_, std::string secret)
    : options(std::move(options_)),
      store(std::move(store_)),
      films(std::move(films_)),
      assets(std::move(assets_)),
      incarnation(incarnation_),
      proofs(std::move(secret)),
      started_ms(core::wall_ms()),
      meters(std::make_unique<Meters>()) {}

ControllerContext::~ControllerContext() = default;

std::string ControllerContext::output_folder(uint64_t job) const {
  return fmt::format("{}/outputs/{}", options.files, job);
}

void ControllerContext::in_background(const ActiveJob& active, farm::RetryQueue::Task task) {
  background.add(active.stored.id, std::move(task), active.stored.owner);
}

}  // namespace hyades::coordinator
