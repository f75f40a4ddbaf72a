// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/test.hpp"

#include <duet/core/batch/batch.hpp>
#include <duet/derivative/linear_solve.hpp>
#include <duet/dual/dynamic_dual.hpp>
#include <duet/dual/eigen_traits.hpp>
#include <duet/dual/level.hpp>
#include <duet/dual/math.hpp>
#include <duet/dual/second_dual.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/norm.hpp>

// The interface `Level`, implemented by a number defined here. (Its tag is duet's, so that duet's
// functions are found for it.)

namespace test_dual_level {

using slope_tag = duet::derivative_tag<struct of_sloped>;

/// x₀ + x₁ε as dual<T, 1>, with only the members that `Level` requires.
template <class T, class Tag = slope_tag>
class sloped : duet::detail::infinitesimal_operators<sloped<T, Tag>, T> {
public:
  sloped() : value_(0), slope_(0) {}
  template <duet::ConstantOf<sloped> U>
  sloped(const U& constant) : value_(constant), slope_(0) {}
  sloped(const T& value, const T& slope) : value_(value), slope_(slope) {}

  static constexpr int part_count = 2;
  [[nodiscard]] const T& value() const { return value_; }
  [[nodiscard]] const T& slope() const { return slope_; }
  [[nodiscard]] T part(int k) const { return k == 0 ? value_ : slope_; }
  [[nodiscard]] sloped with_value(const T& value) const { return {value, slope_}; }
  template <class F, class... Other>
  [[nodiscard]] auto zip(F&& f, const Other&... other) const {
    using U = std::decay_t<decltype(f(value_, other.value()...))>;
    const U value = f(value_, other.value()...); // first
    return sloped<U, Tag>(value, f(slope_, other.slope()...));
  }
  template <class Predicate>
  [[nodiscard]] auto all_of(const Predicate& predicate) const {
    return predicate(value_) && predicate(slope_);
  }
  [[nodiscard]] static sloped zero_preserving_product(const sloped& s, const sloped& x) {
    return {duet::detail::guarded_product(s.value_, x.value_),
            T(duet::detail::guarded_product(s.value_, x.slope_) +
              duet::detail::product_of_partial(s.slope_, x.value_))};
  }
  template <class Rule>
  [[nodiscard]] static sloped lift(const Rule& rule, const sloped& x) {
    const T y = rule.value(x.value_);
    return {y, duet::detail::guarded_product(T(rule.slope(x.value_, y)), x.slope_)};
  }
  template <class Rule, class... Rest>
  [[nodiscard]] static sloped lift(const Rule& rule, const sloped& x, const sloped& y,
                                   const Rest&... rest) {
    const T value = rule.value(x.value_, y.value_, rest.value_...);
    const auto slopes = rule.slopes(value, x.value_, y.value_, rest.value_...);
    T sum(0);
    int i = 0;
    for (const T& slope : {x.slope_, y.slope_, rest.slope_...}) {
      sum = sum + duet::detail::guarded_product(T(slopes[std::size_t(i++)]), slope);
    }
    return {value, sum};
  }
  template <int Sign>
  [[nodiscard]] static duet::detail::sine_cosine<sloped>
  lift_pair(const duet::detail::sine_cosine<T>& y, const sloped& x) {
    return {{y.sine, T(y.cosine * x.slope_)}, {y.cosine, T(Sign * y.sine * x.slope_)}};
  }
  template <class Out>
  void write(Out& out) const {
    out << value_ << "~" << slope_;
  }

  [[nodiscard]] sloped negated() const { return {T(-value_), T(-slope_)}; }
  template <class C>
  [[nodiscard]] sloped plus(const C& c) const {
    return {T(value_ + c), slope_};
  }
  template <class C>
  [[nodiscard]] sloped times(const C& c) const {
    return {T(value_ * c), T(slope_ * c)};
  }
  template <class C>
  [[nodiscard]] sloped divided_by(const C& c) const {
    return {T(value_ / c), T(slope_ / c)};
  }
  [[nodiscard]] sloped dividing(const T& c) const { return quotient(sloped(c), *this); }
  [[nodiscard]] static sloped sum(const sloped& a, const sloped& b) {
    return {T(a.value_ + b.value_), T(a.slope_ + b.slope_)};
  }
  [[nodiscard]] static sloped difference(const sloped& a, const sloped& b) {
    return {T(a.value_ - b.value_), T(a.slope_ - b.slope_)};
  }
  [[nodiscard]] static sloped product(const sloped& a, const sloped& b) {
    return {T(a.value_ * b.value_), T(a.value_ * b.slope_ + a.slope_ * b.value_)};
  }
  [[nodiscard]] static sloped quotient(const sloped& a, const sloped& b) {
    const T y = a.value_ / b.value_;
    return {y, T((a.slope_ - y * b.slope_) / b.value_)};
  }

private:
  T value_, slope_;
};

} // namespace test_dual_level

template <class T, class Tag>
struct duet::scalar_traits<test_dual_level::sloped<T, Tag>> {
  using value_type = T;
  using real_type = typename scalar_traits<T>::real_type;
  using tag = Tag;
  template <class U>
  using over = test_dual_level::sloped<U, Tag>;
  static constexpr bool is_infinitesimal = true;
  static constexpr int order = scalar_traits<T>::order + 1;
};

