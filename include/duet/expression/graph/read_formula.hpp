// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/core/text/number_text.hpp>
#include <duet/core/text/printable.hpp>
#include <duet/expression/graph/formula_grammar.hpp>
#include <duet/expression/graph/formula_graph.hpp>
#include <duet/expression/graph/graph.hpp>
#include <duet/expression/graph/graph_text.hpp>
#include <duet/expression/graph/recorded.hpp>
#include <duet/expression/tree/number.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/norm.hpp>
#include <duet/quaternion/rotation.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <variant>
#include <vector>

/// \file
/// Formulas from text, at run time. The text may be untrusted.

namespace duet::expression {

/// Options of `read_formula`.
struct read_options {
  std::vector<std::string> scalars = {};   ///< names of scalar inputs, the first of the formula
  std::vector<std::string> vectors = {};   ///< names of vector inputs, which follow
  std::vector<std::string> rotations = {}; ///< names of quaternion inputs, which follow
  /// True if decimals such as 0.1 and pi shall be exact over scalars of more digits than double:
  /// they become 1/10 and acos(-1). In double their values are the same.
  bool exact_constants = false;
  int max_nodes = 100'000; ///< a formula of more operations is rejected
};

namespace detail {

/// A scalar, vector, rotation or condition of a formula that is being read.
using read_value =
    std::variant<recorded, vector3<recorded>, quaternion<recorded>, recorded_condition>;

/// A rotation as such a value. (By conversion it could also become a matrix, which is an error.)
[[nodiscard]] inline read_value rotation_value(const quaternion<recorded>& q) {
  return read_value(std::in_place_type<quaternion<recorded>>, q);
}

/// s, v, q or c for the kind of a value.
[[nodiscard]] inline char kind_letter(const read_value& x) { return "svqc"[x.index()]; }
/// "a scalar and a vector" of "sv", "two scalars" of "ss".
[[nodiscard]] inline std::string kinds_text(std::string_view kinds) {
  const auto name = [](char k) {
    return std::string(k == 's'   ? "scalar"
                       : k == 'v' ? "vector"
                       : k == 'q' ? "rotation"
                                  : "condition");
  };
  const bool are_equal = kinds.find_first_not_of(kinds[0]) == std::string_view::npos;
  if (kinds.size() > 1 && are_equal) {
    constexpr std::array<const char*, 3> words{"two", "three", "four"};
    const std::string count =
        kinds.size() - 2 < words.size() ? words[kinds.size() - 2] : std::to_string(kinds.size());
    return count + " " + name(kinds[0]) + "s";
  }
  std::string text;
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    text += i == 0 ? "" : i + 1 == kinds.size() ? " and " : ", ";
    text += "a " + name(kinds[i]);
    constexpr std::size_t max_shown = 6;
    if (i + 1 == max_shown && kinds.size() > max_shown + 1) {
      return text + " and more";
    }
  }
  return text;
}

/// The kinds of arguments that an operation takes, except functions of scalars alone.
struct signature {
  std::string_view name, kinds;
};
inline constexpr std::array signatures{
    signature{"+", "ss"},
    signature{"+", "vv"},
    signature{"+", "qq"},
    signature{"-", "ss"},
    signature{"-", "vv"},
    signature{"-", "qq"},
    signature{"*", "ss"},
    signature{"*", "sv"},
    signature{"*", "vs"},
    signature{"*", "sq"},
    signature{"*", "qs"},
    signature{"*", "qq"},
    signature{"/", "ss"},
    signature{"/", "vs"},
    signature{"/", "qs"},
    signature{"^", "ss"},
    signature{"negative", "s"},
    signature{"negative", "v"},
    signature{"negative", "q"},
    signature{"[]", "sss"},
    signature{"<", "ss"},
    signature{"<=", "ss"},
    signature{">", "ss"},
    signature{">=", "ss"},
    signature{"==", "ss"},
    signature{"!=", "ss"},
    signature{"&&", "cc"},
    signature{"||", "cc"},
    signature{"!", "c"},
    signature{"isfinite", "s"},
    signature{"isnan", "s"},
    signature{"signbit", "s"},
    signature{"select", "css"},
    signature{"select", "cvv"},
    signature{"select", "cqq"},
    signature{"min", "ss"},
    signature{"max", "ss"},
    signature{"hypot", "sss"},
    signature{"dot", "vv"},
    signature{"cross", "vv"},
    signature{"norm", "v"},
    signature{"norm", "q"},
    signature{"normalized", "v"},
    signature{"normalized", "q"},
    signature{"conj", "q"},
    signature{"inverse", "q"},
    signature{"rotate", "qv"},
    signature{"exp", "v"},
    signature{"exp", "q"},
    signature{"log", "q"},
    signature{"slerp", "qqs"},
    signature{"vec", "q"},
    signature{"quaternion", "ssss"},
};

/// The function of scalars that has the name, or `number`.
[[nodiscard]] constexpr operation scalar_function(std::string_view name) {
  if (name == "ln" || name == "fabs") {
    return name == "ln" ? operation::log : operation::abs;
  }
  for (operation o = operation::sqrt; o <= operation::fma; o = operation(int(o) + 1)) {
    if (name == function_name_of(o) && o != operation::stumpff) {
      return o;
    }
  }
  return operation::number;
}

/// The index n of a function stumpff<n>, which texts of formulas have; −1 of another name.
[[nodiscard]] constexpr int stumpff_index(std::string_view name) {
  constexpr std::string_view begin = "stumpff";
  constexpr int max_index = 23;
  const std::size_t digits = name.size() - std::min(name.size(), begin.size());
  if (!name.starts_with(begin) || digits < 1 || digits > 2) {
    return -1;
  }
  int index = 0;
  for (const char c : name.substr(begin.size())) {
    index = is_digit(c) && index <= max_index ? 10 * index + (c - '0') : max_index + 1;
  }
  return index <= max_index ? index : -1;
}

[[nodiscard]] constexpr bool is_operation_name(std::string_view name) {
  bool found = scalar_function(name) != operation::number || stumpff_index(name) >= 0;
  for (const signature& s : signatures) {
    found = found || s.name == name;
  }
  return found;
}

/// Builds a formula of what `formula_grammar` reads, over a stack of values. Scalar operations on
/// numbers alone are recorded, too, unless their result is exact: the formula may be evaluated over
/// scalars of more digits.
class formula_builder {
public:
  explicit formula_builder(const read_options& options) : options_(options) {
    for (const std::string& name : options.scalars) {
      static_cast<void>(add_input(name, 's'));
    }
    for (const std::string& name : options.vectors) {
      static_cast<void>(add_input(name, 'v'));
    }
    for (const std::string& name : options.rotations) {
      static_cast<void>(add_input(name, 'q'));
    }
  }

