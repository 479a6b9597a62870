#include "coordinator/controller/shared.h"

#include <utility>

#include <fmt/format.h>

#include "coordinator/controller/wall_clock.h"
#include "coordinator/meters/meters.h"

namespace hyades::coordinator {

Shared::Shared(ControllerOptions options_, std::unique_ptr<JobStore> store_,
               std::unique_ptr<farm::ContentStore> assets_, uint64_t incarnation_)
    : options(std::move(options_)),
      store(std::move(store_)),
      assets(std::move(assets_)),
      incarnation(incarnation_),
      started_ms(wall_ms()),
      meters(std::make_unique<Meters>()) {}

Shared::~Shared() = default;

std::string Shared::output_folder(uint64_t job) const {
  return fmt::format("{}/outputs/{}", options.folder, job);
}

std::string Shared::films_folder(uint64_t job) const {
  return fmt::format("{}/films/{}", options.folder, job);
}

}  // namespace hyades::coordinator
