#pragma once

#include <algorithm>

#include "core/base/vec.h"

namespace hyades::core {

/// The probabilities with which a path's channels are chosen where a medium treats them
/// differently: in proportion to what each still carries. They add up to 1; equal where nothing is
/// carried.
inline Rgb channel_shares(const Rgb& throughput) {
  const float sum = throughput.x + throughput.y + throughput.z;
  return sum > 0.0F ? throughput / sum : Rgb(1.0F / 3.0F);
}

struct ChosenChannel {
  int index = 0;
  float rest = 0.0F;  ///< what `pick` leaves for another decision, in [0, 1)
};

/// The channel that `pick` in [0, 1) means, never one of share 0.
inline ChosenChannel choose_channel(const Rgb& shares, float pick) {
  float begin = 0.0F;
  int last = 0;
  for (int c = 0; c < 3; ++c) {
    if (!(shares[c] > 0.0F)) continue;
    last = c;
    if (pick < begin + shares[c]) {
      return {c, std::min((pick - begin) / shares[c], 0x1.fffffep-1F)};
    }
    begin += shares[c];
  }
  return {last, 0.5F};  // the shares add up to a little less than 1
}

}  // namespace hyades::core
