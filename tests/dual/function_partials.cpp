// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "dual/function_cases.hpp"
#include "support/test.hpp"

namespace test_dual_function_partials {
namespace {

using duet::dual, duet_test::domain, duet_test::for_each_function;

/// y.partial(i) is the slope of one variable times the i-th seed, for every i.
template <class T, int N, class F>
bool partials_agree(F&& f, T x) {
  const T slope = f(dual<T>::variable(x)).epsilon();
  dual<T, N> seeds(x);
  for (int i = 0; i < N; ++i) {
    seeds.set_partial(i, T(i % 5) - 2);
  }
  const auto y = f(seeds);
  for (int i = 0; i < N; ++i) {
    const T seed = T(i % 5) - 2;
    const T expected = seed == 0 ? T(0) : slope * seed;
    if (y.partial(i) != expected && !(isnan(dual<T>(expected)) && isnan(dual<T>(y.partial(i))))) {
      return false;
    }
  }
  return y.value() == f(x) || f(x) != f(x);
}

TEST_CASE("functions over dual: every number of partials gives the same slope") {
  for_each_function([](const std::string& name, auto f, auto, const domain& d, auto) {
    CAPTURE(name);
    for (const double x : d.inputs) {
      CAPTURE(x);
      [&]<int... N>(std::integer_sequence<int, N...>) {
        constexpr std::array sizes{1, 2, 3, 4, 5, 7, 8, 12, 17, 33};
        CHECK((partials_agree<double, sizes[std::size_t(N)]>(f, x) && ...));
        CHECK((partials_agree<float, sizes[std::size_t(N)]>(f, float(x)) && ...));
      }
      (std::make_integer_sequence<int, 10>{});
      CHECK(partials_agree<long double, 3>(f, x));
    }
  });
}

} // namespace
} // namespace test_dual_function_partials
