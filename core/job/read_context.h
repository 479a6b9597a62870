#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "core/base/assets.h"
#include "core/job/animated.h"
#include "core/job/job.h"
#include "core/job/job_keys.h"
#include "core/job/source.h"
#include "core/job/yaml_tree.h"

namespace hyades::core {

/// The numbers that a key accepts.
struct Range {
  double low = -1e18;  ///< squares of lengths still fit into a float
  double high = 1e18;
  bool low_open = false;   ///< low itself is refused
  bool high_open = false;  ///< high itself is refused

  bool contains(double x) const {
    return (low_open ? x > low : x >= low) && (high_open ? x < high : x <= high);
  }
  /// "a number", "a number from 0 to 1", "a number above 0 and below 180".
  std::string describe(const std::string& noun = "a number") const;
};

inline constexpr Range kAnyNumber{};
inline constexpr Range kPositive{0.0, 1e18, true, false};
inline constexpr Range kNotNegative{0.0, 1e18};
inline constexpr Range kUnitInterval{0.0, 1.0};

/// What a name in a job may stand for.
enum class NameKind { texture, material, group, object };

/// A name that was used somewhere and must exist.
struct NameUse {
  NameKind kind = NameKind::texture;
  std::string name;
  SourceLocation where;
  std::string label;  ///< "color of material 'floor'"
};

/// A file that was named somewhere and must open.
struct FileUse {
  std::string reference;  ///< relative to the job's folder
  SourceLocation where;
  std::string label;
};

/// An expression whose values over the job's frames must lie in a range.
struct ExpressionUse {
  std::shared_ptr<const Expression> expression;
  Range range;
  SourceLocation where;
  std::string label;
};

/// What all readers of one job share.
struct ReadContext {
  ReadContext(Job& target, Diagnostics& complaints) : job(target), diagnostics(complaints) {}

  Job& job;
  Diagnostics& diagnostics;
  /// Every name that the job gives, by NameKind; those of entries with mistakes too, so that one
  /// mistake is one complaint. Objects: those of the top level.
  std::array<std::vector<std::string>, 4> given;
  std::vector<NameUse> names;
  std::vector<FileUse> files;
  std::vector<ExpressionUse> expressions;
  /// Display name of an included file -> its path relative to the job's folder.
  std::map<std::string, std::string> included;
  std::set<JobKey>* listing = nullptr;  ///< set: only collect which keys the readers know

  /// Adds a complaint, once (a node that `like:` or an alias shares is read several times).
  void complain(const SourceLocation& where, const std::string& message);

  /// Counts `nodes` against the budget of one job (`like:` and aliases multiply what a short text
  /// makes us read). False, after one complaint, once it is spent.
  bool spend(uint64_t nodes, const SourceLocation& where);

  /// `reference` as written at `where`, made relative to the job's folder.
  std::string job_relative(const std::string& reference, const SourceLocation& where) const;

 private:
  std::set<std::string> complaints_;
  uint64_t spent_ = 0;
  bool exhausted_ = false;
};

}  // namespace hyades::core
