#include "import/pbrt/lens.h"

#include <vector>

#include "import/pbrt/read_parameters.h"

namespace hyades::core::pbrt {

Result<double> focal_length(std::string_view lens_file) {
  Tokenizer tokens(lens_file, {});
  std::vector<double> numbers;
  for (Token token = tokens.next(); token.kind != Token::Kind::end; token = tokens.next()) {
    const auto number = token.kind == Token::Kind::word ? number_of(token.text) : std::nullopt;
    if (!number) return Error{"the lens file holds something other than numbers"};
    numbers.push_back(*number);
  }
  if (numbers.empty() || numbers.size() % 4 != 0) {
    return Error{"the lens file has not four numbers for each element"};
  }
  // A ray parallel to the axis, one away from it.
  double height = 1.0;
  double slope = 0.0;
  double index = 1.0;
  for (size_t i = 0; i < numbers.size(); i += 4) {
    const double radius = numbers[i];
    if (radius != 0.0) {
      const double behind = numbers[i + 2] > 0.0 ? numbers[i + 2] : 1.0;
      slope = (index * slope - height * (behind - index) / radius) / behind;
      index = behind;
    }
    height += slope * numbers[i + 1];
  }
  if (!(slope < 0.0)) return Error{"the lens does not gather light"};
  return -1.0 / slope;
}

}  // namespace hyades::core::pbrt