  /// Reads a text; several texts share their inputs and operations.
  void read(std::string_view text) {
    text_ = text;
    formula_grammar<formula_builder>(text, *this).read();
    const bool is_single = outputs_.size() == 1;
    for (std::size_t i = 0; i < outputs_.size(); ++i) {
      named_value& y = outputs_[i];
      if (y.name.empty()) {
        y.name = is_single ? "y" : "y" + std::to_string(i + 1);
      }
    }
  }
  /// The outputs of the text that was read last.
  [[nodiscard]] std::vector<named_value> take_outputs() {
    return std::exchange(outputs_, std::vector<named_value>());
  }
  /// The formula, as yet without outputs. Its values live in it, so that it must not be moved
  /// before the last text is read.
  [[nodiscard]] formula_graph& formula() { return formula_; }

  // What the grammar calls.

  void number(std::string_view digits, std::size_t at) {
    double x = 0;
    if (duet::detail::read_number(digits, x) != std::errc()) {
      fail(at, "the number " + shown(digits) + " is beyond the range of double");
    }
    push(options_.exact_constants ? exact(digits, x) : recorded(x), at);
  }
  void name(std::string_view name, std::size_t at) {
    if (const auto found = values_.find(name); found != values_.end()) {
      return push(found->second, at);
    }
    if (name == "pi") {
      graph& g = formula_.operations();
      const double pi = 3.14159265358979323846;
      return push(options_.exact_constants ? recorded(g, g.apply(operation::acos, g.number(-1)))
                                           : recorded(pi),
                  at);
    }
    if (name == "inf") {
      return push(recorded(std::numeric_limits<double>::infinity()), at);
    }
    require_variable_name(name, at);
    push(add_input(std::string(name), 's'), at);
  }
  void apply(std::string_view what, int count, std::size_t at) {
    const std::size_t first = stack_.size() - std::size_t(count);
    const std::vector<read_value> x(stack_.begin() + std::ptrdiff_t(first), stack_.end());
    stack_.resize(first, read_value(recorded(0)));
    push(result(what, x, at), at);
  }
  void component(int i, std::size_t at) {
    const read_value x = stack_.back();
    stack_.pop_back();
    const auto require_below = [&](int size) {
      if (i >= size) {
        fail(at, "the index " + std::to_string(i) + " is beyond the " + std::to_string(size) +
                     " numbers of " + kinds_text(std::string(1, kind_letter(x))));
      }
    };
    if (const auto* v = std::get_if<vector3<recorded>>(&x)) {
      require_below(3);
      push((*v)[i], at);
    } else if (const auto* q = std::get_if<quaternion<recorded>>(&x)) {
      require_below(4);
      push(std::array{q->w(), q->x(), q->y(), q->z()}[std::size_t(i)], at);
    } else {
      fail(at, "[" + std::to_string(i) + "] takes a vector or rotation, got " +
                   kinds_text(std::string(1, kind_letter(x))));
    }
  }
  void declare(std::string_view kind, std::string_view name, std::size_t at) {
    require_new(name, at);
    static_cast<void>(add_input(std::string(name), kind == "rotation" ? 'q' : kind[0]));
  }
  void assign(std::string_view name, std::size_t at) {
    require_new(name, at);
    values_.emplace(std::string(name), stack_.back());
    stack_.pop_back();
  }
  void output(std::string_view name, std::size_t at) {
    const read_value x = stack_.back();
    stack_.pop_back();
    named_value y{.name = std::string(name)};
    graph& g = formula_.operations();
    if (const auto* s = std::get_if<recorded>(&x)) {
      y.nodes = {s->node_in(g)};
    } else if (const auto* v = std::get_if<vector3<recorded>>(&x)) {
      y.kind = shape::matrix;
      y.nodes = {(*v)[0].node_in(g), (*v)[1].node_in(g), (*v)[2].node_in(g)};
    } else if (const auto* q = std::get_if<quaternion<recorded>>(&x)) {
      y.kind = shape::quaternion;
      y.nodes = {q->w().node_in(g), q->x().node_in(g), q->y().node_in(g), q->z().node_in(g)};
    } else {
      fail(at, "the formula is a condition (expected a scalar, vector or rotation)");
    }
    y.rows = int(y.nodes.size());
    for (const named_value& other : outputs_) {
      if (!name.empty() && other.name == name) {
        fail(at, "there are two outputs " + shown(name));
      }
    }
    outputs_.push_back(std::move(y));
  }

private:
  [[nodiscard]] static std::string shown(std::string_view text) {
    constexpr std::size_t max_shown = 40;
    return "'" + duet::printable(text.substr(0, max_shown)) +
           (text.size() > max_shown ? "...'" : "'");
  }
  [[noreturn]] void fail(std::size_t at, const std::string& problem) const {
    duet::detail::raise(invalid_input(
        duet::detail::message("duet: read_formula: column ", column_of(text_, at), ": ", problem)));
  }
  void require_variable_name(std::string_view name, std::size_t at) const {
    if (is_operation_name(name)) {
      fail(at, shown(name) + " is a function (expected a name of another kind, or '(' behind it)");
    }
  }
  void require_new(std::string_view name, std::size_t at) const {
    require_variable_name(name, at);
    if (name == "pi" || name == "inf") {
      fail(at, shown(name) + " is a constant");
    }
    if (values_.contains(name)) {
      fail(at, shown(name) + " has a meaning already");
    }
  }
  [[nodiscard]] const read_value& add_input(const std::string& name, char kind) {
    graph& g = formula_.operations();
    const int size = kind == 's' ? 1 : kind == 'v' ? 3 : 4;
    const std::vector<int> n = formula_
                                   .add_input({.name = name,
                                               .kind = kind == 's'   ? shape::scalar
                                                       : kind == 'v' ? shape::matrix
                                                                     : shape::quaternion,
                                               .rows = size})
                                   .nodes;
    read_value x = recorded(g, n[0]);
    if (kind == 'v') {
      x = vector3<recorded>(recorded(g, n[0]), recorded(g, n[1]), recorded(g, n[2]));
    } else if (kind == 'q') {
      x = rotation_value(
          {recorded(g, n[0]), recorded(g, n[1]), recorded(g, n[2]), recorded(g, n[3])});
    }
    return values_.emplace(name, std::move(x)).first->second;
  }
  void push(read_value x, std::size_t at) {
    if (formula_.operations().size() > options_.max_nodes) {
      fail(at, "the formula has more than " + std::to_string(options_.max_nodes) + " operations");
    }
    stack_.push_back(std::move(x));
  }

