#pragma once

#include <string>
#include <vector>

namespace hyades::core {

/// The environment that this program gives to those of its own which read what strangers wrote:
/// what finds programs and libraries, tells of language, or is for tests. Not the rest, where
/// clouds, schedulers and people keep secrets. "NAME=value" each.
std::vector<std::string> own_environment();

/// Pointers to `strings` and a null at the end, as exec takes them. They live as long as `strings`.
std::vector<char*> for_exec(std::vector<std::string>& strings);

}  // namespace hyades::core
