// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/test.hpp"

#include <duet/comparison/compare.hpp>
#include <duet/comparison/rotations.hpp>
#include <duet/core/errors.hpp>
#include <duet/derivative/derivative.hpp>
#include <duet/derivative/gradient.hpp>
#include <duet/dual/eigen_traits.hpp>
#include <duet/interop/multiprecision.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/rotation.hpp>

// Verdicts on formulas that are right, wrong, wrong at one point only, or badly rounded.

namespace test_comparison_verdicts {
namespace {

using duet::compare, duet::comparison, duet::comparison_options, duet::derivative, duet::real_50,
    duet::real_numbers, duet::rotations, duet::sampler, duet::vectors, duet::verdict;

const auto slope_of_wave = [](auto x) {
  return derivative([](auto t) { return sin(t * t); }, x).derivative;
};

TEST_CASE("compare: a right formula agrees in every precision") {
  const auto closed_form = [](auto x) {
    using std::cos;
    return 2 * x * cos(x * x);
  };
  const comparison c = compare<float, double, long double, real_50>(
      "wave", slope_of_wave, closed_form, sampler(real_numbers{-3, 3}));
  CHECK(c);
  CHECK(c.outcome == verdict::agrees);
  CHECK(c.samples == sampler(real_numbers{-3, 3}).points(1000, 1).size());
  CHECK(c.counts[0] == c.samples);
  CHECK(!c.simplest);
  CHECK(c.errors.size() == 4);
  CHECK(c.errors[0].digits == 6);
  CHECK(c.errors[3].digits == 50);
  for (const auto& e : c.errors) {
    CHECK(e.ulps < 4);
  }
}

TEST_CASE("compare: a right formula with unqualified function names agrees in every precision") {
  const auto automatic = [](auto x) {
    return derivative([](auto t) { return log(t + sqrt(t * t + 1)); }, x).derivative;
  };
  const auto closed_form = [](auto x) { return 1 / sqrt(x * x + 1); }; // C's sqrt is of double
  CHECK(compare<float, double, long double>("asinh'", automatic, closed_form,
                                            sampler(real_numbers{0, 100})));
}

TEST_CASE("compare: few samples follow all special inputs and do not replace them") {
  const auto special = real_numbers{-3, 3}.special_points();
  const auto wrong_elsewhere = [&](double x) {
    return std::any_of(special.begin(), special.end(), [&](const auto& p) { return p[0] == x; })
               ? x
               : 2 * x;
  };
  const comparison c = compare<double>("few samples", [](double x) { return x; }, wrong_elsewhere,
                                       sampler(real_numbers{-3, 3}), {.samples = 3});
  CHECK(c.samples >= special.size() + 3);
  CHECK(c.outcome == verdict::disagrees);
}

TEST_CASE("compare: an error is detected and its input simplified") {
  const auto slip = [](auto x) {
    using std::cos;
    return x * cos(x * x);
  };
  const comparison c = compare("slip", slope_of_wave, slip, sampler(real_numbers{-3, 3}));
  CHECK(!c);
  CHECK(c.outcome == verdict::disagrees);
  CHECK(c.counts[std::size_t(verdict::disagrees)] == c.samples - 1); // it agrees at zero
  REQUIRE(c.simplest);
  CHECK(c.simplest->input == "x = 1");
  CHECK(c.simplest->automatic[0] == doctest::Approx(2 * std::cos(1.0)).epsilon(1e-15));
  CHECK(c.simplest->closed_form[0] == doctest::Approx(std::cos(1.0)).epsilon(1e-15));
}

TEST_CASE(
    "compare: an error of a few hundred ulps is detected, a smaller one is within tolerance") {
  const auto off_by = [](double relative) {
    return [relative](auto x) {
      using std::cos;
      return 2 * x * cos(x * x) * (1 + relative);
    };
  };
  const auto inputs = sampler(real_numbers{1, 3});
  CHECK(compare("small", slope_of_wave, off_by(0x1p-40), inputs).outcome == verdict::disagrees);
  comparison_options options;
  CHECK(compare<double>("tiny", slope_of_wave, off_by(0x1p-49), inputs, options));
  options.tolerance = 2;
  CHECK(!compare<double>("tiny", slope_of_wave, off_by(0x1p-49), inputs, options));
}

TEST_CASE("compare: an error at a single point is detected there") {
  // The sign of the square root of 1 at a half turn.
  const auto right = [](const auto& q) { return duet::rotation_matrix(q); };
  const auto wrong_at_half_turn = [](const auto& q) {
    const bool is_half_turn = abs(q.w()) < 1e-12;
    auto matrix = duet::rotation_matrix(q);
    if (is_half_turn) {
      matrix(0, 1) = -matrix(0, 1);
    }
    return matrix;
  };
  const comparison c =
      compare("matrix", right, wrong_at_half_turn, sampler(rotations{}).named("q"));
  CHECK(c.outcome == verdict::disagrees);
  CHECK(c.counts[std::size_t(verdict::disagrees)] >=
        2); // about the diagonal axis, in both directions
}

TEST_CASE("compare: digits lost by cancellation are distinguished from an error") {
  const auto stable = [](auto x) {
    using std::sin;
    const auto s = sin(x / 2);
    return 2 * s * s / x;
  };
  const auto cancelling = [](auto x) {
    using std::cos;
    return (1 - cos(x)) / x;
  };
  const auto inputs = sampler(real_numbers{1e-8, 3});
  CHECK(compare("1 - cos", stable, cancelling, inputs).outcome == verdict::loses_precision);
  CHECK(compare<double, real_50>("1 - cos", stable, cancelling, inputs).outcome ==
        verdict::loses_precision);
  const auto constant_of_few_digits = [&](auto x) { return stable(x) * 1.0000000000000002; };
  CHECK(compare<double, real_50>("few digits", stable, constant_of_few_digits, inputs).outcome ==
        verdict::loses_precision);
  // Away from zero nothing is lost.
  CHECK(compare("1 - cos", stable, cancelling, sampler(real_numbers{1, 3})));
}

TEST_CASE("compare: round-off at a zero of the function is not counted as an error") {
  // Near pi, sin has a large relative error for any rounding of its argument.
  const auto direct = [](auto x) {
    using std::sin;
    return sin(x);
  };
  const auto shifted = [](auto x) {
    using std::sin;
    return sin(x / 3) * (3 - 4 * sin(x / 3) * sin(x / 3));
  };
  const auto inputs = sampler(real_numbers{3, 3.3}).including({3.14159265358979});
  CHECK(compare("triple angle", direct, shifted, inputs));
}

TEST_CASE("compare: a result that is not finite on one side only gives not_finite") {
  const auto sinc = [](auto x) {
    using std::sin;
    return x == 0 ? decltype(x)(1) : decltype(x)(sin(x) / x);
  };
  const auto naive = [](auto x) {
    using std::sin;
    return sin(x) / x;
  };
  const comparison c = compare("sinc", sinc, naive, sampler(real_numbers{-1, 1}));
  CHECK(c.outcome == verdict::not_finite);
  CHECK(c.counts[std::size_t(verdict::not_finite)] == 1);
  REQUIRE(c.simplest);
  CHECK(c.simplest->input == "x = 0");
  CHECK(c.simplest->automatic[0] == 1);
  CHECK(std::isnan(c.simplest->closed_form[0]));
  // Results that are not finite on both sides are not compared.
  CHECK(compare("both", naive, naive, sampler(real_numbers{-1, 1})));
}

/// cos x, sin x and e^x, one of them wrong near zero: cos x by x²/6, sin x by x, e^x by 1.
struct wrong_near_zero {
  int component;
  double threshold;
  bool negative_only = false;

