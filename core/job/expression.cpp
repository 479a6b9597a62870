#include "core/job/expression.h"

#include <muParserBase.h>

#include <charconv>
#include <cmath>
#include <cstddef>
#include <system_error>
#include <utility>
#include <vector>

#include "core/base/mutex.h"
#include "core/base/text.h"
#include "core/job/expression_functions.h"

namespace hyades::core {

namespace {

constexpr size_t kMaxLength = 1000;
constexpr const char* kLetters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_";
constexpr const char* kNameChars =
    "0123456789_abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ";

struct Function1 {
  const char* name;
  double (*function)(double);
};
struct Function2 {
  const char* name;
  double (*function)(double, double);
};
struct Function3 {
  const char* name;
  double (*function)(double, double, double);
};

const Function1 kFunctions1[] = {
    {"sin", expression::sin},
    {"cos", expression::cos},
    {"tan", expression::tan},
    {"asin", expression::asin},
    {"acos", expression::acos},
    {"atan", expression::atan},
    {"exp", expression::exp},
    {"log", expression::log},
    {"sqrt", [](double x) { return std::sqrt(x); }},
    {"abs", [](double x) { return std::abs(x); }},
    {"floor", [](double x) { return std::floor(x); }},
    {"ceil", [](double x) { return std::ceil(x); }},
    {"round", expression::round},
    {"noise", expression::noise},
};

const Function2 kFunctions2[] = {
    {"atan2", expression::atan2},
    {"pow", expression::pow},
    {"mod", expression::mod},
    {"min", [](double a, double b) { return b < a ? b : a; }},
    {"max", [](double a, double b) { return b > a ? b : a; }},
};

const Function3 kFunctions3[] = {
    {"clamp", expression::clamp},
    {"lerp", expression::lerp},
    {"smoothstep", expression::smoothstep},
};

/// muParser with our own operators and functions only: its built-in ones call the C library, whose
/// bits differ between machines.
class Parser : public mu::ParserBase {
 public:
  Parser() {
    EnableBuiltInOprt(false);
    AddValIdent(read_number);
    InitCharSets();
    InitFun();
    InitConst();
    InitOprt();
  }

  void InitCharSets() override {
    DefineNameChars(kNameChars);
    DefineOprtChars("+-*/^<>=!&|");
    DefineInfixOprtChars("+-");
  }

  void InitFun() override {
    for (const auto& f : kFunctions1) DefineFun(f.name, f.function);
    for (const auto& f : kFunctions2) DefineFun(f.name, f.function);
    for (const auto& f : kFunctions3) DefineFun(f.name, f.function);
  }

  void InitConst() override {
    DefineConst("pi", 3.141592653589793238463);
    DefineConst("e", 2.718281828459045235360);
  }

  void InitOprt() override {
    DefineInfixOprt("-", [](double x) { return -x; });
    DefineInfixOprt("+", [](double x) { return x; });
    DefineOprt(
        "||", [](double a, double b) { return truth(a != 0.0 || b != 0.0); }, mu::prLOR);
    DefineOprt(
        "&&", [](double a, double b) { return truth(a != 0.0 && b != 0.0); }, mu::prLAND);
    DefineOprt(
        "<", [](double a, double b) { return truth(a < b); }, mu::prCMP);
    DefineOprt(
        ">", [](double a, double b) { return truth(a > b); }, mu::prCMP);
    DefineOprt(
        "<=", [](double a, double b) { return truth(a <= b); }, mu::prCMP);
    DefineOprt(
        ">=", [](double a, double b) { return truth(a >= b); }, mu::prCMP);
    DefineOprt(
        "==", [](double a, double b) { return truth(a == b); }, mu::prCMP);
    DefineOprt(
        "!=", [](double a, double b) { return truth(a != b); }, mu::prCMP);
    DefineOprt(
        "+", [](double a, double b) { return a + b; }, mu::prADD_SUB);
    DefineOprt(
        "-", [](double a, double b) { return a - b; }, mu::prADD_SUB);
    DefineOprt(
        "*", [](double a, double b) { return a * b; }, mu::prMUL_DIV);
    DefineOprt(
        "/", [](double a, double b) { return a / b; }, mu::prMUL_DIV);
    DefineOprt("^", expression::pow, mu::prPOW, mu::oaRIGHT);
  }

