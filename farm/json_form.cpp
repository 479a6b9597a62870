#include "farm/json_form.h"

#include <string_view>
#include <utility>

#include "core/base/text.h"
#include "farm/wire.h"

namespace hyades::farm {
namespace {

using google::protobuf::EnumDescriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

/// What a field holds; of a repeated one its element `at`.
Json value_of(const Message& message, const FieldDescriptor& field, std::optional<int> at) {
  const auto& reflection = *message.GetReflection();
  const auto get = [&](auto single, auto repeated) {
    return at ? (reflection.*repeated)(message, &field, *at)
              : (reflection.*single)(message, &field);
  };
  using R = google::protobuf::Reflection;
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_BOOL:
      return get(&R::GetBool, &R::GetRepeatedBool);
    case FieldDescriptor::CPPTYPE_INT32:
      return get(&R::GetInt32, &R::GetRepeatedInt32);
    case FieldDescriptor::CPPTYPE_INT64:
      return get(&R::GetInt64, &R::GetRepeatedInt64);
    case FieldDescriptor::CPPTYPE_UINT32:
      return get(&R::GetUInt32, &R::GetRepeatedUInt32);
    case FieldDescriptor::CPPTYPE_UINT64:
      return get(&R::GetUInt64, &R::GetRepeatedUInt64);
    case FieldDescriptor::CPPTYPE_FLOAT:
      return get(&R::GetFloat, &R::GetRepeatedFloat);
    case FieldDescriptor::CPPTYPE_DOUBLE:
      return get(&R::GetDouble, &R::GetRepeatedDouble);
    case FieldDescriptor::CPPTYPE_ENUM:
      return enum_word(*field.enum_type(), get(&R::GetEnumValue, &R::GetRepeatedEnumValue));
    case FieldDescriptor::CPPTYPE_STRING: {
      std::string text = get(&R::GetString, &R::GetRepeatedString);
      return field.type() == FieldDescriptor::TYPE_BYTES ? hex_from_wire(text) : std::move(text);
    }
    case FieldDescriptor::CPPTYPE_MESSAGE:
      return to_json(at ? reflection.GetRepeatedMessage(message, &field, *at)
                        : reflection.GetMessage(message, &field));
  }
  return {};
}

}  // namespace

std::string enum_word(const EnumDescriptor& type, int number) {
  static constexpr std::string_view kNone = "UNSPECIFIED";
  const auto* value = type.FindValueByNumber(number);
  if (value == nullptr || value->name().ends_with(kNone)) return "unknown";
  // All names begin as that of the value 0 does.
  return core::lower_case(value->name().substr(type.value(0)->name().size() - kNone.size()));
}

std::string state_name(v1::JobState state) { return enum_word(*v1::JobState_descriptor(), state); }
std::string state_name(v1::FrameState state) {
  return enum_word(*v1::FrameState_descriptor(), state);
}
std::string state_name(v1::WorkerState state) {
  return enum_word(*v1::WorkerState_descriptor(), state);
}
std::string level_name(v1::LogLevel level) { return enum_word(*v1::LogLevel_descriptor(), level); }
std::string role_name(v1::Role role) { return enum_word(*v1::Role_descriptor(), role); }
std::optional<v1::Role> role_of(const std::string& name) {
  for (int role = v1::ROLE_VIEWER; role <= v1::ROLE_ADMIN; ++role) {
    if (name == role_name(static_cast<v1::Role>(role))) return static_cast<v1::Role>(role);
  }
  return std::nullopt;
}

const std::string& json_name(const FieldDescriptor& field) {
  return field.has_json_name() ? field.json_name() : field.name();
}

Json to_json(const Message& message) {
  const auto& type = *message.GetDescriptor();
  const auto& reflection = *message.GetReflection();
  Json json = Json::object();
  for (int i = 0; i < type.field_count(); ++i) {
    const FieldDescriptor& field = *type.field(i);
    if (field.has_presence() && !reflection.HasField(message, &field)) continue;
    Json& value = json[json_name(field)];
    if (field.is_repeated()) {
      value = Json::array();
      for (int k = 0; k < reflection.FieldSize(message, &field); ++k) {
        value.push_back(value_of(message, field, k));
      }
    } else {
      value = value_of(message, field, std::nullopt);
    }
  }
  return json;
}

Json to_json(const v1::LogLine& line) {
  Json json = to_json(static_cast<const Message&>(line));
  if (!line.of_frame()) json.erase("frame");
  json.erase("of_frame");
  json.erase("number");
  return json;
}

Json to_json(const v1::AuditEntry& entry) {
  Json json = to_json(static_cast<const Message&>(entry));
  if (entry.times() <= 1) json.erase("times");
  return json;
}

}  // namespace hyades::farm