  template <class T>
  [[nodiscard]] std::array<T, 3> operator()(const T& x) const {
    using std::abs, std::cos, std::exp, std::sin;
    std::array<T, 3> y = {cos(x), sin(x), exp(x)};
    if (abs(x) < threshold && !(negative_only && x >= 0)) {
      y[std::size_t(component)] += component == 0 ? x * x / 6 : component == 1 ? x : T(1);
    }
    return y;
  }
};

TEST_CASE("compare: an error in a series for small arguments is detected for any threshold") {
  const wrong_near_zero right{0, 0};
  const auto inputs = sampler(real_numbers{-2, 2});
  const auto outcome = [&](const wrong_near_zero& wrong, std::uint64_t seed) {
    return compare("series", right, wrong, inputs, {.seed = seed}).outcome;
  };
  for (const std::uint64_t seed : {1, 2, 3}) {
    for (const bool negative_only : {false, true}) {
      for (const double threshold : {1e-3, 9e-5, 1e-5, 2e-6}) {
        CHECK(outcome({0, threshold, negative_only}, seed) == verdict::disagrees);
      }
      for (const double threshold : {9e-5, 1e-5, 1e-8, 1e-10}) {
        CHECK(outcome({1, threshold, negative_only}, seed) == verdict::disagrees);
        CHECK(outcome({2, threshold, negative_only}, seed) == verdict::disagrees);
      }
    }
    CHECK(outcome(right, seed) == verdict::agrees);
  }
  for (const wrong_near_zero& wrong : {wrong_near_zero{0, 9e-5, true}, wrong_near_zero{0, 1e-5},
                                       wrong_near_zero{1, 1e-8}, wrong_near_zero{2, 1e-10}}) {
    CHECK(compare<double, real_50>("series", right, wrong, inputs, {.samples = 200}).outcome ==
          verdict::disagrees);
  }
  // x²/6 is less than the last place of 1.
  CHECK(outcome({0, 1e-9}, 1) == verdict::agrees);
  CHECK(compare<double, real_50>("series", right, wrong_near_zero{0, 1e-9}, inputs).outcome ==
        verdict::loses_precision);
}

/// The rotation vector of q, wrong if `where` holds.
struct wrong_logarithm {
  bool (*where)(double w, double size, const Eigen::Vector3d& v);

