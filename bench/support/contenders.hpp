// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/dual/math.hpp>

#if DUET_BENCH_CERES
#include <ceres/jet.h>
#endif
#if DUET_BENCH_EIGEN
#include <Eigen/Core>
#include <unsupported/Eigen/AutoDiff>
#endif

#include <array>
#include <cstddef>
#include <string_view>
#include <utility>

/// \file
/// Seeding and reading of the numbers of each library. A contender has a `name` and, for N
/// partials, `number<N>`, `variable<N>(value, i)`, `value(x)` and `write_partials<N>(x, out)`.

namespace duet_bench {

struct duet_contender {
  static constexpr std::string_view name = "duet";
  template <int N>
  using number = duet::dual<double, N>;
  template <int N>
  static number<N> variable(double value, int i) {
    return number<N>::variable(value, i);
  }
  template <class S>
  static double value(const S& x) {
    return x.value();
  }
  template <int N>
  static void write_partials(const number<N>& x, double* out) {
    for (int i = 0; i < N; ++i) {
      out[i] = x.partial(i);
    }
  }
};

#if DUET_BENCH_CERES
struct ceres_contender {
  static constexpr std::string_view name = "ceres";
  template <int N>
  using number = ceres::Jet<double, N>;
  template <int N>
  static number<N> variable(double value, int i) {
    return number<N>(value, i);
  }
  template <class S>
  static double value(const S& x) {
    return x.a;
  }
  template <int N>
  static void write_partials(const number<N>& x, double* out) {
    Eigen::Map<Eigen::Matrix<double, N, 1>>(out, N) = x.v;
  }
};
#endif

#if DUET_BENCH_EIGEN
struct eigen_contender {
  static constexpr std::string_view name = "eigen";
  template <int N>
  using number = Eigen::AutoDiffScalar<Eigen::Matrix<double, N, 1>>;
  template <int N>
  static number<N> variable(double value, int i) {
    return number<N>(value, N, i);
  }
  template <class S>
  static double value(const S& x) {
    return x.value();
  }
  template <int N>
  static void write_partials(const number<N>& x, double* out) {
    Eigen::Map<Eigen::Matrix<double, N, 1>>(out, N) = x.derivatives();
  }
};
#endif

/// The point `at` as the variables of a function of N, constructed in place.
template <class Library, class Number, std::size_t N>
std::array<Number, N> seeded(const std::array<double, N>& at) {
  return [&]<std::size_t... I>(std::index_sequence<I...>) {
    return std::array<Number, N>{Library::template variable<int(N)>(at[I], int(I))...};
  }
  (std::make_index_sequence<N>{});
}

/// Calls f(contender) for every contender that differentiates with respect to many variables.
template <class F>
void for_each_contender(F&& f) {
  f(duet_contender{});
#if DUET_BENCH_CERES
  f(ceres_contender{});
#endif
#if DUET_BENCH_EIGEN
  f(eigen_contender{});
#endif
}

} // namespace duet_bench
