// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/comparison/compare.hpp>
#include <duet/comparison/jacobian_slips.hpp>
#include <duet/comparison/numeric_derivative.hpp>
#include <duet/core/config.hpp>
#include <duet/core/errors.hpp>
#include <duet/core/progress.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/derivative/argument.hpp>
#include <duet/derivative/frame.hpp>
#include <duet/derivative/manifold.hpp>
#include <duet/dual/dual.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/quaternion/quaternion_order.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <iomanip>
#include <limits>
#include <optional>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

/// \file
/// Checks a handwritten Jacobian, in `double` only, and names its slip.

namespace duet {

/// Settings of `judge_jacobian`.
struct jacobian_options {
  /// Number of random inputs, half of them near special ones, in addition to the special ones and
  /// the caller's.
  std::size_t samples = 200;
  std::uint64_t seed = 1; ///< seed of the random inputs; the same seed gives the same result
  /// Side on which rotations and poses, of arguments and results, are perturbed.
  perturbation side = perturbation::right;
  /// Order of the numbers of quaternions, if the Jacobian has columns for stored numbers.
  quaternion_order order = quaternion_order::wxyz;
  double tolerance = 1000; ///< allowed error of an entry, in units of the last place of the largest
  progress_callback report = {}; ///< callback after every input; may end the run
  /// Number of last arguments for which the Jacobian has no columns, as a camera's intrinsics.
  std::size_t constants = 0;
};

/// An input at which a handwritten Jacobian is wrong.
struct jacobian_counterexample {
  std::string input{};           ///< the arguments, as text
  Eigen::Index row = 0;          ///< row of the largest error
  Eigen::Index column = 0;       ///< column of the largest error
  Eigen::MatrixXd derivative{};  ///< right Jacobian, in tangent coordinates
  Eigen::MatrixXd handwritten{}; ///< handwritten Jacobian, in tangent coordinates
};

/// Result of `judge_jacobian`.
struct jacobian_judgement {
  std::string label{};                 ///< label passed to `judge_jacobian`
  verdict outcome = verdict::agrees;   ///< worst verdict of all samples
  std::size_t samples = 0;             ///< number of inputs tried
  std::array<std::size_t, 5> counts{}; ///< number of samples of every verdict
  double worst_error = 0;              ///< largest error of an entry, of the largest entry
  std::string worst_input{};           ///< input with that error
  /// Every single slip that explains all samples; empty if none does.
  std::vector<jacobian_slip> slips{};
  std::vector<std::string> notes{}; ///< what else was found, as about manifolds of Ceres
  std::optional<jacobian_counterexample> simplest{}; ///< simplest input with the worst verdict