  template <class T>
  [[nodiscard]] duet::vector3<T> operator()(const duet::quaternion<T>& q) const {
    const duet::vector3<T> r = duet::rotation_vector(q);
    const auto v = Eigen::Vector3d(double(q.x()), double(q.y()), double(q.z()));
    return where(double(q.w()), v.norm(), v) ? duet::vector3<T>(r / 2) : r;
  }
  template <class T>
  [[nodiscard]] duet::vector3<T> operator()(const duet::quaternion<T>& a,
                                            const duet::quaternion<T>& b) const {
    return (*this)(duet::quaternion<T>(conj(a) * b));
  }
  template <class T>
  [[nodiscard]] duet::vector3<T> operator()(const duet::quaternion<T>& a,
                                            const duet::quaternion<T>& b,
                                            const duet::quaternion<T>& c) const {
    return (*this)(a, b) + (*this)(b, c);
  }
};

const std::vector<wrong_logarithm> wrong_logarithms = {
    {[](double w, double size, const auto&) { return w > 0 && size < 1e-4; }},
    {[](double w, double size, const auto&) { return w > 0 && size < 1e-8; }},
    {[](double w, double, const auto&) { return w < 0; }},
    {[](double w, double, const auto&) { return std::abs(w) < 1e-6; }},
    {[](double w, double size, const auto&) { return w < 0 && size < 1e-5; }},
    {[](double, double, const auto& v) { return v[0] < 0 && v[1] > 0 && v[2] < 0; }},
};

TEST_CASE(
    "compare: an error at small rotations, half turns, full turns or in one octant is detected") {
  const wrong_logarithm right{[](double, double, const auto&) { return false; }};
  std::vector<wrong_logarithm> wrong = wrong_logarithms;
  wrong.push_back({[](double w, double size, const auto&) { return w > 0 && size < 1e-11; }});
  wrong.push_back({[](double, double size, const auto&) { return size > 0 && size < 1e-10; }});
  wrong.push_back({[](double, double, const auto& v) { return v[0] == 0 && v[1] * v[2] != 0; }});
  wrong.push_back({[](double, double, const auto& v) { return v[0] == v[1] && v[0] * v[2] != 0; }});
  for (const std::uint64_t seed : {1, 2, 3}) {
    for (const wrong_logarithm& f : wrong) {
      CHECK(compare("log", right, f, sampler(rotations{}), {.seed = seed}).outcome ==
            verdict::disagrees);
    }
  }
}

TEST_CASE(
    "compare: an error at arguments that are equal or a half or full turn apart is detected") {
  const wrong_logarithm right{[](double, double, const auto&) { return false; }};
  const auto two = sampler(rotations{}, rotations{});
  const auto three = sampler(rotations{}, rotations{}, rotations{});
  for (const wrong_logarithm& f : wrong_logarithms) {
    CHECK(compare("Log(A'B)", right, f, two).outcome == verdict::disagrees);
    CHECK(compare("three", right, f, three).outcome == verdict::disagrees);
  }
  CHECK(compare("Log(A'B)", right, right, two));
}

/// (1 − cos x)/x², as it is written, or so that it keeps its digits; or, below a threshold, wrong.
struct half_square_sinc {
  bool naive = false;
  double threshold = 0;

