// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/test.hpp"

#include <duet/dual/math.hpp>

// Tags distinguish the infinitesimals of nested differentiations.

namespace test_dual_tags {
namespace {

using duet::derivative_tag, duet::dual, duet::screw_tag;

struct my_tag;
struct other_tag;

/// The coefficient of the ε tagged Tag at any nesting depth; the other levels remain.
template <class Tag, class T, class DTag>
constexpr auto part_of(const dual<T, 1, DTag>& x) {
  if constexpr (std::is_same_v<Tag, DTag>) {
    return x.epsilon();
  } else {
    using below = decltype(part_of<Tag>(x.value()));
    return dual<below, 1, DTag>(part_of<Tag>(x.value()), part_of<Tag>(x.epsilon()));
  }
}

// d/dx (x · d/dy (x + y)|₁)|₁ = 1. With one ε for both the result is 2, as in other libraries.
TEST_CASE("tags: nested derivatives do not confuse their perturbations") {
  const auto x = dual<double, 1, derivative_tag<my_tag>>::variable(1);
  const auto y = dual<double, 1, derivative_tag<other_tag>>::variable(1);
  const auto inner = part_of<derivative_tag<other_tag>>(x + y);
  const auto outer = part_of<derivative_tag<my_tag>>(x * inner);
  CHECK(outer == 1);

  const auto confused = dual<double>::variable(1);
  CHECK((confused * (confused + confused).epsilon()).epsilon() == 2);
}

// The same with lambdas that really capture each other, so that the tag of the inner function
// contains the tag of the outer one in its own name: the inner level must be outside.
TEST_CASE("tags: the level of an inner function nests outside the level of the outer one") {
  const auto outer_function = [](auto x) {
    const auto inner_function = [x](auto y) { return x * y; };
    using inner_tag = derivative_tag<decltype(inner_function)>;
    using outer_tag = duet::level_tag<decltype(x)>;
    static_assert(duet::detail::is_outside<inner_tag, outer_tag>());
    static_assert(!duet::detail::is_outside<outer_tag, inner_tag>());
    const auto y = dual<double, 1, inner_tag>::variable(3);
    const auto product = inner_function(y);
    static_assert(
        std::is_same_v<duet::level_tag<std::remove_const_t<decltype(product)>>, inner_tag>);
    return product.epsilon(); // x, with its own derivative
  };
  using tag = derivative_tag<decltype(outer_function)>;
  const auto result = outer_function(dual<double, 1, tag>::variable(2));
  CHECK(result.value() == 2);
  CHECK(result.epsilon() == 1);
}

TEST_CASE("tags: the screw's infinitesimal is outermost") {
  using duet::detail::is_outside;
  static_assert(is_outside<screw_tag, derivative_tag<>>());
  static_assert(!is_outside<derivative_tag<>, screw_tag>());
  static_assert(is_outside<screw_tag, derivative_tag<derivative_tag<my_tag>>>());
  static_assert(duet::detail::tags_are_distinguishable<my_tag, other_tag>());
  static_assert(is_outside<my_tag, other_tag>() != is_outside<other_tag, my_tag>());
}

} // namespace
} // namespace test_dual_tags