  /// True if the Jacobian agrees.
  [[nodiscard]] explicit operator bool() const { return outcome == verdict::agrees; }
};

/// A paragraph for people: verdict, slips, and both matrices at the simplest input.
[[nodiscard]] inline std::string to_text(const jacobian_judgement& j) {
  auto out = detail::plain_stream(3);
  detail::write_counts(out, j);
  if (j.worst_error > 0) {
    out << "  worst error: " << j.worst_error << " of the largest entry, at " << j.worst_input
        << "\n";
  }
  for (const jacobian_slip& s : j.slips) {
    out << "  slip: " << s.name << ", in " << s.block << "\n";
  }
  if (j.outcome == verdict::disagrees && j.slips.empty()) {
    out << "  no single slip explains it\n";
  }
  for (const std::string& note : j.notes) {
    out << "  note: " << note << "\n";
  }
  if (j.simplest) {
    const jacobian_counterexample& c = *j.simplest;
    counterexample entry;
    entry.automatic = {c.derivative(c.row, c.column)};
    entry.closed_form = {c.handwritten(c.row, c.column)};
    const auto [right, wrong] = detail::sides_text(entry);
    out << "  simplest input: " << c.input << "\n    entry (" << c.row << ", " << c.column
        << "): " << right << ", handwritten " << wrong << "\n";
    for (const auto& [name, matrix] :
         {std::pair("derivative", &c.derivative), std::pair("handwritten", &c.handwritten)}) {
      out << "    " << name << ":\n" << std::setprecision(4);
      for (Eigen::Index i = 0; i < matrix->rows(); ++i) {
        out << "    ";
        for (Eigen::Index k = 0; k < matrix->cols(); ++k) {
          const double x = (*matrix)(i, k);
          out << std::setw(matrix->cols() > 9 ? 10 : 11) << (std::isnan(x) ? std::abs(x) : x + 0.);
        }
        out << "\n";
      }
    }
  }
  return out.str();
}

namespace detail {
DUET_ABI_BEGIN

/// An argument or result of several parts: an array or a tuple.
template <class X>
concept JacobianParts = is_tuple<X> || requires {
  requires std::same_as<X, std::array<typename X::value_type, std::tuple_size<X>::value>>;
};
/// A rotation or a pose.
template <class X>
concept JudgedMotion = requires {
  manifold<X>::takes_rates_of_any_scalar;
};
template <class X>
concept JudgedPose = JudgedMotion<X> && manifold<X>::dimension == 6;

inline void append_part(std::vector<jacobian_part>& list, jacobian_part::kind type,
                        const std::string& name, Eigen::Index dimension) {
  list.push_back({type, name, stored_size(list), tangent_size(list), dimension});
}

/// Appends the parts of an argument or result of type X.
template <class X>
void append_parts(std::vector<jacobian_part>& list, const std::string& name) {
  using kind = jacobian_part::kind;
  if constexpr (JacobianParts<X>) {
    [&]<std::size_t... I>(std::index_sequence<I...>) {
      (append_parts<std::tuple_element_t<I, X>>(list, message(name, "[", I, "]")), ...);
    }
    (std::make_index_sequence<std::tuple_size_v<X>>{});
  } else if constexpr (EigenMatrix<X>) {
    static_assert(X::SizeAtCompileTime > 0,
                  "duet: judge_jacobian: vectors need a size known at compile time");
    append_part(list, kind::vector, name, X::SizeAtCompileTime);
  } else if constexpr (JudgedMotion<X>) {
    append_part(list, JudgedPose<X> ? kind::pose : kind::rotation, name, manifold<X>::dimension);
  } else {
    static_assert(Real<X> || Arithmetic<X>,
                  "duet: judge_jacobian: arguments and results are numbers, Eigen vectors of fixed "
                  "size, rotations, poses, and arrays and tuples of these");
    append_part(list, kind::number, name, 1);
  }
}

/// Writes the state of an argument or result from `next` on.
template <class X>
void save_state(const X& x, Eigen::VectorXd& state, Eigen::Index& next) {
  if constexpr (JacobianParts<X>) {
    std::apply([&](const auto&... each) { (save_state(each, state, next), ...); }, x);
  } else if constexpr (JudgedPose<X>) {
    save_state(rotation(x), state, next);
    save_state(translation(x), state, next);
  } else {
    static_cast<void>(map_scalars(
        [&](const auto& each) { return state[next++] = static_cast<double>(each); }, x));
  }
}

/// An argument of type X from its state, over T, of unit norm in that precision.
template <class T, class X>
[[nodiscard]] auto load_state(const Eigen::VectorXd& state, Eigen::Index& next) {
  if constexpr (JacobianParts<X>) {
    return map_elements([&]<class Each>(const Each&) { return load_state<T, Each>(state, next); },
                        X());
  } else if constexpr (JudgedPose<X>) {
    const auto q = load_state<T, decltype(rotation(std::declval<const X&>()))>(state, next);
    return pose(q, load_state<T, decltype(translation(std::declval<const X&>()))>(state, next));
  } else {
    const auto x = map_scalars([&](const auto&) { return T(state[next++]); }, X());
    if constexpr (JudgedMotion<X>) {
      return normalized(x);
    } else {
      return x;
    }
  }
}

template <class X>
[[nodiscard]] Eigen::VectorXd saved(const X& x, const std::vector<jacobian_part>& parts) {
  Eigen::VectorXd state(stored_size(parts));
  Eigen::Index next = 0;
  save_state(x, state, next);
  return state;
}

/// f and its derivative with respect to tangent coordinates of its arguments, by dual numbers if f
/// takes them, else by extrapolated central differences.
template <class F, class Arguments, class Frame>
class jacobian_truth {
  using tag = derivative_tag<F>;
  template <class T>
  using arguments = decltype(load_state<T, Arguments>(std::declval<const Eigen::VectorXd&>(),
                                                      std::declval<Eigen::Index&>()));
  template <class T>
  using lifted = decltype(manifold<arguments<T>>::plus(
      std::declval<const arguments<T>&>(),
      std::declval<const Eigen::Matrix<dual<T, 1, tag>, manifold<Arguments>::dimension, 1>&>(),
      Frame{}));
  static constexpr int size = manifold<Arguments>::dimension;

public:
  /// The scalar in which f is evaluated; `void` if f does not take dual numbers: a function that is
  /// no template, which Eigen's conversions would let pass as one.
  using scalar = std::conditional_t < std::is_pointer_v<F> || requires { &F::operator(); }
  , void, std::conditional_t < takes<F, lifted<long double>>, long double,
      std::conditional_t < takes<F, lifted<double>>, double, void >>>
      ;

