#pragma once

#include <memory>

#include "coordinator/controller/controller_context.h"
#include "coordinator/controller/dispatcher.h"
#include "coordinator/controller/job_table.h"

namespace hyades::coordinator {

class JobFilms;

/// Hands jobs to the scheduler: new ones, and those that were recovered.
class JobStarter {
 public:
  JobStarter(ControllerContext& context, Dispatcher& dispatcher, JobTable& jobs, JobFilms& films)
      : context_(context), dispatcher_(dispatcher), jobs_(jobs), films_(films) {}

  /// Begins with a job that nobody else knows yet, where its frames are as `restored` says and its
  /// films as they lie on the disk. An error where these cannot be read; the job is then forgotten.
  core::Status start(std::unique_ptr<ActiveJob> owned, RestoredJob restored)
      HYADES_EXCLUDES(state_lock);

 private:
  core::Status prepare(ActiveJob& active, RestoredJob restored, JobAdded& added)
      HYADES_EXCLUDES(state_lock);
  void restore_films(ActiveJob& active, const LogContents& contents, RestoredJob& restored)
      HYADES_REQUIRES(state_lock);

  ControllerContext& context_;
  Dispatcher& dispatcher_;
  JobTable& jobs_;
  JobFilms& films_;
};

}  // namespace hyades::coordinator
