#include "worker/worker.h"

#include <unistd.h>

#include <array>
#include <filesystem>
#include <system_error>
#include <utility>

#include "core/base/random_id.h"
#include "farm/content_store.h"
#include "farm/log.h"
#include "farm/tags.h"
#include "worker/worker_id.h"
#include "worker/worker_loop.h"

namespace hyades::worker {

std::string host_name() {
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "unknown";
}

int run_worker(const WorkerOptions& options, const volatile std::sig_atomic_t& signals) {
  const auto refuse = [](const core::Error& error, int status = 1) {
    farm::log(farm::LogLevel::error, error.message);
    return status;
  };
  constexpr int kWrongInput = 2;
  auto token = farm::read_token(options.coordinator.token_file);
  if (!token) return refuse(token.error(), kWrongInput);
  auto channel = farm::connect(options.coordinator);
  if (!channel) return refuse(channel.error(), kWrongInput);
  if (const std::string warning = farm::plaintext_warning(options.coordinator); !warning.empty()) {
    farm::log(farm::LogLevel::warning, warning);
  }
  auto tags = farm::check_tags(options.tags);
  if (!tags) return refuse(tags.error(), kWrongInput);
  std::error_code failed;
  std::filesystem::create_directories(options.cache, failed);
  if (failed) return refuse({options.cache + ": cannot be made: " + failed.message()});
  auto store = farm::ContentStore::open({options.cache, options.cache_size});
  if (!store) return refuse(store.error());
  auto id = WorkerId::take(options.cache, machine_name(host_name()));
  if (!id) return refuse(id.error());
  const auto instance = core::random_id();
  if (!instance) return refuse(instance.error());
  return work(options, std::move(*id), *instance, *channel, *token, **store, signals);
}

}  // namespace hyades::worker
