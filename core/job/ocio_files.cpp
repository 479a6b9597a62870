#include "core/job/ocio_files.h"

#include <algorithm>
#include <cstddef>
#include <set>
#include <utility>

#include "core/base/assets.h"

namespace hyades::core {
namespace {

constexpr std::string_view kSpace = " \t\r";
constexpr std::string_view kTransform = "<FileTransform>";
constexpr size_t kMostFiles = 10'000;

bool has_variable(const std::string& name) { return name.find_first_of("$%") != name.npos; }

std::string_view trimmed(std::string_view text) {
  const size_t begin = text.find_first_not_of(kSpace);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kSpace) - begin + 1);
}

/// The scalar that `text` begins with: quoted, or up to the end of its line, entry or map.
std::string scalar(std::string_view text) {
  text = text.substr(0, text.find('\n'));
  text = trimmed(text);
  if (!text.empty() && (text[0] == '"' || text[0] == '\'')) {
    return std::string(text.substr(1, text.find(text[0], 1) - 1));
  }
  return std::string(trimmed(text.substr(0, text.find_first_of(",}"))));
}

std::string_view after(std::string_view text, std::string_view word) {
  const size_t at = text.find(word);
  return at == std::string_view::npos ? std::string_view() : text.substr(at + word.size());
}

void add_parts(const std::string& paths, std::vector<std::string>& folders) {
  for (size_t at = 0; at <= paths.size();) {
    const size_t end = std::min(paths.find(':', at), paths.size());
    if (end > at) folders.push_back(paths.substr(at, end - at));
    at = end + 1;
  }
}

/// `search_path: a:b`, or a list of one a line.
std::vector<std::string> search_path(std::string_view config) {
  std::vector<std::string> folders;
  const std::string key = "\nsearch_path:";
  const std::string text = "\n" + std::string(config);
  const size_t found = text.find(key);
  if (found == std::string::npos) return {"."};
  std::string_view rest = std::string_view(text).substr(found + key.size());
  add_parts(scalar(rest), folders);
  while (folders.size() < kMostFiles) {
    const size_t line = rest.find('\n');
    if (line == std::string_view::npos) break;
    rest = rest.substr(line + 1);
    const std::string_view item = trimmed(rest.substr(0, rest.find('\n')));
    if (!item.starts_with("- ")) break;
    add_parts(scalar(item.substr(2)), folders);
  }
  if (folders.empty()) folders.emplace_back(".");
  return folders;
}

}  // namespace

std::vector<std::string> ocio_file_candidates(std::string_view config) {
  std::vector<std::string> candidates;
  std::set<std::string> seen;
  std::set<std::string> files;  // each is looked for in all folders, once
  size_t tried = 0;
  std::vector<std::string> folders = search_path(config);
  // No file has a longer name; without a bound, few of them in many folders would fill the memory.
  std::erase_if(folders, [](const std::string& folder) {
    return has_variable(folder) || folder.size() > kLongestFileName;
  });
  for (std::string_view rest = after(config, kTransform); !rest.empty();
       rest = after(rest, kTransform)) {
    // Its own keys end where the next transform begins.
    std::string_view own = rest.substr(0, rest.find(kTransform));
    own = own.substr(0, own.find("!<"));
    const std::string file = scalar(after(own, "src:"));
    if (file.empty() || file.size() > kLongestFileName || has_variable(file)) continue;
    if (!files.insert(file).second) continue;
    const bool absolute = file.front() == '/';
    const size_t places = absolute ? 1 : folders.size();
    for (size_t i = 0; i < places; ++i) {
      if (++tried > kMostFiles) return candidates;
      std::string path = absolute ? file : folders[i] + "/" + file;
      if (seen.insert(path).second) candidates.push_back(std::move(path));
    }
  }
  return candidates;
}

}  // namespace hyades::core
