#include "worker/worker.h"

#include <unistd.h>

#include <array>
#include <filesystem>
#include <system_error>
#include <utility>

#include "core/base/random_id.h"
#include "farm/channels.h"
#include "farm/content_store.h"
#include "farm/log.h"
#include "farm/tags.h"
#include "worker/worker_identity.h"
#include "worker/worker_loop.h"
#include "worker/worker_token.h"

namespace hyades::worker {

namespace {

/// Older workers had the files of jobs in the cache folder itself. What cannot be moved is fetched
/// again.
void move_old_files(const std::string& cache, const std::string& files) {
  std::error_code failed;
  for (const auto& entry : std::filesystem::directory_iterator(cache, failed)) {
    const std::string name = entry.path().filename().string();
    if (farm::is_content_name(name))
      std::filesystem::rename(entry.path(), files + "/" + name, failed);
  }
}

}  // namespace

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
  auto channels = farm::Channels::open(options.coordinator);
  if (!channels) return refuse(channels.error(), kWrongInput);
  if (const std::string warning = farm::plaintext_warning(options.coordinator); !warning.empty()) {
    farm::log(farm::LogLevel::warning, warning);
  }
  auto tags = farm::check_tags(options.tags);
  if (!tags) return refuse(tags.error(), kWrongInput);
  std::error_code failed;
  const std::string files = files_folder(options);
  std::filesystem::create_directories(files, failed);
  if (failed) return refuse({files + ": cannot be made: " + failed.message()});
  move_old_files(options.cache, files);
  auto store = farm::ContentStore::open({files, options.cache_size});
  if (!store) return refuse(store.error());
  auto id = WorkerIdentity::take(options.cache, machine_name(host_name()));
  if (!id) return refuse(id.error());
  WorkerToken token(options.coordinator.token_file, id->token_file());
  if (auto read = token.read(id->text()); !read) return refuse(read.error(), kWrongInput);
  const auto instance = core::random_id();
  if (!instance) return refuse(instance.error());
  return work(options, std::move(*id), *instance, *channels, std::move(token), **store, signals);
}

}  // namespace hyades::worker
