#pragma once

#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/finish/compare.h"

/// What compare.cpp and error_image.cpp share.
namespace hyades::core {

/// A channel of both pictures.
struct CommonChannel {
  std::string name;
  int a = -1;
  int b = -1;
  int variance_a = -1;  ///< beauty only; -1: none
  int variance_b = -1;
};

/// The channels of the layer that both pictures have; refuses pictures that cannot be compared.
Result<std::vector<CommonChannel>> common_channels(const Image& a, const Image& b,
                                                   const CompareOptions& options);

/// Whether all compared channels of a pixel are finite in both.
bool is_finite(const Image& a, const Image& b, const std::vector<CommonChannel>& channels, int x,
               int y);

}  // namespace hyades::core