  [[nodiscard]] static jacobian_evaluation at(const F& f, const Eigen::VectorXd& state,
                                              const jacobian_problem& problem) {
    const std::vector<jacobian_part>& results = problem.results;
    const Eigen::Index columns = tangent_size(problem.arguments_and_constants());
    using T = std::conditional_t<std::is_void_v<scalar>, double, scalar>;
    Eigen::Index next = 0;
    const auto x = load_state<T, Arguments>(state, next);
    const auto y = result_of_call(std::apply(f, x));
    using Y = std::decay_t<decltype(y)>;
    jacobian_evaluation out{saved(y, results), long_matrix(tangent_size(results), columns), 0};
    const auto set_column = [&](Eigen::Index k, const auto& rate) {
      const auto column = manifold<Y>::velocity(y, rate, Frame{});
      for (Eigen::Index i = 0; i < column.size(); ++i) {
        out.jacobian(i, k) = static_cast<long double>(column[i]);
      }
    };
    for (Eigen::Index k = 0; k < columns; ++k) {
      if constexpr (std::is_void_v<scalar>) {
        const auto along = [&](double h) {
          Eigen::Matrix<double, size, 1> delta = Eigen::Matrix<double, size, 1>::Zero();
          delta[k] = h;
          return result_of_call(std::apply(f, manifold<Arguments>::plus(x, delta, Frame{})));
        };
        // From several first steps, as one alone may converge by chance where f is rough.
        long_matrix rates(out.jacobian.rows(), 3);
        int next_step = 0;
        for (const double step : {.051, .073, .1}) {
          const auto rate = central_difference_derivative(along, 0., step);
          set_column(k, rate.derivative);
          rates.col(next_step++) = out.jacobian.col(k);
          out.error = std::max(out.error, rate.error);
        }
        const long_matrix spread = rates.rowwise().maxCoeff() - rates.rowwise().minCoeff();
        out.error = std::max(out.error, double(spread.maxCoeff()));
      } else {
        Eigen::Matrix<dual<T, 1, tag>, size, 1> delta;
        for (int i = 0; i < size; ++i) {
          delta[i] = dual<T, 1, tag>(T(0), T(i == k ? 1 : 0));
        }
        const auto moved = result_of_call(
            std::apply(f, manifold<std::decay_t<decltype(x)>>::plus(x, delta, Frame{})));
        set_column(k, parts<tag>(moved, 1));
      }
    }
    const Eigen::Index with_columns = tangent_size(problem.arguments);
    out.by_constants = out.jacobian.rightCols(columns - with_columns);
    out.jacobian = out.jacobian.leftCols(with_columns).eval();
    return out;
  }
};

/// A matrix from what a handwritten Jacobian returns: an Eigen matrix, matrices side by side, or
/// numbers row by row.
template <class J>
[[nodiscard]] Eigen::MatrixXd written_matrix(const J& jacobian, Eigen::Index rows) {
  if constexpr (EigenMatrix<J>) {
    return jacobian.template cast<double>();
  } else {
    Eigen::MatrixXd side_by_side;
    bool has_matrices = false;
    for_each_shaped(jacobian, [&](const auto& m) {
      if constexpr (EigenMatrix<std::decay_t<decltype(m)>>) {
        has_matrices = true;
        side_by_side.conservativeResize(rows, side_by_side.cols() + m.cols());
        require(m.rows() == rows, "duet: judge_jacobian: a matrix has ", m.rows(),
                " rows, but the function has ", rows, " results");
        side_by_side.rightCols(m.cols()) = m.template cast<double>();
      }
    });
    if (has_matrices) {
      return side_by_side;
    }
    const std::vector<double> numbers = components_of<double>(jacobian);
    require(rows > 0 && Eigen::Index(numbers.size()) % rows == 0,
            "duet: judge_jacobian: the Jacobian has ", numbers.size(), " entries for ", rows,
            " rows");
    return Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
        numbers.data(), rows, Eigen::Index(numbers.size()) / rows);
  }
}

/// Judges the samples of a Jacobian. Common to all functions.
class jacobian_judge {
public:
  jacobian_judge(const jacobian_problem& problem, const jacobian_options& options)
      : problem_(problem), options_(options) {}

