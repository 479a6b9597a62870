#pragma once

namespace hyades::cli {

/// `hyades denoise`: a picture without its noise.
int denoise_command(int argc, char** argv);

}  // namespace hyades::cli
