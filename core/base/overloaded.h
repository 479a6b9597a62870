#pragma once

namespace hyades::core {

/// Several functions as one, for std::visit: `std::visit(Overloaded{[](const A&) {...},
/// [](const B&) {...}}, variant)` does not compile where an alternative has no function.
template <class... Functions>
struct Overloaded : Functions... {
  using Functions::operator()...;
};
template <class... Functions>
Overloaded(Functions...) -> Overloaded<Functions...>;

}  // namespace hyades::core