  /// The function and its Jacobian at a state.
  ///
  /// \throws invalid_input if the handwritten matrix has another size
  [[nodiscard]] jacobian_sample sample_at(const Eigen::VectorXd& state) const {
    jacobian_sample s;
    s.state = state;
    s.truth = problem_.truth(state);
    s.exact = s.truth.jacobian.template cast<double>();
    s.raw = problem_.written(state);
    const Eigen::Index columns = tangent_size(problem_.arguments),
                       stored = stored_size(problem_.arguments);
    require(s.raw.rows() == s.exact.rows() && (s.raw.cols() == columns || s.raw.cols() == stored),
            "duet: judge_jacobian: the Jacobian is ", s.raw.rows(), " x ", s.raw.cols(),
            " (expected ", s.exact.rows(), " x ", columns,
            stored == columns ? "" : message(", or ", stored, " columns for stored numbers"),
            options_.constants > 0 ? "; constants have none)" : ")");
    s.written = to_tangent(problem_, state, s.raw);
    return s;
  }

  /// Verdict on a sample; sets its allowed error.
  [[nodiscard]] verdict judged(jacobian_sample& s) const {
    for (Eigen::Index i = 0; i < s.exact.size(); ++i) {
      if (std::isfinite(s.exact(i)) != std::isfinite(s.written(i))) {
        return verdict::not_finite;
      }
    }
    const double scale = largest_entry(s.exact), error = error_of(s);
    s.allowed = options_.tolerance * half_ulp * scale;
    if (s.truth.error > 0) { // differences have about eleven digits
      constexpr double digits = 1e-8;
      s.allowed = std::max(s.allowed, digits * scale);
      const verdict result = error <= s.allowed            ? verdict::agrees
                             : error <= 10 * s.truth.error ? verdict::inconclusive
                                                           : verdict::disagrees;
      s.allowed = std::max(s.allowed, 10 * s.truth.error);
      return result;
    }
    if (error > s.allowed && error < 1e-4 * scale) {
      s.allowed += rounding_effect(s);
    } else if (const double most = 1e-10 * scale; error_of(s, most) > s.allowed) {
      s.allowed = std::min(s.allowed + rounding_effect(s), most); // of other entries than the slip
    }
    return error <= s.allowed ? verdict::agrees : verdict::disagrees;
  }

  /// Allowed effect of rounded arguments on an entry.
  [[nodiscard]] double rounding_effect(const jacobian_sample& s) const {
    return options_.tolerance * half_ulp * sensitivity(s);
  }

  /// True if the largest error of a sample is round-off of the handwritten code: somewhere towards
  /// another state it is irregular, different for inputs that are almost equal. That of a slip is
  /// smooth.
  [[nodiscard]] bool is_rounding(const jacobian_sample& s, const Eigen::VectorXd& other) const {
    const auto [row, column] = position_of(s);
    if (is_irregular(s.state, row, column)) {
      return true;
    }
    for (double step = 0x1p-50; step < 1; step *= 4) {
      const Eigen::VectorXd away = step * (other - s.state);
      if (is_irregular(s.state + away, row, column) || is_rough(s.state, away, row, column)) {
        return true;
      }
    }
    return false;
  }
  /// True if the error of an entry is no smooth function of inputs on a line, unless it vanishes.
  [[nodiscard]] bool is_rough(const Eigen::VectorXd& state, const Eigen::VectorXd& away,
                              Eigen::Index row, Eigen::Index column) const {
    std::array<double, 8> errors{};
    double size = 0;
    for (std::size_t k = 0; k < errors.size(); ++k) {
      const jacobian_sample s = sample_at(state + (1 + .01 * double(k)) * away);
      if (error_of(s) <= 1e-15 * options_.tolerance * largest_entry(s.exact)) {
        return false;
      }
      errors[k] = double(s.written(row, column) - s.truth.jacobian(row, column));
      size = std::max(size, std::abs(errors[k]));
    }
    double bend = 0;
    for (std::size_t k = 2; k < errors.size(); ++k) {
      bend = std::max(bend, std::abs(errors[k] - 2 * errors[k - 1] + errors[k - 2]));
    }
    return bend > .03 * size;
  }
  /// True if the error of an entry differs between inputs that are almost equal.
  [[nodiscard]] bool is_irregular(const Eigen::VectorXd& state, Eigen::Index row,
                                  Eigen::Index column) const {
    double least = INFINITY, most = -INFINITY, size = 0, scale = 0;
    for (int k = 0; k < 5; ++k) {
      Eigen::VectorXd moved = state;
      for (Eigen::Index i = 0; i < moved.size(); ++i) {
        moved[i] *= 1 + 1e-10 * k * (double((i + k) % 3) - .9);
      }
      const jacobian_sample s = sample_at(moved);
      const double error = double(s.written(row, column) - s.truth.jacobian(row, column));
      least = std::min(least, error);
      most = std::max(most, error);
      size = std::max(size, std::abs(error));
      scale = std::max(scale, largest_entry(s.exact));
    }
    return most - least > .05 * size && size > 1e-15 * scale;
  }

