#include "coordinator/web/request_form.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>
#include <type_traits>
#include <vector>

#include <fmt/format.h>

#include "coordinator/web/number.h"
#include "core/base/text.h"
#include "farm/wire.h"

namespace hyades::coordinator {
namespace {

using farm::Json;
using google::protobuf::FieldDescriptor;

std::vector<std::string> words_of(const google::protobuf::EnumDescriptor& type) {
  std::vector<std::string> words;
  for (int i = 1; i < type.value_count(); ++i) {
    words.push_back(farm::enum_word(type, type.value(i)->number()));
  }
  return words;
}

bool set_word(Message& message, const FieldDescriptor& field, const std::string& word) {
  const auto& type = *field.enum_type();
  for (int i = 1; i < type.value_count(); ++i) {
    if (farm::enum_word(type, type.value(i)->number()) != word) continue;
    message.GetReflection()->SetEnum(&message, &field, type.value(i));
    return true;
  }
  return false;
}

/// Sets a field to the whole number that `read` gives: read(int32_t{}), say, gives an optional
/// int32_t. False where it gives none, or the field holds no whole numbers.
template <class Read>
bool set_whole(Message& message, const FieldDescriptor& field, const Read& read) {
  const auto& reflection = *message.GetReflection();
  const auto set = [&](auto setter, auto number) {
    if (number) (reflection.*setter)(&message, &field, *number);
    return number.has_value();
  };
  using R = google::protobuf::Reflection;
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_INT32:
      return set(&R::SetInt32, read(int32_t{}));
    case FieldDescriptor::CPPTYPE_INT64:
      return set(&R::SetInt64, read(int64_t{}));
    case FieldDescriptor::CPPTYPE_UINT32:
      return set(&R::SetUInt32, read(uint32_t{}));
    case FieldDescriptor::CPPTYPE_UINT64:
      return set(&R::SetUInt64, read(uint64_t{}));
    default:
      return false;
  }
}

bool set_number(Message& message, const FieldDescriptor& field, const std::string& text) {
  return set_whole(message, field, [&](auto zero) { return number_of<decltype(zero)>(text); });
}

grpc::Status refused(const std::string& message) {
  return {grpc::StatusCode::INVALID_ARGUMENT, message};
}

/// Sets the field that a value of the query is for.
grpc::Status set_from_query(Message& message, const QueryField& query, const std::string& text) {
  const FieldDescriptor& field = *message.GetDescriptor()->FindFieldByName(query.name);
  const auto& reflection = *message.GetReflection();
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_STRING:
      reflection.SetString(&message, &field, text);
      return grpc::Status::OK;
    case FieldDescriptor::CPPTYPE_BOOL: {
      const auto flag = flag_of(text);
      if (!flag)
        return refused(fmt::format("{}: expected true or false, not '{}'", query.name, text));
      reflection.SetBool(&message, &field, *flag);
      return grpc::Status::OK;
    }
    case FieldDescriptor::CPPTYPE_ENUM:
      if (set_word(message, field, text)) return grpc::Status::OK;
      return refused(fmt::format("{}: expected {}", query.name,
                                 core::join_names(words_of(*field.enum_type()))));
    default:
      break;
  }
  if (!set_number(message, field, text)) {
    return refused(fmt::format("{}: expected a whole number, not '{}'", query.name, text));
  }
  const auto number = number_of<int64_t>(text);  // of those with bounds all have such a value
  if (!number || (*number >= query.least && *number <= query.most)) return grpc::Status::OK;
  return refused(
      fmt::format("{}: expected {} to {}, not {}", query.name, query.least, query.most, *number));
}

// The body.

core::Error wrong(const std::string& name, std::string_view expected) {
  return core::Error{fmt::format("{}: expected {}", name, expected)};
}

/// The whole number that a JSON value is, where the type can hold it.
template <class Number>
std::optional<Number> whole_of(const Json& value) {
  if (value.is_number_unsigned()) {
    const auto got = value.get<uint64_t>();
    if (got <= static_cast<uint64_t>(std::numeric_limits<Number>::max())) {
      return static_cast<Number>(got);
    }
  } else if (value.is_number_integer() && std::is_signed_v<Number>) {
    const auto got = value.get<int64_t>();
    if (got >= static_cast<int64_t>(std::numeric_limits<Number>::min())) {
      return static_cast<Number>(got);
    }
  }
  return std::nullopt;
}

core::Status set_text(const std::string& text, const std::string& name,
                      const FieldDescriptor& field, Message& message) {
  const auto& reflection = *message.GetReflection();
  if (field.type() != FieldDescriptor::TYPE_BYTES) {
    reflection.SetString(&message, &field, text);
    return {};
  }
  const auto digest = farm::digest_from_hex(text);
  if (!digest) return wrong(name, "64 hexadecimal digits");
  reflection.SetString(&message, &field, farm::to_wire(*digest));
  return {};
}

core::Status set_json_number(const Json& value, const std::string& name,
                             const FieldDescriptor& field, Message& message) {
  const auto read = [&](auto zero) { return whole_of<decltype(zero)>(value); };
  if (set_whole(message, field, read)) return {};
  const bool natural = field.cpp_type() == FieldDescriptor::CPPTYPE_UINT32 ||
                       field.cpp_type() == FieldDescriptor::CPPTYPE_UINT64;
  return wrong(name, natural ? "a whole number, 0 or more" : "a whole number");
}