  template <class T>
  [[nodiscard]] T operator()(const T& x) const {
    using std::abs, std::cos, std::sin;
    const T half_sine = sin(x / 2) / x;
    return abs(x) < threshold ? T(T(0.5) - x * x / 12)
           : naive            ? T((1 - cos(x)) / (x * x))
                              : T(2 * half_sine * half_sine);
  }
};

TEST_CASE("compare: near an excluded point the right formula agrees or loses digits") {
  const auto sinc = [](auto x) {
    using std::sin;
    return x == 0 ? decltype(x)(1) : decltype(x)(sin(x) / x);
  };
  const auto naive = [](auto x) {
    using std::sin;
    return sin(x) / x;
  };
  CHECK(compare("sinc", sinc, naive, sampler(real_numbers{}.without(0))));
  CHECK(compare("sinc", sinc, naive, sampler(real_numbers{}).without({0}, 1e-9)));
  CHECK(
      compare("sinc", sinc, naive, sampler(real_numbers{}.where([](double x) { return x != 0; }))));
  const auto inputs = sampler(real_numbers{-2, 2}.without(0));
  for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
    const comparison_options options = {.seed = seed};
    CHECK(compare("right", half_square_sinc{}, half_square_sinc{}, inputs, options));
    // No digit is right in either precision, as for an error, but this is round-off.
    const comparison c =
        compare("naive", half_square_sinc{}, half_square_sinc{true}, inputs, options);
    CHECK(c.outcome == verdict::loses_precision);
    CHECK(c.errors[1].relative == 1);
    for (const bool is_naive : {false, true}) {
      CHECK(compare("slip", half_square_sinc{}, half_square_sinc{is_naive, 1e-4}, inputs, options)
                .outcome == verdict::disagrees);
    }
  }
  CHECK(compare("naive", half_square_sinc{}, half_square_sinc{true}, sampler(real_numbers{0.01, 2}),
                {.tolerance = 1e6}));
}

TEST_CASE("compare: round-off is never reported as an error, for any seed") {
  const auto plain = [](auto x) { return x; };
  const auto amplified = [](auto x) { return (x + 1000000) - 1000000; };
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    CHECK(compare("amplified", plain, amplified, sampler(real_numbers{}), {.seed = seed}).outcome ==
          verdict::loses_precision);
  }
}

TEST_CASE("compare: an error is detected next to a component with larger round-off") {
  const auto right = [](auto x) { return std::array{x + 1, x + 2}; };
  const auto both = [](auto x) {
    return std::array{(x + 1 + 100000000) - 100000000, (x + 2) * (1 + decltype(x)(1e-11))};
  };
  CHECK(compare("both", right, both, sampler(real_numbers{0, 1})).outcome == verdict::disagrees);
}