  /// Row and column of the largest error.
  [[nodiscard]] static std::pair<Eigen::Index, Eigen::Index> position_of(const jacobian_sample& s) {
    Eigen::Index row = 0, column = 0;
    double largest = -1;
    for (Eigen::Index i = 0; i < s.exact.rows(); ++i) {
      for (Eigen::Index k = 0; k < s.exact.cols(); ++k) {
        const bool is_bad = std::isfinite(s.exact(i, k)) != std::isfinite(s.written(i, k));
        const double error = is_bad ? INFINITY : std::abs(s.written(i, k) - s.exact(i, k));
        if (error > largest) {
          largest = error;
          row = i;
          column = k;
        }
      }
    }
    return {row, column};
  }

  /// The largest error of a finite entry, of those up to a bound.
  [[nodiscard]] static double error_of(const jacobian_sample& s, double most = INFINITY) {
    double largest = 0;
    for (Eigen::Index i = 0; i < s.exact.size(); ++i) {
      const double error = double(std::abs(s.written(i) - s.truth.jacobian(i)));
      largest = error > largest && error <= most ? error : largest;
    }
    return largest;
  }

private:
  static constexpr double half_ulp = std::numeric_limits<double>::epsilon() / 2;

  /// Change of the Jacobian per relative change of the state; of both sides the smaller.
  [[nodiscard]] double sensitivity(const jacobian_sample& s) const {
    constexpr double step = 0x1p-20;
    const double size = std::max(s.state.cwiseAbs().maxCoeff(), 1e-30);
    double sum = 0;
    for (Eigen::Index i = 0; i < s.state.size(); ++i) {
      double change = INFINITY;
      for (const double h : {step * size, -step * size}) {
        Eigen::VectorXd moved = s.state;
        moved[i] += h;
        const Eigen::MatrixXd there = problem_.truth(moved).jacobian.template cast<double>();
        change = std::min(change, largest_entry(there - s.exact));
      }
      sum += std::isfinite(change) ? change / step : 0;
    }
    return sum;
  }

