#include "import/pbrt/parameters.h"

#include <algorithm>
#include <cstddef>
#include <set>

namespace hyades::core::pbrt {
namespace {

size_t count_numbers(const Parameter& p) { return p.numbers.size(); }
size_t count_integers(const Parameter& p) { return p.integers.size(); }
size_t count_flags(const Parameter& p) { return p.flags.size(); }
size_t count_texts(const Parameter& p) { return p.texts.size(); }

}  // namespace

ParameterReader::ParameterReader(const Parameters& parameters, const Place& place, Report& report)
    : parameters_(parameters), place_(place), report_(report), read_(parameters.size(), false) {}

const Parameter* ParameterReader::find(std::string_view type, std::string_view name) {
  for (size_t i = 0; i < parameters_.size(); ++i) {
    if (parameters_[i]->name != name || parameters_[i]->type != type) continue;
    read_[i] = true;
    return parameters_[i].get();
  }
  return nullptr;
}

const Parameter* ParameterReader::find(std::string_view name) {
  for (size_t i = 0; i < parameters_.size(); ++i) {
    if (parameters_[i]->name != name) continue;
    read_[i] = true;
    return parameters_[i].get();
  }
  return nullptr;
}

const Parameter* ParameterReader::one(std::string_view type, std::string_view name, size_t values,
                                      size_t (*count)(const Parameter&)) {
  const Parameter* p = find(type, name);
  if (p == nullptr) return nullptr;
  if (count(*p) == values) return p;
  report_.error(p->place, "parameter '" + p->name + "' has " + std::to_string(count(*p)) +
                              " values, expected " + std::to_string(values));
  return nullptr;
}

std::optional<float> ParameterReader::number_if(std::string_view name) {
  const Parameter* p = one("float", name, 1, count_numbers);
  if (p == nullptr) return std::nullopt;
  return p->numbers[0];
}

float ParameterReader::number(std::string_view name, float otherwise) {
  return number_if(name).value_or(otherwise);
}

int ParameterReader::integer(std::string_view name, int otherwise) {
  const Parameter* p = one("integer", name, 1, count_integers);
  return p == nullptr ? otherwise : p->integers[0];
}

bool ParameterReader::flag(std::string_view name, bool otherwise) {
  const Parameter* p = one("bool", name, 1, count_flags);
  return p == nullptr ? otherwise : p->flags[0] != 0;
}

std::string ParameterReader::text(std::string_view name, const std::string& otherwise) {
  const Parameter* p = one("string", name, 1, count_texts);
  return p == nullptr ? otherwise : p->texts[0];
}

std::span<const std::string> ParameterReader::texts(std::string_view name) {
  const Parameter* p = find("string", name);
  if (p == nullptr) return {};
  return p->texts;
}

Vec3d ParameterReader::triple(std::string_view type, std::string_view name,
                              const Vec3d& otherwise) {
  const Parameter* p = one(type, name, 3, count_numbers);
  if (p == nullptr) return otherwise;
  return {p->numbers[0], p->numbers[1], p->numbers[2]};
}

std::span<const float> ParameterReader::numbers(std::string_view type, std::string_view name,
                                                size_t of) {
  const Parameter* p = find(type, name);
  if (p == nullptr) return {};
  if (p->numbers.size() % of != 0) {
    report_.error(p->place, "parameter '" + p->name + "' has " + std::to_string(p->numbers.size()) +
                                " numbers, expected a multiple of " + std::to_string(of));
    return {};
  }
  return p->numbers;
}

std::span<const int32_t> ParameterReader::integers(std::string_view name, size_t of) {
  const Parameter* p = find("integer", name);
  if (p == nullptr) return {};
  if (p->integers.size() % of != 0) {
    report_.error(p->place, "parameter '" + p->name + "' has " +
                                std::to_string(p->integers.size()) +
                                " numbers, expected a multiple of " + std::to_string(of));
    return {};
  }
  return p->integers;
}

void ParameterReader::note_unused() const {
  std::set<std::string_view> read;
  for (size_t i = 0; i < parameters_.size(); ++i) {
    if (read_[i]) read.insert(parameters_[i]->name);
  }
  for (const ParameterPtr& p : parameters_) {
    // Another one of the same name that was read hides it.
    if (p->inherited || read.contains(p->name)) continue;
    report_.note(p->place, "parameter '" + p->type + " " + p->name + "' is left out");
  }
}

}  // namespace hyades::core::pbrt
