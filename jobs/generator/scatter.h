#pragma once

#include <string>

namespace hyades::gallery {

/// The text of a job that has one group, `flock`: a hundred paper lanterns (cylinders that shine)
/// in a block of 16 x 7 x 16 metres, hung at places that keep clear of each other, of four colours.
std::string lanterns();

/// The text of a job that has one group, `spray`: sixty leaves (squares of material `leaf`, 16 cm
/// wide) on a stem of material `bark` that winds up to a height of 1.2.
std::string spray_of_leaves();

}  // namespace hyades::gallery
