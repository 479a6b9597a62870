#pragma once

#include <sys/types.h>

#include <atomic>
#include <string>
#include <vector>

#include "coordinator/finisher/finish_task.h"
#include "coordinator/finisher/video_task.h"

namespace hyades::coordinator {

/// Runs `program finish FOLDER` on the task, in `folder`, which is emptied before and removed
/// after. Blocks; when `stop` becomes true the process is ended and an error returned. The outputs
/// are durable on return.
core::Result<std::vector<FinishedFile>> run_finisher(const std::string& program,
                                                     const std::string& folder,
                                                     const FinishTask& task, const core::Film& film,
                                                     const std::atomic<bool>& stop);

/// Runs `program video FOLDER` (video_task.h) on the task, in `folder`, which is emptied before and
/// removed after. Blocks; when `stop` becomes true the process is ended and an error returned. The
/// video is durable on return.
core::Result<std::vector<FinishedFile>> run_video_maker(const std::string& program,
                                                        const std::string& folder,
                                                        const VideoTask& task,
                                                        const std::atomic<bool>& stop);

}  // namespace hyades::coordinator
