#pragma once

#include <string>

#include "core/base/result.h"

namespace hyades::coordinator {

/// For `hyades-film finish`, before it opens what a job brings (a configuration of OpenColorIO and
/// its tables): beside it lie the coordinator's keys, tokens and job store. From now on this
/// process writes only below `scratch` and `outputs`. Besides these it reads only programs,
/// libraries and what OpenColorIO and denoisers need of the system. It makes only the system calls
/// that finishing needs: no connections, no signals to others, no programs. It may take three
/// quarters of the memory, and is the first to go where the machine runs out of it. Errors: why the
/// machine cannot do that; without Landlock it does the rest.
core::Status confine_finisher(const std::string& scratch, const std::string& outputs);

/// For a program that encodes a video into the folder `outputs` and is started from here by exec:
/// it reads what is in its own folder, programs and libraries, and writes only there. It may start
/// the system's programs, which are held in with it. Calls and memory: as confine_finisher().
core::Status confine_encoder(const std::string& program, const std::string& outputs);

}  // namespace hyades::coordinator
