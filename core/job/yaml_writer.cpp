#include "core/job/yaml_writer.h"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/job/made_lines.h"
#include "core/job/read_values.h"

namespace hyades::core {

namespace {

constexpr size_t kLineLength = 110;

using Kind = YamlNode::Kind;

bool is_plain_inside(char c) {
  const auto u = static_cast<unsigned char>(c);
  return std::isalnum(u) != 0 || c == '_' || c == '-' || c == '.' || c == '/' || c == '+';
}

/// Whether the text reads as itself without quotes: words that mean nothing else, as of names and
/// of files.
bool is_plain(const std::string& text) {
  if (text.empty() || text.back() == ' ') return false;
  const bool begins = std::isalnum(static_cast<unsigned char>(text.front())) != 0 ||
                      text.front() == '_' || text.starts_with("./") || text.starts_with("../");
  const auto fits = [](char c) { return c == ' ' || is_plain_inside(c); };
  if (!begins || !std::all_of(text.begin(), text.end(), fits)) return false;
  return text != "null" && text != "Null" && text != "NULL";
}

/// Whether a text would be taken for a number, a flag or a colour without its quotes.
bool reads_as_more(const std::string& text) {
  double number = 0.0;
  return parse_number(text, number) || text == "true" || text == "false";
}

std::string quoted(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string scalar_text(const YamlNode& node) {
  if (node.kind == Kind::null) return "~";
  const bool word = is_plain(node.scalar) && !(node.quoted && reads_as_more(node.scalar));
  if (word) return node.scalar;
  // Numbers, and what else is not in quotes, is written as it was read.
  double number = 0.0;
  if (!node.quoted && parse_number(node.scalar, number)) return node.scalar;
  return quoted(node.scalar);
}

std::string key_text(const std::string& key) { return is_plain(key) ? key : quoted(key); }

/// `node` in one line, appended to `out`. False, with `out` cut off anywhere, where it grows beyond
/// `most`.
bool in_one_line(const YamlNode& node, size_t most, std::string& out) {
  if (out.size() > most) return false;
  if (node.kind == Kind::map) {
    out += '{';
    for (size_t i = 0; i < node.map.size(); ++i) {
      out += (i > 0 ? ", " : "") + key_text(node.map[i].key) + ": ";
      if (!in_one_line(*node.map[i].value, most, out)) return false;
    }
    out += '}';
  } else if (node.kind == Kind::list) {
    out += '[';
    for (size_t i = 0; i < node.list.size(); ++i) {
      if (i > 0) out += ", ";
      if (!in_one_line(*node.list[i], most, out)) return false;
    }
    out += ']';
  } else {
    out += scalar_text(node);
  }
  return out.size() <= most;
}

class Writer {
 public:
  /// `script`: see write_yaml_of_script(); null: no marks.
  explicit Writer(const std::string* script = nullptr) : script_(script) {}

  std::string text;

  void map(const YamlNode& node, size_t depth) {
    for (const YamlEntry& entry : node.map) {
      mark(entry.value->where);
      text.append(2 * depth, ' ');
      text += key_text(entry.key) + ":";
      value(*entry.value, depth);
    }
  }

 private:
  /// Says where what follows was made, unless that was said last.
  void mark(const YamlPlace& where) {
    if (script_ == nullptr || where.line == 0) return;
    if (where.line == marked_.line && where.file == marked_.file) return;
    marked_ = where;
    text += std::string(kLineMark) + std::to_string(where.line);
    if (where.file != nullptr && *where.file != *script_) text += ' ' + *where.file;
    text += '\n';
  }

  void list(const YamlNode& node, size_t depth) {
    for (const YamlPtr& item : node.list) {
      mark(item->where);
      text.append(2 * depth, ' ');
      text += "-";
      value(*item, depth);
    }
  }

  /// What follows "key:" or "-" at `depth`.
  void value(const YamlNode& node, size_t depth) {
    const size_t column = text.size() - (text.rfind('\n') + 1);
    std::string line;
    const bool section = depth == 0 && is_section(node);
    if (!section && in_one_line(node, std::max<size_t>(kLineLength - column, 1), line)) {
      text += ' ' + line + '\n';
    } else if (node.kind == Kind::map && !node.map.empty()) {
      text += '\n';
      map(node, depth + 1);
    } else if (node.kind == Kind::list && is_list_of_scalars(node)) {
      text += ' ';
      wrapped(node, depth + 1);
    } else if (node.kind == Kind::list && !node.list.empty()) {
      text += '\n';
      list(node, depth + 1);
    } else {
      text += ' ' +
              (node.kind == Kind::map    ? "{}"
               : node.kind == Kind::list ? "[]"
                                         : scalar_text(node)) +
              '\n';
    }
  }

  /// Maps of maps at the top: textures, materials, objects.
  static bool is_section(const YamlNode& node) {
    return node.kind == Kind::map && !node.map.empty() &&
           std::all_of(node.map.begin(), node.map.end(),
                       [](const YamlEntry& e) { return e.value->kind == Kind::map; });
  }

  static bool is_list_of_scalars(const YamlNode& node) {
    return !node.list.empty() &&
           std::all_of(node.list.begin(), node.list.end(),
                       [](const YamlPtr& item) { return item->kind == Kind::scalar; });
  }

  /// Numbers over several lines.
  void wrapped(const YamlNode& node, size_t depth) {
    text += '[';
    size_t begin = text.rfind('\n') + 1;
    for (size_t i = 0; i < node.list.size(); ++i) {
      const std::string item = scalar_text(*node.list[i]);
      if (i > 0) text += ',';
      if (i > 0 && text.size() - begin + item.size() > kLineLength) {
        text += '\n';
        begin = text.size();
        text.append(2 * depth, ' ');
      } else if (i > 0) {
        text += ' ';
      }
      text += item;
    }
    text += "]\n";
  }

  const std::string* script_;
  YamlPlace marked_;
};

}  // namespace

std::string write_yaml(const YamlNode& root) {
  Writer writer;
  writer.map(root, 0);
  return std::move(writer.text);
}

std::string write_yaml_of_script(const YamlNode& root, const std::string& script) {
  Writer writer(&script);
  writer.map(root, 0);
  return std::move(writer.text);
}

}  // namespace hyades::core
