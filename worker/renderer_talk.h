#pragma once

#include <string>

#include "core/base/result.h"
#include "worker/pipe/message_pipe.h"
#include "worker/pipe/render_pipe.pb.h"

namespace hyades::worker {

/// The most that a rendering child may say at once. A film is as long as what the coordinator
/// takes.
pipe::PipeLimits renderer_limits();

/// What a rendering child says, judged message by message. It may have been taken over by a file of
/// a job, so that nothing which it says is to cost its worker more than the units that it has.
class RendererTalk {
 public:
  /// The next message of the child, with its load, which becomes the film where it is one. An error
  /// completes "the process that renders ...": no child that works says this now.
  core::Status hear(pipe::FromRenderer& message, std::string load);

 private:
  bool greeted_ = false;
};

}  // namespace hyades::worker