/// Sets a field to a value that is no list.
core::Status set_single(const Json& value, const std::string& name, const FieldDescriptor& field,
                        Message& message) {
  const auto& reflection = *message.GetReflection();
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_DOUBLE:
      if (!value.is_number()) return wrong(name, "a number");
      reflection.SetDouble(&message, &field, value.get<double>());
      return {};
    case FieldDescriptor::CPPTYPE_BOOL:
      if (!value.is_boolean()) return wrong(name, "true or false");
      reflection.SetBool(&message, &field, value.get<bool>());
      return {};
    case FieldDescriptor::CPPTYPE_ENUM: {
      if (!value.is_string()) return wrong(name, "a text");
      const auto word = value.get<std::string>();
      if (word.empty() || set_word(message, field, word)) return {};
      return wrong(name, core::join_names(words_of(*field.enum_type())));
    }
    case FieldDescriptor::CPPTYPE_STRING:
      if (!value.is_string()) return wrong(name, "a text");
      return set_text(value.get<std::string>(), name, field, message);
    default:
      return set_json_number(value, name, field, message);
  }
}

core::Status set_object(const Json& json, const std::string& where, const BodyForm& form,
                        Message& message);

core::Status set_list(const Json& values, const std::string& name, const BodyForm* items,
                      const FieldDescriptor& field, Message& message) {
  if (!values.is_array()) return wrong(name, "a list");
  const auto& reflection = *message.GetReflection();
  for (size_t i = 0; i < values.size(); ++i) {
    if (items == nullptr) {
      if (!values[i].is_string()) return wrong(name, "texts");
      reflection.AddString(&message, &field, values[i].get<std::string>());
      continue;
    }
    const core::Status set = set_object(values[i], fmt::format("{}[{}].", name, i), *items,
                                        *reflection.AddMessage(&message, &field));
    if (!set) return set;
  }
  return {};
}

/// Each field where it goes; `name` is the last part of its path.
core::Status set_field(const Json& json, const std::string& where, const BodyField& wanted,
                       const std::string& name, Message& message) {
  const std::string_view path = wanted.path;
  Message* into = &message;
  if (const size_t dot = path.find('.'); dot != std::string_view::npos) {
    const auto* outer = message.GetDescriptor()->FindFieldByName(std::string(path.substr(0, dot)));
    into = message.GetReflection()->MutableMessage(&message, outer);
  }
  const FieldDescriptor& field = *into->GetDescriptor()->FindFieldByName(name);
  const auto value = json.find(name);
  if (value == json.end() || value->is_null()) {
    return wanted.needed ? wrong(where + name, "one") : core::Status{};
  }
  return field.is_repeated() ? set_list(*value, where + name, wanted.items, field, *into)
                             : set_single(*value, where + name, field, *into);
}

core::Status set_object(const Json& json, const std::string& where, const BodyForm& form,
                        Message& message) {
  std::vector<std::string> names;
  std::vector<std::string> needed;
  for (const BodyField& field : form.fields) {
    const std::string_view path = field.path;
    names.emplace_back(path.substr(path.find('.') + 1));
    if (field.needed) needed.push_back(names.back());
  }
  if (!json.is_object()) {
    if (form.expected != nullptr) return core::Error{form.expected};
    if (form.no_object != nullptr) return core::Error{form.no_object};
    std::string all;
    for (const std::string& name : needed) {
      all += (all.empty() ? "" : &name == &needed.back() ? " and " : ", ") + name;
    }
    return wrong(where, all);
  }
  for (size_t i = 0; i < names.size(); ++i) {
    const core::Status set = set_field(json, where, form.fields[i], names[i], message);
    if (set) continue;
    // What is wrong with the items of a list is told by their form.
    const bool of_items =
        form.fields[i].items != nullptr && json.contains(names[i]) && json[names[i]].is_array();
    if (form.expected == nullptr || of_items) return set;
    return core::Error{form.expected};
  }
  for (const auto& [name, value] : json.items()) {
    if (form.expected != nullptr || std::find(names.begin(), names.end(), name) != names.end()) {
      continue;
    }
    return core::Error{
        fmt::format("{}{}: unknown{}", where, name, core::did_you_mean(name, names))};
  }
  return {};
}

}  // namespace

grpc::Status read_target(const WebRequest& request, const Route& route, Message& message) {
  for (const auto& [name, text] : request.parameters) {
    const FieldDescriptor& field = *message.GetDescriptor()->FindFieldByName(name);
    if (field.cpp_type() == FieldDescriptor::CPPTYPE_STRING) {
      message.GetReflection()->SetString(&message, &field, text);
    } else if (!set_number(message, field, text)) {
      return {grpc::StatusCode::NOT_FOUND, fmt::format("there is no {} '{}'", name, text)};
    }
  }
  for (const QueryField& query : route.query) {
    const auto given = request.query.find(query.name);
    if (given == request.query.end()) continue;
    const grpc::Status set = set_from_query(message, query, given->second);
    if (!set.ok()) return set;
  }
  return grpc::Status::OK;
}

grpc::Status read_body(const std::string& body, const BodyForm& form, Message& message) {
  if (body.empty() && form.may_be_empty) return grpc::Status::OK;
  const core::Status set = set_object(Json::parse(body, nullptr, false), "", form, message);
  return set ? grpc::Status::OK : refused(set.error().message);
}

}  // namespace hyades::coordinator