  /// The number x that some digits spell, as a quotient by a power of ten if it was rounded.
  [[nodiscard]] recorded exact(std::string_view digits, double x) {
    std::string whole;
    int exponent = 0;
    const std::size_t e = std::min(digits.find_first_of("eE"), digits.size());
    const std::size_t point = digits.substr(0, e).find('.');
    for (const char c : digits.substr(0, e)) {
      whole += c == '.' ? "" : std::string(1, c);
    }
    if (point != std::string_view::npos) {
      exponent -= int(e - point - 1);
    }
    if (e < digits.size()) {
      double written = 0;
      static_cast<void>(duet::detail::read_number(digits.substr(e + 1), written));
      exponent += int(std::clamp(written, -1000.0, 1000.0));
    }
    while (whole.size() > 1 && whole.back() == '0') {
      whole.pop_back();
      ++exponent;
    }
    constexpr int max_exponent = 22; // 10^22 is a double
    double mantissa = 0, power_of_ten = 1;
    const std::size_t leading = std::min(whole.find_first_not_of('0'), whole.size());
    constexpr std::size_t max_digits = 15;
    if (exponent >= 0 || exponent < -max_exponent || whole.size() - leading > max_digits ||
        duet::detail::read_number(whole, mantissa) != std::errc()) {
      return x;
    }
    for (int k = 0; k < -exponent; ++k) {
      power_of_ten *= 10;
    }
    graph& g = formula_.operations();
    return {g, g.apply(operation::quotient, g.number(mantissa), g.number(power_of_ten))};
  }

