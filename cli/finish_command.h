#pragma once

namespace hyades::cli {

/// `hyades-film finish FOLDER`: what a coordinator starts to make a frame's outputs
/// (coordinator/finisher/finish_task.h). Exit status: 0 done, 1 it failed, and why is on standard
/// error.
int finish_command(int argc, char** argv);

/// `hyades-film video FOLDER`: the same for a video (coordinator/finisher/video_task.h). Ends when
/// the coordinator does.
int finish_video_command(int argc, char** argv);

}  // namespace hyades::cli