TEST_CASE("compare: components that are not finite do not hide the others") {
  const auto right = [](auto x) { return std::array{x, x}; };
  const auto wrong = [](auto x) { return std::array{x / (x - x), 2 * x}; };
  const comparison c = compare("nan", right, wrong, sampler(real_numbers{}));
  CHECK(c.outcome == verdict::disagrees);
  CHECK(c.counts[std::size_t(verdict::not_finite)] == c.samples);
  CHECK(c.counts[std::size_t(verdict::disagrees)] > 500);
  CHECK(to_text(c).starts_with("nan: disagrees at "));
  CHECK(to_text(c).find("not finite at " + std::to_string(c.samples)) != std::string::npos);
  REQUIRE(c.simplest);
  CHECK(c.simplest->input == "x = 1");
  CHECK(c.simplest->automatic[1] == 1);
  CHECK(c.simplest->closed_form[1] == 2);
  const auto not_finite = [](auto x) { return std::array{x / (x - x), x}; };
  CHECK(compare("nan", right, not_finite, sampler(real_numbers{})).outcome == verdict::not_finite);
  // A component that is infinite on both sides does not set the scale of the others.
  CHECK(compare("infinite", not_finite, wrong, sampler(real_numbers{})).outcome ==
        verdict::disagrees);
}

TEST_CASE("compare: the simplest input is chosen in the order 0, 1, 2, 3, … 9, -1, 1/2") {
  const auto right = [](auto x) { return x; };
  const auto simplest = [&](double lower, double upper, double smallest, double largest) {
    const auto wrong = [&](auto x) { return x >= smallest && x <= largest ? x + 1 : x; };
    return compare<double>("x", right, wrong, sampler(real_numbers{lower, upper}))
        .simplest.value()
        .input;
  };
  CHECK(simplest(-20, 20, -20, 20) == "x = 0");
  CHECK(simplest(-20, 20, 0.5, 20) == "x = 1");
  CHECK(simplest(-20, 20, 1.5, 20) == "x = 2");
  CHECK(simplest(-20, 20, 2.5, 20) == "x = 3");
  CHECK(simplest(-20, 20, 4, 20) == "x = 4");
  CHECK(simplest(-20, 20, -20, -0.1) == "x = -1");
  CHECK(simplest(-20, 20, 0.2, 0.7) == "x = 0.5");
  CHECK(simplest(-20, 20, -0.7, -0.2) == "x = -0.5");
  CHECK(simplest(-20, 20, 7.5, 8.5) == "x = 8");
  CHECK(simplest(-2, 2, 1e-5, 9.5e-5) == "x = 1e-05");

  // Equal and nearly equal arguments.
  const auto equal = [](auto x, auto y) { return x == y && x > 0.25 ? x + 1 : x; };
  const auto first = [](auto x, auto) { return x; };
  CHECK(compare<double>("x", first, equal, sampler(real_numbers{}, real_numbers{}))
            .simplest.value()
            .input == "x1 = 1, x2 = 1");
  const auto nearly = [](auto x, auto y) { return x != y && std::abs(x - y) < 1e-7 ? x + 1 : x; };
  CHECK(compare<double>("x", first, nearly, sampler(real_numbers{}, real_numbers{}))
            .simplest.value()
            .input == "x1 = 0, x2 = 1e-12");
}

TEST_CASE("compare: several arguments and results of any shape are supported") {
  const auto automatic = [](const auto& x, auto k) {
    return duet::gradient([k](const auto& v) { return k * v.dot(v); }, x).gradient;
  };
  const auto closed_form = [](const auto& x, auto k) { return (2 * k * x).eval(); };
  const auto slip = [](const auto& x, auto k) { return (2 * k * k * x).eval(); };
  const auto inputs = sampler(vectors<3>{}, real_numbers{0, 3}).named("v", "k");
  CHECK(compare("gradient", automatic, closed_form, inputs));
  const comparison c = compare("gradient", automatic, slip, inputs);
  REQUIRE(c.simplest);
  CHECK(c.simplest->input == "v = (1, 0, 0), k = 2");
}

TEST_CASE("compare: results of different sizes throw invalid_input") {
  DUET_CHECK_REFUSED(
      "duet: compare \"sizes\": the automatic result has 2 components, the closed form 3",
      compare(
          "sizes",
          [](auto x) {
            return std::array{x, x};
          },
          [](auto x) {
            return std::array{x, x, x};
          },
          sampler(real_numbers{})));
}

