#pragma once

#include <cstdint>
#include <vector>

#include "core/samplers/sampler.h"

namespace hyades::core {

/// A stream of independent random numbers in [0, 1), a pure function of its key.
class NumberStream {
 public:
  explicit NumberStream(uint64_t key) : key_(key) {}
  float next();
  /// From the standard normal distribution.
  float next_normal();

 private:
  uint64_t key_;
  uint64_t count_ = 0;
};

/// The random numbers of one path as the state of a Markov chain: a point of the unit hypercube
/// that is mutated as a whole (large step) or a little (small step), and taken back where the
/// mutation is rejected (Kelemen, Szirmay-Kalos, Antal, Csonka 2002, "A Simple and Robust Mutation
/// Strategy for the Metropolis Light Transport Algorithm"). Coordinates exist once they have been
/// asked for and catch up with mutations when they are asked for again.
class PrimarySampler final : public Sampler {
 public:
  /// `key` decides the first state and all mutations.
  explicit PrimarySampler(uint64_t key) : stream_(key) {}

  /// Proposes another state: independent of the present one (large), or every coordinate moved by
  /// a normal distribution of standard deviation `sigma`, around the ends.
  void mutate(bool large, float sigma);
  void accept();
  void reject();

  /// Reads the (proposed) state again from dimension 0; the sample's name does not matter.
  void start(const SampleId&) override { dimension_ = 0; }
  void set_dimension(uint32_t dimension) override { dimension_ = dimension; }
  float next_1d() override { return value(dimension_++); }
  Vec2 next_2d() override;
  Vec4 next_4d() override;

 private:
  struct Coordinate {
    uint32_t dimension = 0;
    float value = 0.0F;
    uint64_t time = 0;  ///< the step up to which it is mutated
    float old_value = 0.0F;
    uint64_t old_time = 0;
  };

  float value(uint32_t dimension);
  Coordinate& find(uint32_t dimension);
  void grow();

  NumberStream stream_;
  std::vector<Coordinate> coordinates_;
  std::vector<uint32_t> table_;    ///< open addressing by dimension: index + 1; 0: free
  std::vector<uint32_t> changed_;  ///< by the proposal
  uint64_t now_ = 0;               ///< steps accepted, and the proposal
  uint64_t last_large_ = 0;
  uint64_t old_large_ = 0;
  float sigma_ = 0.0F;
  uint32_t dimension_ = 0;
};

}  // namespace hyades::core
