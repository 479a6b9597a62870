#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <mutex>

namespace hyades::core {

/// Tables of kind T(float eta) at fixed relative indices of refraction, each made when it is first
/// asked for, and places between them. They lie even in x, where (eta - 1) / (eta + 1) = x |x|: all
/// indices from 0 to infinity, close around 1, where the critical angle moves with the root of
/// eta - 1. Thread-safe.
template <class T>
class IndexTables {
 public:
  struct Between {
    const T* low;
    const T* high;
    float part;
  };

  static Between at(float eta) {
    const float ratio = (eta - 1.0F) / (eta + 1.0F);
    const float x = std::copysign(std::sqrt(std::fabs(ratio)), ratio);
    const float scaled = std::clamp(0.5F + 0.5F * x, 0.0F, 1.0F) * static_cast<float>(kTables - 1);
    const int node = std::min(static_cast<int>(scaled), kTables - 2);
    return {table(node), table(node + 1), scaled - static_cast<float>(node)};
  }

 private:
  static constexpr int kTables = 257;

  static float eta_of(int node) {
    const int from_middle = node - (kTables - 1) / 2;
    const float x = static_cast<float>(from_middle) / static_cast<float>((kTables - 1) / 2);
    const float ratio = x * std::fabs(x);
    return (1.0F + ratio) / (1.0F - ratio);
  }

  static const T* table(int node) {
    static std::array<std::once_flag, kTables> made;
    static std::array<std::unique_ptr<const T>, kTables> tables;
    std::call_once(made[node], [node] { tables[node] = std::make_unique<const T>(eta_of(node)); });
    return tables[node].get();
  }
};

}  // namespace hyades::core
