#!/usr/bin/env python3
"""cpp_functions finds the functions of code with all that C++ has around them."""

import os
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.realpath(__file__)))
import cpp_functions as cpp

CODE = r'''
#include <vector>
#define BRACES { (
namespace a::b {
namespace {
constexpr int kTable[] = {1, 2, 3};  // not a function() {
const auto kLambda = [](int x) { return x; };
enum class Kind { one, two };
struct alignas(16) Plain { int x{1}; int twice() const { return 2 * x; } };
template <class T, int n = 3>
class Box : public Plain {
 public:
  explicit Box(T t, std::vector<int> v = {1, 2}) : t_{t}, v_(v), text_("}") { v_.push_back(1); }
  ~Box() { v_.clear(); }
  bool operator()(int x) const noexcept { return x > '}' - 1'000; }
  bool operator==(const Box&) const { return true; }
 private:
  T t_;
};
}  // namespace
void Room::on(const First& e) { said = R"(})"; }
void Room::on(const Second& e) /* { */ { if (e.x) { said = "{"; } }
auto made(int x) -> std::vector<int> { return {x}; }
Room::Room(int x)
    : Plain{x}, y_(x) {
  y_ = x;
}
}  // namespace a::b
'''


def main():
    found = cpp.functions(CODE)
    names = [f.name for f in found]
    expected = ['twice', 'Box', '~Box', 'operator()', 'operator==', 'on', 'on', 'made', 'Room']
    assert names == expected, names
    bodies = {f.name: CODE[f.body:f.end].strip() for f in found}
    assert bodies['Box'] == 'v_.push_back(1);', bodies['Box']
    assert bodies['Room'] == 'y_ = x;', bodies['Room']
    assert bodies['twice'] == 'return 2 * x;', bodies['twice']
    assert [f.is_called('on(Second)') for f in found if f.name == 'on'] == [False, True]
    assert all(f.is_called(f.name) for f in found)
    # Spaces do not count, halves of words do.
    assert cpp.pattern('a.b(c, d)').search('a . b(c,\n   d)')
    assert not cpp.pattern('index').search('indexes')
    assert not cpp.pattern('return x').search('returnx')
    assert cpp.without_comments('a /* b */ "//" // c') == 'a         "//"     '


main()