  // Scalars.

  [[nodiscard]] recorded of(operation what, const recorded& a) {
    graph& g = formula_.operations();
    return {g, g.apply(what, a.node_in(g))};
  }
  [[nodiscard]] recorded of(operation what, const recorded& a, const recorded& b) {
    graph& g = formula_.operations();
    const int first = a.node_in(g);
    return {g, g.apply(what, first, b.node_in(g))};
  }
  [[nodiscard]] recorded power(const recorded& x, const recorded& p) {
    constexpr double max_index = 16, max_exact = 0x1p53;
    graph& g = formula_.operations();
    const bool is_index = p.is_constant() && std::abs(p.number()) <= max_index &&
                          std::trunc(p.number()) == p.number();
    if (!is_index) {
      return of(operation::pow, x, p);
    }
    if (x.is_constant() && std::trunc(x.number()) == x.number() && p.number() > 0) {
      const double y = std::pow(x.number(), p.number());
      if (std::abs(y) < max_exact) {
        return y;
      }
    }
    const int n = int(p.number());
    return n == 0 ? recorded(1) : recorded(g, g.apply(operation::power, x.node_in(g), -1, -1, n));
  }

  // Vectors and rotations.

  /// The numbers of an object, of which one at least is no constant, so that functions of it are
  /// recorded and not rounded.
  template <class X>
  [[nodiscard]] X unfolded(const X& x) {
    bool is_constant = true;
    static_cast<void>(map_scalars(
        [&](const recorded& s) {
          is_constant = is_constant && s.is_constant();
          return s;
        },
        x));
    return !is_constant ? x
                        : map_scalars(
                              [&](const recorded& s) {
                                return s.number() < 0 ? -of(operation::abs, recorded(-s.number()))
                                                      : of(operation::abs, s);
                              },
                              x);
  }
  /// The operation with a scalar or an equal object, by number.
  template <class X>
  [[nodiscard]] X by_number(operation what, const X& a, const X& b) {
    return map_scalars([&](const recorded& s, const recorded& t) { return of(what, s, t); }, a, b);
  }
  template <class X>
  [[nodiscard]] X by_number(operation what, const X& a, const recorded& b) {
    return map_scalars([&](const recorded& s) { return of(what, s, b); }, a);
  }
  template <class X>
  [[nodiscard]] X chosen(const recorded_condition& c, const X& a, const X& b) {
    return duet::select(
        c, [&] { return a; }, [&] { return b; });
  }

