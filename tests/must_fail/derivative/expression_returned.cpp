// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: a function returns an expression of Eigen

// Every driver rejects functions that return expressions: they refer to variables that are gone.

#include <duet/derivative/derivative.hpp>
#include <duet/derivative/gradient.hpp>
#include <duet/derivative/implicit_function.hpp>
#include <duet/derivative/tangent_coordinates.hpp>
#include <duet/quaternion/rotation.hpp>

#include <array>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

namespace {

const duet::quaternion<double> q(1);
const duet::vector3<double> t(1, 2, 3);
const duet::vector3<double> x(4, 5, 6);

#ifdef DUET_MUST_FAIL

// Each has a number, because compilers report an error for a type only once.
template <int>
struct of_scalar {
  auto operator()(const auto& s) const { return t * s; }
};
template <int>
struct moved {
  auto operator()(const auto& y) const { return duet::rotate(q, y) + t; }
};
template <int>
struct square {
  auto operator()(const auto& y) const { return y.transpose() * y; }
  auto operator()(const auto& y, const auto& z) const { return y.transpose() * z; }
};
template <int>
struct rotated {
  auto operator()(const auto& r) const { return duet::rotate(r, t) + t; }
};
template <int>
struct size {
  auto operator()(const auto& r) const { return t.transpose() * duet::rotate(r, t); }
};
template <int>
struct equations {
  auto operator()(const auto& y, const auto& p) const { return y * p - y; }
};

#endif

} // namespace

int main() {
  using namespace duet;
  vector3<double> g;
  matrix3<double> m;
#ifdef DUET_MUST_FAIL
  static_cast<void>(derivative(of_scalar<0>(), 1.0));                  // mistake
  static_cast<void>(derivatives<2>(of_scalar<1>(), 1.0));              // mistake
  static_cast<void>(directional_derivative(moved<0>(), x, t));         // mistake
  static_cast<void>(directional_derivative(of_scalar<2>(), 1.0, 2.0)); // mistake
  static_cast<void>(jacobian(moved<1>(), x));                          // mistake
  static_cast<void>(jacobian_into(moved<2>(), x, m));                  // mistake
  static_cast<void>(jacobian(rotated<0>(), q, frame::body));           // mistake
  static_cast<void>(gradient(square<0>(), x));                         // mistake
  static_cast<void>(gradient_into(square<1>(), x, g));                 // mistake
  static_cast<void>(gradient(size<0>(), q, frame::body));              // mistake
  static_cast<void>(hessian(square<2>(), x));                          // mistake
  static_cast<void>(hessian(size<1>(), q, frame::body));               // mistake
  static_cast<void>(hessian_vector_product(square<3>(), x, t));        // mistake
  static_cast<void>(mixed_hessian(square<4>(), x, t));                 // mistake
  static_cast<void>(implicit_solution(equations<0>(), x, 1.0));        // mistake
  static_cast<void>(implicit_function<1>(equations<1>(), x, 1.0));     // mistake
  // Parts of vectors, arrays, expressions inside containers, and tied references.
  static_cast<void>(jacobian([](const auto& y) { return y.template head<2>(); }, x)); // mistake
  static_cast<void>(jacobian([](const auto& y) { return (y + y).array(); }, x));      // mistake
  static_cast<void>(derivative([](auto s) { return std::tuple(s, t * s); }, 1.0));    // mistake
  static_cast<void>(derivative([](auto s) { return std::array{t * s}; }, 1.0));       // mistake
  static_cast<void>(derivative([](auto s) { return std::pair(t * s, s); }, 1.0));     // mistake
  static_cast<void>(derivative([](auto s) { return std::optional(t * s); }, 1.0));    // mistake
  static_cast<void>(derivative([](auto s) { return std::vector{t * s}; }, 1.0));      // mistake
  static_cast<void>(derivative(                                                       // mistake
      [](auto s) { return std::pair<const std::tuple<decltype(t * s)>, int>(t * s, 1); }, 1.0));
  static_cast<void>(derivative([](const auto& s) { return std::tie(s, s); }, 1.0)); // mistake
#else
  const auto moved = [](const auto& y) { return (rotate(q, y) + t).eval(); };
  const auto square = [](const auto& y) { return y.dot(y); };
  const auto equations = [](const auto& y, const auto& p) { return (y * p - y).eval(); };
  m = jacobian(moved, x).jacobian;
  g = gradient(square, x).gradient;
  static_cast<void>(directional_derivative(moved, x, t));
  static_cast<void>(implicit_solution(equations, x, 1.0));
#endif
}
