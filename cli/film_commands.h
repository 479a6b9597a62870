#pragma once

namespace hyades::cli {

// The commands of hyades-film. argv[0] is the command's word, arguments follow; results go to
// standard output, errors to standard error.

/// `hyades compare a.exr b.exr`: prints a report (or JSON). Exit status: 0 fine, 1 a tolerance is
/// exceeded, 2 wrong arguments or pictures that cannot be read or compared.
int compare_command(int argc, char** argv);

/// `hyades convert a.exr -o a.png`: a picture as a display shows it. Exit status: 0 fine, 2 wrong
/// arguments, or a picture that cannot be read or written.
int convert_command(int argc, char** argv);

/// `hyades info a.exr ...`: what is in pictures and films. Exit status: 0 fine, 2 wrong arguments,
/// or a picture that cannot be read.
int info_command(int argc, char** argv);

/// `hyades contact-sheet`: many pictures on one sheet.
int contact_sheet_command(int argc, char** argv);

/// `hyades denoise`: a picture without its noise.
int denoise_command(int argc, char** argv);

/// `hyades relight a.exr --group key=0.5 -o b.exr`: a picture whose light groups are brighter or
/// darker. Exit status: 0 fine, 2 wrong arguments, or a picture that cannot be read or written.
int relight_command(int argc, char** argv);

/// `hyades-film finish FOLDER`: what a coordinator starts to make a frame's outputs
/// (coordinator/finisher/finish_task.h). Exit status: 0 done, 1 it failed, and why is on standard
/// error.
int finish_command(int argc, char** argv);

/// `hyades-film video FOLDER`: what a coordinator starts to make a video
/// (coordinator/finisher/video_task.h). Ends when the coordinator does.
int finish_video_command(int argc, char** argv);

/// `hyades-film encode FOLDER PROGRAM ARGUMENTS...`: what the former starts to encode: becomes the
/// program, which writes in the folder alone.
int encode_command(int argc, char** argv);

/// `hyades merge a.exr b.exr ... -o c.exr`: joins film EXRs of one picture; the result does not
/// depend on their order. Exit status: 0 fine, 2 wrong arguments, files that cannot be read or
/// written, or films that do not fit (the message says which file and why; nothing is written
/// then).
int merge_command(int argc, char** argv);

}  // namespace hyades::cli