namespace test_dual_level {

using duet::batch, duet::dual, duet::quaternion, duet::second_order_dual, duet::taylor;

static_assert(duet::Level<sloped<double>> && duet::Level<sloped<batch<double>>>);
static_assert(duet::Level<dual<double>> && duet::Level<dual<dual<float, 3>, 2, slope_tag>>);
static_assert(duet::Level<duet::dynamic_dual<double, 4>> && duet::Level<taylor<double, 3>>);
static_assert(duet::Level<second_order_dual<double, 2>> && !duet::Level<double>);

/// Uses every function that depends on the interface of levels.
template <class D>
D tried(const D& x) {
  using std::atan2, std::hypot;
  const D y = sinh(x) / cosh(x) + pow(x, 2.5) + pow(D(1.5), x) + atan2(x, D(2)) +
              hypot(x, D(3), sin(x)) + cos(x) * tgamma(x) - 2 / x;
  const quaternion<D> q = exp(quaternion<D>(D(0), D(0.3 * x), D(0.2), D(-x)));
  const quaternion<D> p = pow(slerp(q, quaternion<D>(x, D(1), D(0), x * x), x), 0.3);
  return y + norm(p + q) + log(q).x() + normalized(q).w() + inverse(p).z();
}

TEST_CASE("Level: a user-defined infinitesimal number has all functions of duals") {
  for (const double at : {0.3, 1.0, 2.2}) {
    const auto known = tried(dual<double>::variable(at));
    const auto x = tried(sloped<double>(at, 1));
    CHECK(x.value() == doctest::Approx(known.value()).epsilon(1e-14));
    CHECK(x.slope() == doctest::Approx(known.epsilon()).epsilon(1e-13));
    // Over another level, and under one.
    using below = dual<double>;
    const auto over = tried(sloped<below>(below::variable(at), below(1)));
    CHECK(over.slope().value() == doctest::Approx(known.epsilon()).epsilon(1e-13));
    using above = dual<sloped<double>, 1, duet::derivative_tag<struct outside>>;
    const auto under = tried(above::variable(sloped<double>(at, 1)));
    CHECK(under.epsilon().slope() == doctest::Approx(over.slope().epsilon()).epsilon(1e-12));
  }
  const auto vertical = sqrt(sloped<double>(0, 0)), steep = sqrt(sloped<double>(0, 1));
  CHECK(vertical.slope() == 0);
  CHECK(steep.slope() == std::numeric_limits<double>::infinity());
  std::ostringstream out;
  out << sloped<double>(2, 3);
  CHECK(out.str() == "2~3");
}

TEST_CASE("Level: lanes, limits, matrices and parts of a user-defined infinitesimal number") {
  using lanes = sloped<batch<double, 4>>;
  const auto joined =
      duet::from_lanes<4>([](std::size_t i) { return sloped<double>(0.3 + double(i), 1); });
  static_assert(std::is_same_v<std::remove_const_t<decltype(joined)>, lanes>);
  const lanes results = tried(joined);
  for (int i = 0; i < 4; ++i) {
    const auto alone = tried(sloped<double>(0.3 + i, 1));
    CHECK(duet::lane(results, i).value() == doctest::Approx(alone.value()).epsilon(1e-14));
    CHECK(duet::lane(results, i).slope() == doctest::Approx(alone.slope()).epsilon(1e-13));
  }
  CHECK(std::numeric_limits<sloped<double>>::max().value() == std::numeric_limits<double>::max());
  CHECK(duet::detail::part<slope_tag>(sloped<double>(2, 3), 1) == 3);
  CHECK(duet::detail::part<slope_tag>(dual<double>(2), 1).value() == 0);

  const sloped<double> x(3, 1);
  Eigen::Matrix<sloped<double>, 2, 2> a;
  a << x, 1, 2, 5 * x;
  const Eigen::Vector2d b(3, 1);
  const auto solved = duet::solve(a, b);
  CHECK(solved[0].value() == doctest::Approx((15.0 * 3 - 1) / 43)); // (15 x − 1)/(5 x² − 2)
  CHECK(solved[0].slope() == doctest::Approx((15 * 43.0 - 44 * 30) / (43 * 43)));
}

TEST_CASE("Level: numbers of unequal counts of partials meet in lanes and linear equations") {
  using D = duet::dynamic_dual<double, 4>;
  const D x = D::variable(3, 0, 2), y = D::variable(5, 1, 2);
  Eigen::Matrix<D, 2, 2> a;
  a << x, 1, 2, y * x;
  Eigen::Matrix<D, 2, 1> b;
  b << D(3), D(1);
  const auto solved = duet::solve(a, b);
  const D expected = (3 * y * x - 1) / (x * x * y - 2);
  REQUIRE(solved[0].size() == 2);
  CHECK(solved[0].partial(0) == doctest::Approx(expected.partial(0)).epsilon(1e-14));
  CHECK(solved[0].partial(1) == doctest::Approx(expected.partial(1)).epsilon(1e-14));

  using B = batch<double, 4>;
  using L = duet::dynamic_dual<B, 4>;
  const L variable = L::variable(B::from_lanes([](int i) { return i - 1.5; }), 0, 2);
  const L positive = duet::select(
      variable.value() < 0, [&] { return L(0); }, [&] { return variable; });
  CHECK(positive.partial(0)[0] == 0);
  CHECK(positive.partial(0)[3] == 1);
}

} // namespace test_dual_level
