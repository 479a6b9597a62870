#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/job/job_keys.h"

/// The keys of docs/job.md, and jobs in which each of them is tried.
namespace hyades::core {

struct DocumentedKey {
  JobKey id;
  std::string type;
  std::string default_value;  ///< YAML; empty where the page names none
  bool required = false;
  std::string example;  ///< YAML
  int line = 0;
};

/// All rows of the page; the working directory is the repository.
std::vector<DocumentedKey> read_page();

using Pairs = std::vector<std::pair<std::string, std::string>>;

/// A place in a job where the keys of one section are tried: `before` {pairs} `after`.
struct Place {
  std::string before;
  Pairs pairs;  ///< what must be there besides the key that is tried
  std::string after;
};
const std::map<std::string, Place>& places();

/// The text of a job in which the section of `id` holds `pairs`.
std::string job_text(const JobKey& id, const Pairs& pairs);

Pairs base_pairs(const JobKey& id);

/// The sample job as it is before the key is tried.
std::string sample_text(const JobKey& id);

/// What the sample job has with `value` for the key, or without the key, in place of whatever it
/// excludes.
Pairs pairs_with(const JobKey& id, const std::optional<std::string>& value);
std::string text_with(const JobKey& id, const std::optional<std::string>& value);

}  // namespace hyades::core