  const jacobian_problem& problem_;
  const jacobian_options& options_;
};

/// Numbers that vanish where f is zero or an identity.
[[nodiscard]] inline Eigen::VectorXd deviation_of(const jacobian_problem& problem,
                                                  Eigen::VectorXd value) {
  for (const jacobian_part& r : problem.results) {
    if (r.is_motion()) {
      const Eigen::Vector3d angle = rotation_vector(rotation_at(r, value));
      value[r.state] = 0;
      value.segment<3>(r.state + 1) = angle;
    }
  }
  return value;
}

/// A sampler of any arguments, in functions of its coordinates.
struct jacobian_inputs {
  std::function<std::string(const coordinates&)> describe{};
  std::function<bool(const coordinates&)> contains{};
  std::function<Eigen::VectorXd(const coordinates&)> state{};
};

/// Inputs at which f is nearly zero, where small rotations between arguments and constants lead to
/// branches of logarithms: found by Newton's method from some points, where f is smooth.
[[nodiscard]] inline std::vector<coordinates>
points_near_zeros(const jacobian_problem& problem, const std::vector<coordinates>& points,
                  const jacobian_inputs& inputs) {
  std::vector<coordinates> found;
  const auto moved = [](coordinates point, double factor, const Eigen::VectorXd& step) {
    for (std::size_t i = 0; i < point.size(); ++i) {
      point[i] += factor * step[Eigen::Index(i)];
    }
    return point;
  };
  const auto deviation = [&](const coordinates& point) {
    return deviation_of(problem, problem.truth(inputs.state(point)).value);
  };
  const auto jacobian = [&](const coordinates& point) {
    return Eigen::MatrixXd(problem.truth(inputs.state(point)).jacobian.template cast<double>());
  };
  const std::size_t starts = 3, first = points.size() / 2; // random ones
  const auto search = [&](const coordinates& start) {
    coordinates point = start;
    const Eigen::Index size = Eigen::Index(point.size());
    Eigen::VectorXd f = deviation(point), away = Eigen::VectorXd::Zero(size);
    for (int step = 0; step < 8 && f.norm() > 1e-11; ++step) {
      Eigen::MatrixXd slope(f.size(), size);
      for (Eigen::Index i = 0; i < size; ++i) {
        slope.col(i) = (deviation(moved(point, 1e-6, Eigen::VectorXd::Unit(size, i))) - f) / 1e-6;
      }
      const Eigen::VectorXd change = least_norm_solution(slope, f);
      point = moved(std::move(point), -1 / std::max(1., change.norm()), change);
      away += change / std::max(1., change.norm());
      if (!change.allFinite() || !inputs.contains(point)) {
        return;
      }
      f = deviation(point);
    }
    away /= std::max(largest_entry(away), 1e-9);
    const Eigen::MatrixXd here = jacobian(point);
    if (f.norm() <= 1e-11 &&
        largest_entry(jacobian(moved(point, 1e-6, away)) - here) < 1e-3 * largest_entry(here)) {
      for (const double distance : {0., 1e-9, 1e-6, 1e-4, 1e-3, 8e-3}) {
        const coordinates next = moved(point, distance, away);
        if (inputs.contains(next)) {
          found.push_back(next);
        }
      }
    }
  };
  for (std::size_t n = 0; n < starts && found.empty() && first < points.size(); ++n) {
    // f may refuse an input.
    catching<void>([&] { search(points[first + (points.size() - first) * n / starts]); }, [] {});
  }
  return found;
}

/// Constant vectors n and numbers t on which f depends by n t alone: n . df/dn = t df/dt.
[[nodiscard]] inline std::vector<std::pair<jacobian_part, jacobian_part>>
joints_of(const jacobian_problem& problem, const std::vector<jacobian_sample>& samples) {
  std::vector<std::pair<jacobian_part, jacobian_part>> found;
  for (const jacobian_part& n : problem.constants) {
    for (const jacobian_part& t : problem.arguments) {
      if (n.type == jacobian_part::kind::vector && n.dimension == 3 &&
          t.type == jacobian_part::kind::number &&
          std::all_of(samples.begin(), samples.end(), [&](const jacobian_sample& s) {
            const Eigen::MatrixXd by_axis =
                s.truth.by_constants.middleCols(n.first - tangent_size(problem.arguments), 3)
                    .template cast<double>();
            const Eigen::VectorXd difference = product_of(by_axis, s.state.segment<3>(n.state)) -
                                               s.state[t.state] * s.exact.col(t.first);
            return largest_entry(difference) <= s.allowed;
          })) {
        found.emplace_back(n, t);
      }
    }
  }
  return found;
}

[[nodiscard]] inline jacobian_judgement judged_jacobian(const std::string& label,
                                                        const jacobian_problem& problem,
                                                        std::vector<coordinates> points,
                                                        const jacobian_inputs& inputs,
                                                        const jacobian_options& options) {
  const jacobian_judge judge(problem, options);
  const std::vector<coordinates> more = points_near_zeros(problem, points, inputs);
  points.insert(points.begin(), more.begin(), more.end());
  jacobian_judgement result;
  result.label = label;
  result.samples = points.size();
  std::vector<jacobian_sample> samples;
  std::vector<verdict> verdicts;
  std::vector<std::size_t> wrong; // the largest error first
  for (std::size_t n = 0; n < points.size(); ++n) {
    samples.push_back(judge.sample_at(inputs.state(points[n])));
    verdicts.push_back(judge.judged(samples.back()));
    const progress now{n + 1, points.size()};
    if (options.report && !options.report(now) && now.done < now.count) {
      raise(cancelled(now));
    }
  }
  double scale = 0;
  for (const jacobian_sample& s : samples) {
    const double size = largest_entry(s.exact);
    scale = std::isfinite(size) ? std::max(scale, size) : scale;
  }
  for (std::size_t n = 0; n < points.size(); ++n) {
    jacobian_sample& s = samples[n];
    const double error = judge.error_of(s);
    // All entries of a Jacobian that vanishes are round-off.
    const bool vanishes = s.truth.error == 0 && largest_entry(s.exact) < 1e-9 * scale;
    if (vanishes && verdicts[n] == verdict::disagrees) {
      s.allowed += judge.rounding_effect(s);
      verdicts[n] = error <= s.allowed ? verdict::agrees : verdict::disagrees;
    }
    if (verdicts[n] == verdict::disagrees) {
      wrong.push_back(n);
    }
    const double relative = error / largest_entry(s.exact);
    if (relative > result.worst_error && std::isfinite(relative) &&
        !(vanishes && verdicts[n] == verdict::agrees)) {
      result.worst_error = relative;
      result.worst_input = inputs.describe(points[n]);
    }
  }
  std::sort(wrong.begin(), wrong.end(), [&](std::size_t a, std::size_t b) {
    const double x = judge.error_of(samples[a]) / samples[a].allowed,
                 y = judge.error_of(samples[b]) / samples[b].allowed;
    return x == y ? a < b : x > y;
  });
  // Round-off is distinguished from slips, beginning with the largest error, until one is a slip;
  // others then by what they are alone.
  const auto is_rounding = [&](std::size_t n) {
    return samples[n].truth.error == 0 && judge.is_rounding(samples[n], samples.back().state);
  };
  std::size_t first_slip = 0;
  while (first_slip < wrong.size() && is_rounding(wrong[first_slip])) {
    verdicts[wrong[first_slip++]] = verdict::loses_precision;
  }
  if (first_slip < wrong.size()) {
    std::vector<jacobian_sample> used;
    for (std::size_t n = 0; n < samples.size(); ++n) {
      if (verdicts[n] == verdict::disagrees && n != wrong[first_slip] &&
          samples[n].truth.error == 0) {
        const auto [row, column] = judge.position_of(samples[n]);
        if (judge.is_irregular(samples[n].state, row, column)) {
          verdicts[n] = verdict::loses_precision;
        }
      }
      samples[n].is_wrong = verdicts[n] == verdict::disagrees;
      if (verdicts[n] == verdict::agrees || verdicts[n] == verdict::disagrees) {
        used.push_back(samples[n]);
      }
    }
    // Where handwritten code divides by the round-off of zero, its values show no slip.
    const auto has_values = [&](const jacobian_sample& s) {
      return s.is_wrong && largest_entry(s.written) <= 1e8 * scale;
    };
    if (std::any_of(used.begin(), used.end(), has_values)) {
      std::erase_if(used, [&](const auto& s) { return s.is_wrong && !has_values(s); });
    }
    jacobian_problem with_joints = problem;
    with_joints.joints = joints_of(problem, used);
    result.slips = jacobian_slip_search(with_joints, used).found();
  }
  for (const verdict v : verdicts) {
    ++result.counts[std::size_t(v)];
    result.outcome = std::max(result.outcome, v);
  }
  if (result.outcome != verdict::agrees) {
    const std::size_t worst =
        result.outcome == verdict::disagrees
            ? wrong[first_slip]
            : std::size_t(std::find(verdicts.begin(), verdicts.end(), result.outcome) -
                          verdicts.begin());
    const coordinates simplest =
        simplified(points[worst], inputs.contains, [&](const coordinates& point) {
          jacobian_sample s = judge.sample_at(inputs.state(point));
          const verdict v = judge.judged(s);
          const bool is_disagreement =
              result.outcome == verdict::disagrees || result.outcome == verdict::loses_precision;
          return is_disagreement ? v == verdict::disagrees &&
                                       judge.error_of(s) > 1e-6 * judge.error_of(samples[worst])
                                 : v == result.outcome;
        });
    const jacobian_sample s = judge.sample_at(inputs.state(simplest));
    const auto [row, column] = judge.position_of(s);
    result.simplest =
        jacobian_counterexample{inputs.describe(simplest), row, column, s.exact, s.written};
  }
  return result;
}

/// \param results  parts of what f returns
template <class F, class J, class... Domains>
[[nodiscard]] jacobian_judgement
judged_jacobian(const std::string& label, const F& f, const J& jacobian,
                std::vector<jacobian_part> results, const sampler<Domains...>& inputs,
                const jacobian_options& options) {
  using arguments = decltype(inputs.template make<double>(std::declval<const coordinates&>()));
  using right = jacobian_truth<F, arguments, body_frame>;
  using left = jacobian_truth<F, arguments, spatial_frame>;
  jacobian_problem problem;
  problem.side = options.side;
  problem.order = options.order;
  problem.results = std::move(results);
  constexpr std::size_t count = sizeof...(Domains);
  require(options.constants < count, "duet: judge_jacobian: ", options.constants,
          " constants (expected fewer than the ", count, " arguments)");
  std::vector<jacobian_part>& parts = problem.arguments;
  std::size_t with_columns = 0;
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    ((append_parts<std::tuple_element_t<I, arguments>>(parts, inputs.names()[I]),
      with_columns = I + options.constants < count ? parts.size() : with_columns),
     ...);
  }
  (std::make_index_sequence<count>{});
  problem.constants.assign(parts.begin() + std::ptrdiff_t(with_columns), parts.end());
  parts.resize(with_columns);
  problem.truth = [&](const Eigen::VectorXd& state) {
    return options.side == perturbation::right ? right::at(f, state, problem)
                                               : left::at(f, state, problem);
  };
  problem.written = [&](const Eigen::VectorXd& state) {
    Eigen::Index next = 0;
    return written_matrix(
        result_of_call(std::apply(jacobian, load_state<double, arguments>(state, next))),
        tangent_size(problem.results));
  };
  return judged_jacobian(label, problem, inputs.points(options.samples, options.seed),
                         {[&](const coordinates& point) { return inputs.describe(point); },
                          [&](const coordinates& point) { return inputs.contains(point); },
                          [&](const coordinates& point) {
                            return saved(inputs.template make<double>(point),
                                         problem.arguments_and_constants());
                          }},
                         options);
}