TEST_CASE("compare: results of different shapes throw invalid_input") {
  const auto as = [](auto rows, auto columns) {
    return [](auto x) {
      return Eigen::Matrix<decltype(x), decltype(rows)::value, decltype(columns)::value>::Constant(
                 x)
          .eval();
    };
  };
  const std::integral_constant<int, 1> one;
  const std::integral_constant<int, 3> three;
  const std::integral_constant<int, 4> four;
  const std::integral_constant<int, 12> twelve;
  const auto judge = [](const auto& f, const auto& g) {
    return compare<double>("shapes", f, g, sampler(real_numbers{}), {.samples = 1});
  };
  DUET_CHECK_REFUSED(
      "duet: compare \"shapes\": the automatic result is 3 x 4, the closed form 4 x 3",
      judge(as(three, four), as(four, three)));
  DUET_CHECK_REFUSED(
      "duet: compare \"shapes\": the automatic result is 3 x 4, the closed form 12 numbers",
      judge(as(three, four), as(twelve, one)));
  const auto pair_with = [](const auto& f) {
    return [&f](auto x) { return std::pair{std::array{x, x}, f(x)}; };
  };
  DUET_CHECK_REFUSED(
      "duet: compare \"shapes\": the automatic result is 2 numbers and 3 x 4, the closed form 2 "
      "numbers and 4 x 3",
      judge(pair_with(as(three, four)), pair_with(as(four, three))));
  const auto dynamic = [](auto x) { return Eigen::MatrixX<decltype(x)>::Constant(3, 4, x).eval(); };
  CHECK(judge(as(three, four), dynamic));
  CHECK(judge(as(one, four), as(four, one))); // a row is as good as a column
  CHECK(judge(as(three, four), [](auto x) {
    std::array<decltype(x), 12> all;
    all.fill(x);
    return all;
  }));
}

const std::string note_of_first = "the first function returned double where its arguments were "
                                  "long double: a constant made it so, as the 0.0 of "
                                  "derivative(f, 0.0): write T(0)";
constexpr bool long_double_is_longer =
    std::numeric_limits<long double>::digits10 > std::numeric_limits<double>::digits10;

TEST_CASE("compare: with a constant of double, a right formula agrees to the digits of double") {
  const auto inputs = sampler(vectors<3>{}, vectors<3>{}).named("w", "v");
  const auto at_zero = [](const auto& w, const auto& v) {
    return derivative(
               [&](const auto& t) {
                 return duet::rotate(duet::from_rotation_vector((w * t).eval()), v);
               },
               0.0)
        .derivative;
  };
  const auto right = [](const auto& w, const auto& v) { return (w.cross(v) / 3 * 3).eval(); };
  const auto wrong_sign = [](const auto& w, const auto& v) { return v.cross(w).eval(); };
  const auto third = [](auto x) {
    return derivative([&](auto t) { return t * x / 3; }, 0.0F).derivative;
  };
  const auto exact_third = [](auto x) { return x / 3; };
  const comparison c =
      compare<float, double>("third", third, exact_third, sampler(real_numbers{-3, 3}));
  CHECK(c);
  CHECK(c.counts[0] == c.samples);
  CHECK(c.note == "the first function returned float where its arguments were double: a constant "
                  "made it so, as the 0.0 of derivative(f, 0.0): write T(0)");
  CHECK(compare<double, real_50>(
            "third", [](auto x) { return static_cast<double>(x / 3); }, exact_third,
            sampler(real_numbers{-3, 3}))
            .note.starts_with("the first function returned double where its arguments were "
                              "numbers of 50 digits: "));
  REQUIRE(c.errors.size() == 2);
  CHECK(c.errors[0].compared_digits == 0);
  CHECK(c.errors[1].digits == 15);
  CHECK(c.errors[1].compared_digits == 6);
  CHECK(c.errors[1].ulps < 4);
  CHECK(c.errors[1].ulps > 0.1);
  CHECK(to_text(c).find("  15 digits, compared to 6: worst error ") != std::string::npos);
  CHECK(to_text(c).find("\n  note: the first function returned float ") != std::string::npos);

  // Fewer digits in the second function, and in both.
  CHECK(compare<float, double>("third", exact_third, third, sampler(real_numbers{-3, 3}))
            .note.starts_with("the second function returned float where its arguments were"));
  CHECK(compare<float, double>(
            "third", third, [&](auto x) { return third(x) * (1 + 0x1p-23F); },
            sampler(real_numbers{-3, 3}))
            .note.starts_with("both functions returned float where their arguments were"));

  if (long_double_is_longer) {
    const comparison rotating = compare("turning", at_zero, right, inputs);
    CHECK(rotating);
    CHECK(rotating.note == note_of_first);
    CHECK(rotating.errors[1].compared_digits == 15);
  }
  CHECK(compare("turning", at_zero, wrong_sign, inputs).outcome == verdict::disagrees);
}

