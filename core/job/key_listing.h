#pragma once

#include <string>
#include <vector>

#include "core/job/animated.h"
#include "core/job/inputs.h"
#include "core/job/job_keys.h"
#include "core/job/value_checks.h"

namespace hyades::core {

/// What a key of a job takes.
struct KeyFacts {
  std::string takes{};               ///< "number", "colour or texture", ...; empty: nobody says it
  std::string start{};               ///< what holds without the key, as JSON; empty: nothing
  Range range{};                     ///< of numbers
  std::vector<std::string> names{};  ///< that it may be, where it is one of some
  std::string below{};               ///< section of the map that it takes
  bool required = false;
};

/// A key, whose it is, and what it takes.
struct ListedKey {
  std::string type;  ///< "materials.lambert", also of keys that all materials have; or the section
  JobKey id;
  KeyFacts facts;
};

/// Every key that the readers ask for with what they say of it, in the order of reading: they read
/// an empty job of every type.
std::vector<ListedKey> listed_job_keys();

/// What is collected while the readers read nothing.
class KeyListing {
 public:
  /// The facts of a key, which is new or was asked for before.
  KeyFacts& at(const std::string& type, const JobKey& id);

  const std::vector<ListedKey>& keys() const { return keys_; }

 private:
  std::vector<ListedKey> keys_;
};

/// Values as JSON.
std::string json_of(float value);
std::string json_of(const std::string& text);
std::string json_of(bool value);
std::string json_of(const Animated<float>& value);
std::string json_of(const Animated<Vec2>& value);
std::string json_of(const Animated<Vec3>& value);
/// A number where its channels are the same.
std::string json_of_color(const Rgb& color);

}  // namespace hyades::core
