#pragma once

#include <string>
#include <string_view>

namespace hyades::core {

/// Whether a person who sees `text` in a line sees what it says: UTF-8 (RFC 3629) without control
/// characters (U+0000 to 001F, 007F to 009F, which steer terminals), ends of lines and paragraphs
/// (U+2028, 2029), what turns the direction of text (U+061C, 200E, 200F, 202A to 202E, 2066 to
/// 2069; Unicode Technical Report 36, section 2.4) and what cannot be seen (U+00AD, 180E, 200B,
/// 2060 to 2064, FEFF, FFF9 to FFFB, E0000 to E007F). Joiners (U+200C, 200D), which many scripts
/// need, are printable.
bool is_printable(std::string_view text);

/// `text` with '?' in place of each character that is_printable() does not take, and of each byte
/// that is not UTF-8: for terminals, logs and messages of texts that others have written.
std::string printable(std::string_view text);

/// `text` of several lines with '?' in place of what is not is_printable(); ends of lines (\n)
/// stay.
std::string printable_lines(std::string_view text);

}  // namespace hyades::core