  [[nodiscard]] read_value result(std::string_view what, const std::vector<read_value>& x,
                                  std::size_t at) {
    std::string kinds;
    for (const read_value& each : x) {
      kinds += kind_letter(each);
    }
    const operation function = scalar_function(what);
    if (function != operation::number &&
        kinds == std::string(std::size_t(operand_count(function)), 's')) {
      return scalar_result(function, x);
    }
    const int index = stumpff_index(what);
    if (index >= 0 && kinds == "s") {
      graph& g = formula_.operations();
      const int s = std::get<recorded>(x[0]).node_in(g);
      return recorded(g, g.apply(operation::stumpff, s, -1, -1, index));
    }
    std::string expected;
    bool fits = false;
    if (function != operation::number || index >= 0) {
      const int count = function != operation::number ? operand_count(function) : 1;
      expected = kinds_text(std::string(std::size_t(count), 's'));
    }
    if (what == "select") {
      expected = "a condition and two values of one kind";
    }
    for (const signature& s : signatures) {
      if (s.name == what) {
        if (what != "select") {
          expected += (expected.empty() ? "" : ", or ") + kinds_text(s.kinds);
        }
        fits = fits || s.kinds == kinds;
      }
    }
    if (expected.empty()) {
      fail(at, "there is no function " + shown(what));
    }
    if (!fits) {
      fail(at, (what == "negative" ? "the sign -"
                : what == "[]"     ? "[...]"
                                   : std::string(what)) +
                   " takes " + expected + ", got " + kinds_text(kinds));
    }
    return kinds.find('q') != std::string::npos || what == "quaternion" ||
                   (what == "exp" && kinds == "v")
               ? rotation_result(what, x)
           : kinds.find('v') != std::string::npos ? vector_result(what, x)
                                                  : other_result(what, x);
  }
  [[nodiscard]] read_value scalar_result(operation function, const std::vector<read_value>& x) {
    const recorded& a = std::get<recorded>(x[0]);
    if (function == operation::fma) {
      graph& g = formula_.operations();
      const int first = a.node_in(g), second = std::get<recorded>(x[1]).node_in(g);
      return recorded(g, g.apply(function, first, second, std::get<recorded>(x[2]).node_in(g)));
    }
    if (function == operation::pow) {
      return power(a, std::get<recorded>(x[1]));
    }
    return x.size() == 2 ? of(function, a, std::get<recorded>(x[1])) : of(function, a);
  }
  /// Operators of scalars and conditions, and functions of them that are no node.
  [[nodiscard]] read_value other_result(std::string_view what, const std::vector<read_value>& x) {
    if (what == "!") {
      return !std::get<recorded_condition>(x[0]);
    }
    if (what == "&&" || what == "||") {
      const auto &a = std::get<recorded_condition>(x[0]), &b = std::get<recorded_condition>(x[1]);
      return what == "&&" ? a && b : a || b;
    }
    if (what == "select") {
      return chosen(std::get<recorded_condition>(x[0]), std::get<recorded>(x[1]),
                    std::get<recorded>(x[2]));
    }
    const recorded& a = std::get<recorded>(x[0]);
    if (what == "negative") {
      return of(operation::negative, a);
    }
    if (what == "isfinite" || what == "isnan" || what == "signbit") {
      return what == "isfinite" ? isfinite(a) : what == "isnan" ? isnan(a) : signbit(a);
    }
    const recorded& b = std::get<recorded>(x[1]);
    if (what == "hypot") {
      return of(operation::hypot, of(operation::hypot, a, b), std::get<recorded>(x[2]));
    }
    if (what == "[]") {
      return vector3<recorded>(a, b, std::get<recorded>(x[2]));
    }
    if (what == "min" || what == "max") {
      return what == "min" ? min(a, b) : max(a, b);
    }
    switch (what[0]) {
    case '+':
      return of(operation::sum, a, b);
    case '-':
      return of(operation::difference, a, b);
    case '*':
      return of(operation::product, a, b);
    case '/':
      return of(operation::quotient, a, b);
    case '^':
      return power(a, b);
    case '<':
      return what == "<" ? a < b : a <= b;
    case '>':
      return what == ">" ? a > b : a >= b;
    default:
      return what == "==" ? a == b : a != b;
    }
  }
  /// Operators that vectors and rotations have in common.
  template <class X>
  [[nodiscard]] X linear_result(std::string_view what, const std::vector<read_value>& x) {
    if (what == "select") {
      return chosen(std::get<recorded_condition>(x[0]), std::get<X>(x[1]), std::get<X>(x[2]));
    }
    if (what == "negative") {
      return map_scalars([&](const recorded& s) { return of(operation::negative, s); },
                         std::get<X>(x[0]));
    }
    if (what == "*" || what == "/") {
      const bool is_first_scalar = kind_letter(x[0]) == 's';
      return by_number(what == "*" ? operation::product : operation::quotient,
                       std::get<X>(x[is_first_scalar]), std::get<recorded>(x[!is_first_scalar]));
    }
    return by_number(what == "+" ? operation::sum : operation::difference, std::get<X>(x[0]),
                     std::get<X>(x[1]));
  }
  [[nodiscard]] read_value vector_result(std::string_view what, const std::vector<read_value>& x) {
    using vector = vector3<recorded>;
    if (what == "norm" || what == "normalized") {
      const vector v = unfolded(std::get<vector>(x[0]));
      const recorded length = of(operation::sqrt, v.dot(v));
      return what == "norm" ? read_value(length)
                            : read_value(by_number(operation::quotient, v, length));
    }
    if (what == "dot" || what == "cross") {
      const vector &a = std::get<vector>(x[0]), &b = std::get<vector>(x[1]);
      return what == "dot" ? read_value(recorded(a.dot(b))) : read_value(vector(a.cross(b)));
    }
    return linear_result<vector>(what, x);
  }
  [[nodiscard]] read_value rotation_result(std::string_view what,
                                           const std::vector<read_value>& x) {
    using vector = vector3<recorded>;
    using rotation = quaternion<recorded>;
    if (what == "quaternion") {
      return rotation_value({std::get<recorded>(x[0]), std::get<recorded>(x[1]),
                             std::get<recorded>(x[2]), std::get<recorded>(x[3])});
    }
    if (what == "exp") {
      return rotation_value(kind_letter(x[0]) == 'v'
                                ? duet::exp(unfolded(std::get<vector>(x[0])))
                                : duet::exp(unfolded(std::get<rotation>(x[0]))));
    }
    const bool is_product = what == "*" && x[0].index() == x[1].index();
    const bool is_linear =
        what == "select" || what == "negative" ||
        (!is_product && std::string_view("+-*/").find(what) != std::string_view::npos);
    if (is_linear) {
      return rotation_value(linear_result<rotation>(what, x));
    }
    const rotation& q = std::get<rotation>(x[0]);
    if (what == "rotate") {
      return vector(duet::rotate(q, std::get<vector>(x[1])));
    }
    if (what == "vec") {
      return vector(q.x(), q.y(), q.z());
    }
    if (what == "norm") {
      return duet::norm(unfolded(q));
    }
    return rotation_value(
        is_product ? q * std::get<rotation>(x[1])
        : what == "slerp"
            ? duet::slerp(unfolded(q), unfolded(std::get<rotation>(x[1])), std::get<recorded>(x[2]))
        : what == "conj"    ? conj(q)
        : what == "log"     ? duet::log(unfolded(q))
        : what == "inverse" ? duet::inverse(unfolded(q))
                            : duet::normalized(unfolded(q)));
  }

