#include "coordinator/notify/notifier.h"

#include <iterator>
#include <utility>

#include "coordinator/controller/all_pages.h"
#include "coordinator/controller/controller.h"
#include "farm/job_state.h"

namespace hyades::coordinator {
namespace {

std::vector<std::unique_ptr<Hook>> open_hooks(const std::vector<std::string>& urls,
                                              const Hook::Options& options) {
  std::vector<std::unique_ptr<Hook>> hooks;
  for (const std::string& url : urls) {
    Hook::Options own = options;
    own.url = url;
    hooks.push_back(std::make_unique<Hook>(own));
  }
  return hooks;
}

/// The newest job there is, ended or not; 0: none.
uint64_t newest_job(Controller& controller) {
  v1::ListJobsRequest request;
  request.set_ended(true);
  request.set_limit(1);
  v1::ListJobsResponse response;
  const bool known = controller.queries().list(request, response).ok() && response.jobs_size() > 0;
  return known ? response.jobs(0).id() : 0;
}

}  // namespace

Notifier::Notifier(Controller& controller, Options options)
    : controller_(controller),
      options_(std::move(options)),
      hooks_(open_hooks(options_.hooks, options_.hook)),
      chats_(open_hooks(options_.chats, options_.hook)),
      newest_(newest_job(controller)),
      looks_(1, options_.look) {
  look();
  looks_.add(0, [this] {
    look();
    return false;  // and again
  });
}

void Notifier::look() {
  const auto now = Clock::now();
  std::map<uint64_t, v1::Job> jobs;
  for (const v1::Job& job : all_open_jobs(controller_)) jobs[job.id()] = job;
  for (const auto& [id, job] : jobs) look_at(job, now);
  // What was open and is no more has ended, or was deleted since.
  for (auto seen = open_.begin(); seen != open_.end();) {
    if (jobs.contains(seen->first)) {
      ++seen;
      continue;
    }
    v1::GetJobResponse got;
    const grpc::Status status = controller_.queries().get(seen->first, INT32_MAX, got);
    if (status.error_code() == grpc::StatusCode::UNAVAILABLE) {
      ++seen;  // again with the next look
      continue;
    }
    if (status.ok()) tell_of_end(got.job());
    const bool open_again = status.ok() && !farm::has_ended(got.job());
    seen = open_again ? std::next(seen) : open_.erase(seen);
  }
  tell_of_unseen();
}

void Notifier::look_at(const v1::Job& job, Clock::time_point now) {
  const auto [seen, first] = open_.try_emplace(job.id(), Seen{job.samples_done(), now});
  Seen& before = seen->second;
  const bool moves = job.samples_done() != before.samples_done;
  if (first || moves || job.state() != v1::JOB_STATE_RUNNING) {
    before = {job.samples_done(), now};
    return;
  }
  if (before.told || now - before.since < options_.stall) return;
  before.told = true;
  v1::ExplainResponse why;
  News news{News::Kind::stalled, job};
  if (controller_.diagnosis().explain(job.id(), why).ok()) {
    news.reasons.assign(why.reasons().begin(), why.reasons().end());
  }
  tell(news);
}

/// Tells of a job that is done or has failed, and of no other.
void Notifier::tell_of_end(const v1::Job& job) {
  if (job.state() == v1::JOB_STATE_DONE) tell({News::Kind::done, job});
  if (job.state() == v1::JOB_STATE_FAILED) tell({News::Kind::failed, job});
}

/// Tells of jobs that came and ended between two looks.
void Notifier::tell_of_unseen() {
  v1::ListJobsRequest request;
  request.set_ended(true);
  v1::ListJobsResponse response;
  request.set_limit(100);
  if (newest_job(controller_) <= newest_) return;
  if (!controller_.queries().list(request, response).ok()) return;
  // From the oldest on: one that is open and was not seen yet is looked at next time.
  for (auto job = response.jobs().rbegin(); job != response.jobs().rend(); ++job) {
    if (job->id() <= newest_) continue;
    const bool seen = open_.contains(job->id());
    if (!seen && !farm::has_ended(*job)) break;
    newest_ = job->id();
    if (!seen) tell_of_end(*job);
  }
}

void Notifier::tell(const News& news) {
  for (const auto& hook : hooks_) hook->post(program_message(news, options_.dashboard));
  for (const auto& chat : chats_) chat->post(chat_message(news, options_.dashboard));
}

}  // namespace hyades::coordinator
