#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace hyades::cli {

/// "0,0,64,64" (between: ',') or "640x360" ('x') as so many numbers; nothing where it is none.
std::optional<std::vector<int>> whole_numbers(const std::string& text, char between, size_t count);

/// An option of numbers with commas between them, as many as `form` ("X,Y") has parts. What
/// follows them is not taken for more of them, as it is with lists of CLI11.
CLI::Option* add_whole_numbers(CLI::App& app, const std::string& name, std::vector<int>& numbers,
                               const std::string& form, const std::string& description);

}  // namespace hyades::cli
