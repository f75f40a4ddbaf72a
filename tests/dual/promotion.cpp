// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/multiprecision.hpp"
#include "support/test.hpp"

#include <duet/dual/math.hpp>

#include <concepts>

// The common nesting of two scalars, and scalars that must not meet at all.

namespace test_dual_promotion {
namespace {

using duet::dual, duet::Promotable, duet::promote_t, duet::screw_tag, duet::taylor,
    duet_test::real_50, duet_test::real_50_et;

struct tag_a;
struct tag_bb;
struct tag_ccc;

template <class A, class B>
concept CanAdd = requires(A a, B b) {
  a + b;
};
template <class A, class B>
concept CanMultiply = requires(A a, B b) {
  a* b;
};
template <class A, class B>
concept CanCompare = requires(A a, B b) {
  a == b;
};
template <class A, class B>
concept CanTakePower = requires(A a, B b) {
  pow(a, b);
};

template <class A, class B, class Expected>
constexpr bool meets_in() {
  return std::same_as<promote_t<A, B>, Expected> && std::same_as<promote_t<B, A>, Expected> &&
         std::same_as<std::common_type_t<A, B>, Expected> &&
         std::same_as<std::common_type_t<B, A>, Expected> &&
         std::same_as<decltype(std::declval<A>() + std::declval<B>()), Expected> &&
         std::same_as<decltype(std::declval<B>() * std::declval<A>()), Expected> &&
         std::same_as<decltype(std::declval<B>() / std::declval<A>()), Expected> &&
         std::same_as<decltype(std::declval<B>() - std::declval<A>()), Expected> &&
         std::same_as<decltype(atan2(std::declval<A>(), std::declval<B>())), Expected> &&
         CanCompare<A, B> && CanCompare<B, A>;
}

// g++ finds a deleted function: std::pow, in a namespace of these types.
#ifdef __clang__
constexpr bool deleted_functions_are_found = false;
#else
constexpr bool deleted_functions_are_found = true;
#endif

template <class A, class B>
constexpr bool never_meet() {
  return !Promotable<A, B> && !Promotable<B, A> && !CanAdd<A, B> && !CanAdd<B, A> &&
         !CanMultiply<A, B> && !CanMultiply<B, A> && !CanCompare<A, B> && !CanCompare<B, A> &&
         (deleted_functions_are_found || !CanTakePower<A, B>)&&!std::constructible_from<A, B> &&
         !std::constructible_from<B, A>;
}

template <class From, class To>
constexpr bool implicit = std::is_convertible_v<From, To>;
template <class From, class To>
constexpr bool only_explicit =
    !std::is_convertible_v<From, To> && std::constructible_from<To, From>;
template <class From, class To>
constexpr bool impossible = !std::is_convertible_v<From, To> && !std::constructible_from<To, From>;

using d = dual<double>;
using screw = dual<double, 1, screw_tag>;
using a = dual<double, 1, tag_a>;
using bb = dual<double, 1, tag_bb>;
using ccc = dual<double, 1, tag_ccc>;

// Constants take the precision of the dual they meet.
static_assert(meets_in<d, int, d>() && meets_in<d, double, d>() && meets_in<d, bool, d>());
static_assert(meets_in<dual<float>, double, dual<float>>());
static_assert(meets_in<dual<float>, dual<double>, dual<double>>());
static_assert(meets_in<dual<long double>, dual<double>, dual<long double>>());
static_assert(meets_in<dual<float, 3>, dual<double, 3>, dual<double, 3>>());
static_assert(meets_in<taylor<float, 3>, taylor<double, 3>, taylor<double, 3>>());
static_assert(meets_in<dual<double>, real_50, dual<real_50>>());
static_assert(meets_in<dual<real_50>, dual<double>, dual<real_50>>());
static_assert(meets_in<dual<real_50_et>, double, dual<real_50_et>>());

// A derivative dual is a scalar of the screw algebra: screw outside, whatever stands first.
static_assert(meets_in<screw, d, dual<d, 1, screw_tag>>());
static_assert(
    meets_in<screw, dual<double, 7, tag_a>, dual<dual<double, 7, tag_a>, 1, screw_tag>>());
static_assert(meets_in<screw, taylor<double, 2>, dual<taylor<double, 2>, 1, screw_tag>>());
static_assert(meets_in<dual<d, 1, screw_tag>, d, dual<d, 1, screw_tag>>());
static_assert(meets_in<dual<d, 1, screw_tag>, a, dual<promote_t<a, d>, 1, screw_tag>>());
static_assert(meets_in<dual<d, 1, screw_tag>, screw, dual<d, 1, screw_tag>>());

// Derivatives of unrelated functions meet in one order, and a third joins either nesting.
using ab = promote_t<a, bb>;
static_assert(duet::scalar_traits<ab>::order == 2 && std::same_as<ab, promote_t<bb, a>>);
static_assert(meets_in<a, bb, ab>() && meets_in<ab, a, ab>() && meets_in<ab, bb, ab>());
static_assert(meets_in<ab, ccc, promote_t<promote_t<bb, ccc>, a>>());
static_assert(meets_in<ab, dual<float, 1, tag_a>, ab>());
static_assert(meets_in<dual<taylor<double, 2, tag_a>, 3, tag_bb>, taylor<double, 2, tag_a>,
                       dual<taylor<double, 2, tag_a>, 3, tag_bb>>());

// A constant of the inner level stays one: the promotion does not widen it.
static_assert(duet::ConstantOf<a, dual<a, 1, tag_bb>>);
static_assert(!duet::ConstantOf<dual<a, 1, tag_bb>, a> && !duet::ConstantOf<a, a>);
static_assert(!duet::ConstantOf<d, dual<float>>);

// Combinations without meaning do not compile.
static_assert(never_meet<dual<double, 2>, dual<double, 3>>());
static_assert(never_meet<taylor<double, 2>, taylor<double, 3>>());
static_assert(never_meet<dual<double>, taylor<double, 1>>());
static_assert(never_meet<dual<a, 1, tag_bb>, dual<bb, 1, tag_a>>()); // opposite nestings
static_assert(!CanAdd<d, const char*> && !CanAdd<d, std::nullptr_t> && !CanAdd<d, void*>);
static_assert(impossible<screw, d> && impossible<d, screw>);
static_assert(impossible<screw, dual<double, 1, tag_a>>);
static_assert(impossible<a, bb> && impossible<bb, a>);
static_assert(impossible<dual<d, 1, screw_tag>, d>);
static_assert(impossible<dual<double, 2>, dual<double, 3>>);
static_assert(impossible<const char*, d>);

// Conversions are implicit if nothing is lost, explicit if derivatives or digits are lost.
static_assert(implicit<int, d> && implicit<double, d> && implicit<double, dual<float>>);
static_assert(implicit<d, dual<d, 1, screw_tag>> && implicit<screw, dual<d, 1, screw_tag>>);
static_assert(implicit<dual<float>, dual<double>> && implicit<dual<double>, dual<long double>>);
static_assert(only_explicit<dual<double>, dual<float>>);
static_assert(only_explicit<dual<d, 1, screw_tag>, screw>);
static_assert(only_explicit<d, double> && only_explicit<d, float> && only_explicit<d, int>);
static_assert(only_explicit<taylor<double, 3>, double>);
static_assert(only_explicit<taylor<double, 3>, taylor<float, 3>>);
static_assert(!implicit<d, bool> || std::is_constructible_v<bool, d>);

static_assert(duet::Scalar<d> && duet::Scalar<double> && duet::Scalar<real_50_et>);
static_assert(!duet::Scalar<int> && !duet::Scalar<bool> && !duet::Scalar<const char*>);
static_assert(duet::Infinitesimal<taylor<double, 2>> && !duet::Infinitesimal<double>);
static_assert(duet::Real<real_50> && !duet::Real<d> && !duet::Real<int>);
static_assert(std::same_as<duet::real_type_t<dual<taylor<float, 2, tag_a>, 3>>, float>);

TEST_CASE("promotion: a derivative dual is a scalar of the screw algebra") {
  const screw s(2, 3);
  const auto x = d::variable(5);
  const auto y = s * x; // (2 + 3ε)(5 + δ)
  CHECK(y.value().value() == 10);
  CHECK(y.value().epsilon() == 2);
  CHECK(y.epsilon().value() == 15);
  CHECK(y.epsilon().epsilon() == 3);
  const auto z = x / s;
  CHECK(z.value().epsilon() == 0.5);
  CHECK(z.epsilon().value() == -3.75);
  CHECK(z.epsilon().epsilon() == -0.75);
}

TEST_CASE("promotion: opposite orders of promotion give the same type") {
  const a x = a::variable(2);
  const bb y = bb::variable(3);
  const auto p = x * x * y;
  const auto q = y * (x * x);
  static_assert(std::same_as<decltype(p), decltype(q)>);
  CHECK(p.value().value() == 12);
  CHECK(p.value().epsilon() + p.epsilon().value() == 12 + 4);
  CHECK(p.epsilon().epsilon() == 4); // ∂²/∂x∂y x²y = 2x
  CHECK(q.epsilon().epsilon() == 4);
}

TEST_CASE("conversion: widening keeps every part, narrowing rounds it") {
  const dual<float, 2> f = dual<float, 2>::variable(0.1F, 1);
  const dual<double, 2> wide = f;
  CHECK(wide.value() == double(0.1F));
  CHECK(wide.partial(0) == 0);
  CHECK(wide.partial(1) == 1);
  const dual<float> narrow(dual<double>(0.1, 0.3));
  CHECK(narrow.value() == 0.1F);
  CHECK(narrow.epsilon() == 0.3F);
  const auto mixed = dual<double>::variable(0.1) * real_50(3);
  CHECK(mixed.value() == real_50(0.1) * 3);
  CHECK(static_cast<int>(dual<double>(2.7, 1)) == 2);
}

} // namespace
} // namespace test_dual_promotion