 private:
  static double truth(bool value) { return value ? 1.0 : 0.0; }

  /// Reads a number without looking at the locale.
  static int read_number(const mu::char_type* text, int* position, mu::value_type* value) {
    const bool digit = *text >= '0' && *text <= '9';
    if (!digit && *text != '.') return 0;
    const char* end = text + std::char_traits<char>::length(text);
    const auto result = std::from_chars(text, end, *value);
    if (result.ec != std::errc{}) return 0;
    *position += static_cast<int>(result.ptr - text);
    return 1;
  }
};

class CompiledExpression : public Expression {
 public:
  explicit CompiledExpression(std::string text) : text_(std::move(text)) {
    parser_.DefineVar("t", &seconds_);
    parser_.DefineVar("frame", &frame_);
    parser_.SetExpr(text_);
  }

  /// Throws mu::ParserError where the text does not compile.
  void compile() {
    const MutexLock lock(mutex_);
    parser_.Eval();
    if (parser_.GetNumResults() != 1) {
      throw mu::ParserError(mu::ecUNEXPECTED_ARG_SEP, static_cast<int>(text_.find(',')), ",");
    }
  }

  double evaluate(const JobTime& time) const override {
    // muParser computes on a stack inside the parser.
    const MutexLock lock(mutex_);
    seconds_ = time.seconds;
    frame_ = time.frame;
    return parser_.Eval();
  }

  const std::string& text() const override { return text_; }

 private:
  std::string text_;
  mutable Mutex mutex_;
  mutable double seconds_ HYADES_GUARDED_BY(mutex_) = 0.0;
  mutable double frame_ HYADES_GUARDED_BY(mutex_) = 1.0;
  Parser parser_ HYADES_GUARDED_BY(mutex_);
};

std::vector<std::string> known_names() {
  std::vector<std::string> names = {"t", "frame", "pi", "e"};
  for (const auto& f : kFunctions1) names.emplace_back(f.name);
  for (const auto& f : kFunctions2) names.emplace_back(f.name);
  for (const auto& f : kFunctions3) names.emplace_back(f.name);
  return names;
}

std::string explain(const mu::ParserError& error, const std::string& text) {
  const std::string token = error.GetToken().substr(0, 60);
  if (error.GetCode() == mu::ecUNASSIGNABLE_TOKEN && !token.empty() &&
      std::string(kLetters).find(token[0]) != std::string::npos) {
    const std::vector<std::string> names = known_names();
    const std::string hint = did_you_mean(token, names);
    return "unknown name '" + token + "' in the expression" +
           (hint.empty() ? "; known are " + join_names(names) : hint);
  }
  const int position = error.GetPos();
  std::string message = "the expression does not compile";
  if (position >= 0 && position < static_cast<int>(text.size())) {
    message += " at '" + text.substr(static_cast<size_t>(position), 20) + "'";
  }
  return message + ": " + error.GetMsg();
}

}  // namespace

Result<std::shared_ptr<const Expression>> compile_expression(const std::string& text) {
  if (text.size() > kMaxLength) {
    return Error{"an expression of " + std::to_string(text.size()) + " characters; at most " +
                 std::to_string(kMaxLength) + " are allowed"};
  }
  const std::string allowed = std::string(kNameChars) + " .+-*/^()<>=!&|?:,";
  const size_t bad = text.find_first_not_of(allowed);
  if (bad != std::string::npos) {
    return Error{"the expression holds '" + text.substr(bad, 1) +
                 "', which means nothing there (arithmetic of t and frame is expected)"};
  }
  if (text.find_first_not_of(' ') == std::string::npos) {
    return Error{"an empty expression; expected something like \"= 30 * t\""};
  }
  auto compiled = std::make_shared<CompiledExpression>(text);
  try {
    compiled->compile();
  } catch (const mu::ParserError& error) {
    return Error{explain(error, text)};
  }
  return std::shared_ptr<const Expression>(std::move(compiled));
}

}  // namespace hyades::core
