// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#pragma once

#include <duet/core/structure.hpp>
#include <duet/dual/eigen_traits.hpp>
#include <duet/dual/level.hpp>
#include <duet/dual/math.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/quaternion/rotation.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <cstddef>
#include <tuple>
#include <utility>
#include <vector>

// Functions of several arguments, each of them a constant or differentiated: constants mix with
// numbers that have derivatives, and count as numbers whose derivative is zero. Every layer has a
// test of all its functions of several arguments, mixed_arguments.cpp.

namespace test_support::mixed {

using namespace duet;

struct along;
using number = dual<double, 1, along>;

/// Moved numbers, one after the other: x + ε v with v a different one each time.
class direction {
public:
  double next() {
    angle_ += 2.399;
    return std::cos(angle_);
  }

private:
  double angle_ = 0.3;
};

inline number moved(double x, double v) { return {x, v}; }
template <Infinitesimal D>
auto moved(const D& x, const D& v) {
  return x.zip([](double a, double b) { return moved(a, b); }, v);
}

/// x moved, or the same with a derivative of zero, or x itself.
enum class kind { differentiated, zero, constant };

template <kind K, class X>
auto argument(const X& x, direction& values) {
  const auto some = [&](double) {
    const double v = values.next();
    return K == kind::differentiated ? v : 0.0;
  };
  const X v = map_scalars([&](const auto& s) { return detail::map_reals(s, some); }, x);
  if constexpr (K == kind::constant) {
    return x;
  } else {
    return map_scalars([](const auto& a, const auto& b) { return moved(a, b); }, x, v);
  }
}

/// All real numbers of a result, without its derivatives and then they.
template <class X>
std::vector<double> numbers(const X& x) {
  std::vector<double> result;
  const auto add = [&](const auto& s) {
    return detail::map_reals(s, [&](double r) {
      result.push_back(r);
      return r;
    });
  };
  for (const int part : {0, 1}) {
    static_cast<void>(map_scalars(add, detail::parts<along>(x, part)));
  }
  return result;
}

/// The arguments whose bit is set in `Mask` are differentiated, the others are of kind `Other`.
template <unsigned Mask, kind Other, class F, class... X>
std::vector<double> result(const F& f, const std::tuple<X...>& x) {
  return [&]<std::size_t... I>(std::index_sequence<I...>) {
    direction values;
    const std::tuple arguments{argument < ((Mask >> I) & 1U) != 0
                                   ? kind::differentiated
                                   : Other > (std::get<I>(x), values)...};
    return numbers(std::apply(f, arguments));
  }
  (std::index_sequence_for<X...>{});
}

template <unsigned Mask, class F, class... X>
void check_mask(const char* name, const F& f, const std::tuple<X...>& x) {
  const auto expected = result<Mask, kind::zero>(f, x);
  const auto got = result<Mask, kind::constant>(f, x);
  INFO(name << ", differentiated: " << Mask);
  REQUIRE(got.size() == expected.size());
  double sum = 0;
  for (std::size_t i = 0; i < got.size(); ++i) {
    CHECK(std::abs(got[i] - expected[i]) <= 1e-12 * (1 + std::abs(expected[i])));
    sum += i >= got.size() / 2 ? std::abs(got[i]) : 0;
  }
  CHECK(sum > 0); // it does depend on what is differentiated
}

/// Each argument differentiated alone, each constant alone, all and none.
template <class F, class... X>
void check(const char* name, const F& f, const X&... x) {
  constexpr unsigned all = (1U << sizeof...(X)) - 1;
  const std::tuple arguments(x...);
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    (check_mask<1U << I>(name, f, arguments), ...);
    if constexpr (sizeof...(X) > 2) {
      (check_mask<all - (1U << I)>(name, f, arguments), ...);
    }
  }
  (std::index_sequence_for<X...>{});
  check_mask<all>(name, f, arguments);
  static_cast<void>(std::apply(f, arguments));
}

// Arguments.

inline const vector3<double> u(0.3, -0.4, 0.9), v(-0.7, 0.2, 0.5);
inline const quaternion<double> p = from_rotation_vector(vector3<double>(0.3, 0.2, -0.5));
inline const quaternion<double> q = from_rotation_vector(vector3<double>(-0.1, 0.6, 0.4));
inline const quaternion<double> r = from_rotation_vector(vector3<double>(0.2, 0.1, 0.7));
inline const quaternion<double> s = from_rotation_vector(vector3<double>(0.4, -0.3, 0.2));
inline const dual_quaternion<double> A = pose(p, u), B = pose(q, v);
inline const vector6<double> xi = (vector6<double>() << 0.3, -0.2, 0.6, 0.1, 0.8, -0.4).finished();

} // namespace test_support::mixed

/// The function of that name, of these arguments.
#define DUET_CHECK_MIXED(call, ...)                                                                \
  test_support::mixed::check(                                                                      \
      #call, [](const auto&... x) { return call(x...); }, __VA_ARGS__)