  read_options options_;
  formula_graph formula_;
  std::map<std::string, read_value, std::less<>> values_;
  std::vector<read_value> stack_;
  std::vector<named_value> outputs_;
  std::string_view text_;
};

} // namespace detail

/// The formula that a text spells, as in `exp(-u)*sin(2 u^2)`.
///
/// Operators are `+ - * /`, `^` or `**` for powers, with −x^2 = −(x^2) and 2^3^2 = 2^(3^2),
/// products of a number and a name or parenthesis as in `2x`; functions those of `<cmath>`, `ln`,
/// `min`, `max` and `select(condition, f, g)`, with `< <= > >= == != && || !` in conditions; `pi`
/// and `inf` are constants. Other names are scalar inputs, in the order of their appearance.
/// Vectors are
/// `[a, b, c]` and inputs declared by `vector v, w;` in front, with `dot`, `cross`, `norm`,
/// `normalized` and numbers `v[0]`; rotations are inputs declared by `rotation q;` and
/// `quaternion(w, x, y, z)`, with `q*p`, `conj`, `inverse`, `exp` (of half the rotation vector),
/// `log`, `rotate(q, v)`, `slerp(q, p, t)`, `vec` and numbers `q[0]` to `q[3]`. Before the formula
/// names may be given to parts of it: `t = u^2; sin(t) + t`. The outputs, separated by commas, may
/// have names: `value = u^2, slope = 2u`.
///
/// The text may be untrusted: it has at most 64 kB, is nested at most 200 deep, and becomes at most
/// `options.max_nodes` operations.
/// \throws invalid_input with the column, what was expected there, and what was found
[[nodiscard]] inline formula_graph read_formula(std::string_view text,
                                                const read_options& options = {}) {
  detail::formula_builder builder(options);
  builder.read(text);
  std::vector<named_value> outputs = builder.take_outputs();
  formula_graph f = std::move(builder.formula());
  for (named_value& y : outputs) {
    f.add_output(std::move(y));
  }
  return f;
}

} // namespace duet::expression
