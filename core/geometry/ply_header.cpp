#include "core/geometry/ply_header.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

namespace hyades::core {
namespace {

constexpr size_t kMaxHeader = size_t{1} << 20;
constexpr size_t kMaxProperties = 4096;

constexpr std::array<std::pair<std::string_view, PlyType>, 16> kTypes{{
    {"char", PlyType::int8},
    {"int8", PlyType::int8},
    {"uchar", PlyType::uint8},
    {"uint8", PlyType::uint8},
    {"short", PlyType::int16},
    {"int16", PlyType::int16},
    {"ushort", PlyType::uint16},
    {"uint16", PlyType::uint16},
    {"int", PlyType::int32},
    {"int32", PlyType::int32},
    {"uint", PlyType::uint32},
    {"uint32", PlyType::uint32},
    {"float", PlyType::float32},
    {"float32", PlyType::float32},
    {"double", PlyType::float64},
    {"float64", PlyType::float64},
}};

std::optional<PlyType> type_named(std::string_view name) {
  for (const auto& [known, type] : kTypes) {
    if (known == name) return type;
  }
  return std::nullopt;
}

std::vector<std::string_view> split_words(std::string_view line) {
  std::vector<std::string_view> words;
  size_t at = 0;
  while (true) {
    at = line.find_first_not_of(" \t\r", at);
    if (at == std::string_view::npos) return words;
    const size_t end = std::min(line.find_first_of(" \t\r", at), line.size());
    words.push_back(line.substr(at, end - at));
    at = end;
  }
}

/// Goes through the lines of a header.
class HeaderParser {
 public:
  explicit HeaderParser(std::string_view text) : text_(text) {}

  Result<PlyHeader> parse() {
    bool has_form = false;
    while (auto line = next_line()) {
      const std::vector<std::string_view> words = split_words(*line);
      if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
      if (header_.lines == 1) {
        if (words[0] != "ply") return fail("a PLY file starts with 'ply'");
        continue;
      }
      if (words[0] == "end_header") {
        if (!has_form) return fail("the header has no 'format' line");
        header_.size = at_;
        return header_;
      }
      Status s;
      if (words[0] == "format") {
        s = parse_format(words);
        has_form = true;
      } else if (words[0] == "element") {
        s = parse_element(words);
      } else if (words[0] == "property") {
        s = parse_property(words);
      } else {
        return fail("unknown header word '" + std::string(words[0].substr(0, 40)) + "'");
      }
      if (!s) return s.error();
    }
    return fail("the header does not end with 'end_header'");
  }

 private:
  std::optional<std::string_view> next_line() {
    if (at_ >= text_.size()) return std::nullopt;
    const size_t end = text_.find('\n', at_);
    if (end == std::string_view::npos) return std::nullopt;
    const std::string_view line = text_.substr(at_, end - at_);
    at_ = end + 1;
    ++header_.lines;
    return line;
  }

  Error fail(const std::string& what) const {
    return Error{what}.in("line " + std::to_string(header_.lines));
  }

  Status parse_format(const std::vector<std::string_view>& words) {
    using Form = PlyHeader::Form;
    if (words.size() < 3 || words[2] != "1.0") return fail("expected 'format <form> 1.0'");
    if (words[1] == "ascii") {
      header_.form = Form::text;
    } else if (words[1] == "binary_little_endian") {
      header_.form = Form::little_endian;
    } else if (words[1] == "binary_big_endian") {
      header_.form = Form::big_endian;
    } else {
      return fail("expected ascii, binary_little_endian or binary_big_endian");
    }
    return {};
  }

  Status parse_element(const std::vector<std::string_view>& words) {
    PlyElement element;
    if (words.size() != 3) return fail("expected 'element <name> <count>'");
    element.name = words[1];
    const auto [end, error] =
        std::from_chars(words[2].data(), words[2].data() + words[2].size(), element.count);
    if (error != std::errc() || end != words[2].data() + words[2].size()) {
      return fail("the count of element '" + element.name + "' is not a number");
    }
    header_.elements.push_back(std::move(element));
    return {};
  }

  Status parse_property(const std::vector<std::string_view>& words) {
    if (header_.elements.empty()) return fail("a property before any element");
    PlyProperty p;
    p.is_list = words.size() == 5 && words[1] == "list";
    if (!p.is_list && words.size() != 3) {
      return fail("expected 'property <type> <name>' or 'property list <type> <type> <name>'");
    }
    const auto type = type_named(words[words.size() - 2]);
    const auto count_type = type_named(p.is_list ? words[2] : "uchar");
    if (!type || !count_type) return fail("unknown property type");
    if (p.is_list && !is_integer(*count_type)) return fail("a list's length must be an integer");
    p.type = *type;
    p.count_type = *count_type;
    p.name = words.back();
    if (header_.elements.back().properties.size() >= kMaxProperties) {
      return fail("too many properties");
    }
    header_.elements.back().properties.push_back(std::move(p));
    return {};
  }

  std::string_view text_;
  size_t at_ = 0;
  PlyHeader header_;
};

}  // namespace

size_t size_of(PlyType type) {
  switch (type) {
    case PlyType::int8:
    case PlyType::uint8:
      return 1;
    case PlyType::int16:
    case PlyType::uint16:
      return 2;
    case PlyType::float64:
      return 8;
    default:
      return 4;
  }
}

bool is_integer(PlyType type) { return type != PlyType::float32 && type != PlyType::float64; }

bool PlyElement::has_lists() const {
  return std::any_of(properties.begin(), properties.end(),
                     [](const PlyProperty& p) { return p.is_list; });
}

size_t PlyElement::least_row(bool text) const {
  size_t bytes = 0;
  for (const PlyProperty& p : properties) {
    bytes += text ? 2 : size_of(p.is_list ? p.count_type : p.type);
  }
  return bytes;
}

Result<PlyHeader> parse_ply_header(std::span<const char> bytes) {
  return HeaderParser({bytes.data(), std::min(bytes.size(), kMaxHeader)}).parse();
}

}  // namespace hyades::core