DUET_ABI_END
} // namespace detail

/// Judges a handwritten Jacobian, code over `double` alone, at special and random inputs, and names
/// the slip if it is wrong.
///
/// The truth is the derivative of f by dual numbers, over `long double` where f takes any scalar;
/// for a function over `double` alone by extrapolated central differences. Arguments and results
/// are numbers, Eigen vectors, rotations, poses, and arrays and tuples of them. Rotations and poses
/// have tangent coordinates: small rotation vectors and twists [v; ω] on `options.side`.
///
/// A slip is named if it alone explains the matrices at all inputs, also at special ones; all that
/// do are listed. It explains an entry up to the tolerance and 1e-9 (with a fitted term 1e-8) of
/// the largest in its row or column, whichever is less: a bound of the round-off of products A B if
/// the condition number of A or B is below 1e6. Inverses of a condition number above 1e8 have no
/// name. Random errors, other functions and two slips are not named, except two that together equal
/// a single one, as a sign and the factor 1/2 equal the factor -1/2. Round-off is distinguished
/// from slips as it differs between inputs that are almost equal: it counts as `loses_precision`.
/// With differences, an error below their estimated error is `inconclusive`.
///
/// \param label     name of the judgement in the report
/// \param f         the function of the arguments, best a template over their scalar
/// \param jacobian  the handwritten Jacobian, a function of the same arguments over `double`: an
///   Eigen matrix, a tuple or array of matrices side by side, or numbers row by row. Its columns
///   are tangent coordinates or, if there are that many, stored numbers: four of a rotation, in
///   `options.order`, and seven of a pose, translation first. There are none for the last
///   `options.constants` arguments: constants, by which slips are named as well.
/// \param inputs    a `sampler` of the arguments
/// \throws invalid_input if the matrix has another size, or no argument has columns
/// \throws cancelled if `options.report` returns `false`
///
/// Example: `judge_jacobian("rotated point", [](const auto& q, const auto& p) { return rotate(q,
/// p);
/// }, my_jacobian, sampler(rotations{}, vectors<3>{1}).named("q", "p"))`
template <class F, class J, class... Domains>
[[nodiscard]] jacobian_judgement
judge_jacobian(const std::string& label, const F& f, const J& jacobian,
               const sampler<Domains...>& inputs, const jacobian_options& options = {}) {
  using arguments = decltype(inputs.template make<double>(std::declval<const coordinates&>()));
  static_assert(detail::takes<J, arguments>,
                "duet: judge_jacobian: the Jacobian must take one argument of each domain of the "
                "sampler, over double");
  using truth = detail::jacobian_truth<F, arguments, body_frame>;
  static_assert(!std::is_void_v<typename truth::scalar> || detail::takes<F, arguments>,
                "duet: judge_jacobian: the function must take one argument of each domain of the "
                "sampler");
  using result = std::decay_t<decltype(detail::result_of_call(
      std::apply(f, std::declval<const arguments&>())))>;
  std::vector<detail::jacobian_part> results;
  detail::append_parts<result>(results, "f");
  return detail::judged_jacobian(label, f, jacobian, std::move(results), inputs, options);
}

} // namespace duet
