#include "cli/whole_numbers.h"

#include <algorithm>
#include <charconv>
#include <string_view>
#include <system_error>

#include <CLI/CLI.hpp>

namespace hyades::cli {

std::optional<std::vector<int>> whole_numbers(const std::string& text, char between, size_t count) {
  std::vector<int> numbers;
  std::string_view rest = text;
  while (true) {
    const std::string_view part = rest.substr(0, rest.find(between));
    int number = 0;
    const auto read = std::from_chars(part.data(), part.data() + part.size(), number);
    if (read.ec != std::errc() || read.ptr != part.data() + part.size()) return std::nullopt;
    numbers.push_back(number);
    if (part.size() == rest.size()) break;
    rest.remove_prefix(part.size() + 1);
  }
  if (numbers.size() != count) return std::nullopt;
  return numbers;
}

CLI::Option* add_whole_numbers(CLI::App& app, const std::string& name, std::vector<int>& numbers,
                               const std::string& form, const std::string& description) {
  const auto count = static_cast<size_t>(std::count(form.begin(), form.end(), ',')) + 1;
  const auto error = [form, count](const std::string& text) {
    return whole_numbers(text, ',', count) ? std::string()
                                           : text + ": expected " + form + ", whole numbers";
  };
  return app
      .add_option_function<std::string>(
          name,
          [&numbers, count](const std::string& text) {
            numbers = whole_numbers(text, ',', count).value_or(std::vector<int>());
          },
          description)
      ->check(error)
      ->type_name(form);
}

}  // namespace hyades::cli
