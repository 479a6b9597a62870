#pragma once

#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/job/yaml_tree.h"

namespace hyades::core {

/// The comment that begins a mark: "#line 12", or "#line 3 parts/roof.lua" of another file beside
/// the document's script.
inline constexpr std::string_view kLineMark = "#line ";

/// Where the lines of a document that a script made come from: its marks (kLineMark) each tell for
/// the lines below them, up to the next. Documents of anything else have no marks: every line is
/// its own. Of other files the first 256 of the script's folder are told apart; what comes from
/// others counts as the script's own.
class MadeLines {
 public:
  /// `text`: the document. `file`: what complaints call it; marks count where that is a script.
  MadeLines(std::string_view text, const std::string& file);

  /// The place that a person may look at for `line` [from 1] and `column` of the document.
  YamlPlace at(int line, int column) const;

  /// The other files that marks name, as complaints call them.
  std::set<std::string> other_files() const;

 private:
  struct Mark {
    int from = 0;  ///< the first line of the document that it tells of
    YamlPlace where;
  };

  YamlPlace place_of(std::string_view mark);

  std::shared_ptr<const std::string> file_;
  bool made_;
  std::map<std::string, std::shared_ptr<const std::string>, std::less<>> others_;  ///< by mark
  std::vector<Mark> marks_;  ///< by rising `from`
};

}  // namespace hyades::core
