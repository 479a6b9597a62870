#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace hyades::core {

/// Least number of insertions, deletions, replacements and swaps of neighbouring letters that turn
/// `a` into `b` (optimal string alignment), ASCII case and '-' against '_' ignored.
size_t edit_distance(std::string_view a, std::string_view b);

/// The candidate that `name` is most likely a misspelling of (the first of equals), for 'did you
/// mean'; nothing where none is near: more than a third of the letters would have to change.
std::optional<std::string> closest_name(std::string_view name,
                                        std::span<const std::string> candidates);

/// ", did you mean 'x'?" or, where nothing is near, "": what errors append to an unknown name.
std::string did_you_mean(std::string_view name, std::span<const std::string> candidates);

/// `text` with a to z in place of A to Z; all other bytes stay.
std::string lower_case(std::string_view text);

/// Whether `c` is one of a to z, A to Z and 0 to 9.
bool is_letter_or_digit(char c);

/// The value of a hexadecimal digit of either case; -1 of other characters.
int hex_digit(char c);

/// `text` with the bytes that each %XX stands for in its place (RFC 3986, section 2.1). Nothing
/// where a % is followed by something else.
std::optional<std::string> percent_decoded(std::string_view text);

/// `text` as a word of a shell's command line, in quotes where it needs them: "job.yaml",
/// "'my job.yaml'".
std::string shell_word(const std::string& text);

/// "a, b or c".
std::string join_names(std::span<const std::string> names);

/// A length of time in words, two units at most: "0.42 s", "12.3 s", "4 min 05 s", "1 h 02 min",
/// "3 d 04 h". Negative and non-finite: "?".
std::string format_duration(double seconds);

/// format_duration() of a guess, how long something will yet take, in whole seconds: "2 s",
/// "4 min 05 s".
std::string format_time_left(double seconds);

/// A rate of what is named, with three digits: "850 samples/s", "12.3 ksamples/s", "2.35 Mrays/s".
std::string format_rate(double per_second, std::string_view what);

/// A noise (core/film/noise.h) with two digits: "0.016", "1.6", "160".
std::string format_noise(double noise);

/// "512 B", "1.5 KiB", "12.3 MiB", "1.0 GiB", ...
std::string format_bytes(uint64_t bytes);

/// Thousands in groups: "1,234,567".
std::string format_count(uint64_t count);

/// "1 unit", "2 units"; of words whose plural ends with s.
std::string counted(uint64_t count, std::string_view word);

/// How many bytes the first character of `text`, which is not empty, has; 0 where it is not UTF-8
/// (RFC 3629, section 4: no overlong forms, no surrogates, nothing above U+10FFFF).
size_t utf8_length(std::string_view text);

}  // namespace hyades::core
