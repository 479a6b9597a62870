#pragma once

#include <csignal>
#include <memory>
#include <string>

#include "farm/channels.h"
#include "farm/content_store.h"
#include "worker/worker.h"
#include "worker/worker_identity.h"
#include "worker/worker_token.h"

namespace hyades::worker {

/// This machine's name; "unknown" where it has none.
std::string host_name();

/// What run_worker does once all is opened. `instance` is random, of this process.
int work(const WorkerOptions& options, WorkerIdentity id, const std::string& instance,
         std::shared_ptr<farm::Channels> channels, WorkerToken token, farm::ContentStore& store,
         const volatile std::sig_atomic_t& signals);

}  // namespace hyades::worker