TEST_CASE("compare: with a constant of double, errors and lost digits are still detected") {
  const auto at_zero = [](auto w) {
    return derivative([&](const auto& t) { return w * t / 3; }, 0.0F).derivative;
  };
  const auto inputs = sampler(real_numbers{1e-8, 3});
  const auto off_by = [](double relative) {
    return [relative](auto w) { return w / 3 * (1 + relative); };
  };
  const comparison slip = compare<float, double>("slip", at_zero, off_by(0x1p-10), inputs);
  CHECK(slip.outcome == verdict::disagrees);
  CHECK(slip.counts[std::size_t(verdict::disagrees)] == slip.samples);
  CHECK(slip.note.starts_with("the first function returned float"));
  // An error that leaves more than half of the digits may be round-off: no scalar has more digits.
  CHECK(compare<float, double>("small", at_zero, off_by(0x1p-15), inputs).outcome ==
        verdict::loses_precision);
  CHECK(compare<float, double>("in T", off_by(0), off_by(0x1p-15), inputs).outcome ==
        verdict::disagrees);

  const auto cancelling = [](auto w) { return ((1 + w) - 1) / 3; };
  const comparison lost = compare<float, double>("lost", at_zero, cancelling, inputs);
  CHECK(lost.outcome == verdict::loses_precision);
  CHECK(lost.counts[std::size_t(verdict::disagrees)] == 0);
  CHECK(lost.counts[std::size_t(verdict::loses_precision)] > 0);
  // The side with fewer digits is the one that loses digits.
  const auto cancelling_at_zero = [](auto w) {
    return derivative([&](const auto& t) { return ((1 + w * (t + 1)) - (1 + w * 0.5)) / 3; }, 0.0F)
        .value;
  };
  const auto half = [](auto w) { return w / 6; };
  const comparison shorter = compare<float, double>("shorter", cancelling_at_zero, half, inputs);
  CHECK(!shorter);
  CHECK(shorter.counts[std::size_t(verdict::loses_precision)] > 0);
  CHECK(shorter.note.starts_with("the first function returned float"));
}

TEST_CASE("compare: constants are judged as they are, without a note on their type if they agree") {
  const auto two = [](auto x) { return derivative([](auto t) { return 2 * t; }, x).derivative; };
  const auto inputs = sampler(real_numbers{-3, 3});
  for (const comparison& c : {compare<double, real_50>(
                                  "2.0", two, [](auto) { return 2.0; }, inputs),
                              compare<double, real_50>(
                                  "2", two, [](auto) { return 2; }, inputs)}) {
    CHECK(c);
    CHECK(c.note.empty());
    CHECK(c.errors[1].compared_digits == 0);
  }
  for (const comparison& c : {compare<double, real_50>(
                                  "3.0", two, [](auto) { return 3.0; }, inputs),
                              compare<double, real_50>(
                                  "3", two, [](auto) { return 3; }, inputs)}) {
    CHECK(c.outcome == verdict::disagrees);
    CHECK(c.counts[std::size_t(verdict::disagrees)] == c.samples);
  }
  // An integer is exact, so it is not judged by the digits of another type.
  CHECK(compare<double, real_50>(
            "1 + 1e-18", [](auto x) { return decltype(x)(x * 0 + 1 + decltype(x)(1e-18)); },
            [](auto) { return 1; }, inputs)
            .outcome == verdict::loses_precision);
}

} // namespace
} // namespace test_comparison_verdicts
