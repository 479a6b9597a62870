#pragma once

#include <google/protobuf/message.h>

#include <memory>
#include <random>
#include <string>

namespace hyades::test {

using Random = std::mt19937;

/// Random bytes, `most` at most.
std::string random_bytes(Random& random, size_t most);

/// A message of a generated type with random fields set; repeated ones a few times.
std::unique_ptr<google::protobuf::Message> random_message(Random& random,
                                                          const google::protobuf::Descriptor& type);

/// Some bytes of `bytes` changed, taken out, doubled or cut off.
std::string mutated(Random& random, std::string bytes);

}  // namespace hyades::test
