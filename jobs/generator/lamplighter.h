#pragma once

#include <string>

namespace hyades::gallery {

/// A lamplighter, 1.05 units tall, as a binary glTF file: a skinned body on seventeen joints, eyes
/// that blink (a morph target), a lantern in his hand that shines; animations "Walk" (a cycle of
/// one second in place, 0.62 units long) and "Wave". He looks along +z.
std::string make_lamplighter();

}  // namespace hyades::gallery
