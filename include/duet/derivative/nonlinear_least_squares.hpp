// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/core/structure.hpp>
#include <duet/derivative/argument.hpp>
#include <duet/derivative/least_squares.hpp>
#include <duet/derivative/levenberg_marquardt.hpp>
#include <duet/derivative/manifold.hpp>
#include <duet/derivative/parameters.hpp>
#include <duet/dual/level.hpp>
#include <duet/dual/taylor.hpp>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

/// \file
/// Nonlinear least squares over scalars, vectors, rotations and poses.

namespace duet {

/// Loss ρ(r) of the size r of a residual: r²/2 near zero, less for outliers.
struct loss_function {
  enum class kind { squares, huber, cauchy, tukey }; ///< forms of losses
  kind form = kind::squares;                         ///< form of the loss
  double scale = 1; ///< size k of a residual from which it counts less, in its unit

  /// ρ(r) = r²/2
  [[nodiscard]] static constexpr loss_function squares() { return {}; }
  /// ρ(r) = r²/2 up to k, k (r − k/2) beyond.
  [[nodiscard]] static constexpr loss_function huber(double k) { return {kind::huber, k}; }
  /// ρ(r) = (k²/2) log(1 + (r/k)²)
  [[nodiscard]] static constexpr loss_function cauchy(double k) { return {kind::cauchy, k}; }
  /// ρ(r) = (k²/6) (1 − (1 − (r/k)²)³) up to k, the constant k²/6 beyond: such residuals do not
  /// count (Tukey's biweight).
  [[nodiscard]] static constexpr loss_function tukey(double k) { return {kind::tukey, k}; }
};

/// Options of `nonlinear_least_squares`.
struct nonlinear_least_squares_options {
  loss_function loss = loss_function::squares(); ///< loss of each residual
  /// Relative weights wᵢ > 0 of the residuals; empty, the default: all equal.
  std::vector<double> weights = {};
  /// Covariance matrices Σᵢ of the residuals, or one for all, k × k for residuals of k components.
  /// Residuals, and with them the scale of the loss, are then |Lᵢ⁻¹ rᵢ| in standard deviations,
  /// Σᵢ = Lᵢ Lᵢᵀ. Empty, the default: errors of one size, which follows from the residuals.
  std::vector<Eigen::MatrixXd> covariances = {};
  /// Bounds of the parameters in the order of their tangent coordinates, infinite for rotations
  /// and poses; empty, the default: none.
  Eigen::VectorXd lower = {}, upper = {};
  int max_iterations = 1000; ///< maximum number of iterations
};

/// Result of `nonlinear_least_squares`.
template <class X>
struct nonlinear_least_squares_result {
  X estimate = detail::zero_initialized<X>(); ///< the parameters that minimise the cost
  Eigen::VectorXd residuals = {};             ///< f(estimate), its components one after the other
  double cost = 0;                            ///< Σ wᵢ ρ(|rᵢ|), half the sum of squares
  int iterations = 0;                         ///< number of steps
  least_squares_stop reason = least_squares_stop::iteration_limit; ///< termination reason
  /// Covariance of the estimate in tangent coordinates, n × n, of rotations (rad) and poses
  /// ([v; ω]) in body axes: of the errors that those of the residuals cause to first order.
  /// σ²(JᵀJ)⁻¹ with σ² = 2 cost/degrees of freedom, NaN without any; (JᵀJ)⁻¹ of whitened residuals
  /// if there are covariances; with a robust loss H⁻¹(Σ gᵢgᵢᵀ)H⁻¹ (sandwich) of the gradients gᵢ of
  /// single losses, corrected for the number of parameters. Zero for parameters at a bound;
  /// infinite variances for those in `undetermined`.
  Eigen::MatrixXd covariance = {};
  int degrees_of_freedom = 0; ///< number of components less the rank of the Jacobian
  /// Names of the parameters that the residuals do not determine, alone or together with others:
  /// the columns of the Jacobian that depend on each other.
  std::vector<std::string> undetermined = {};

  /// True if the estimate is a minimum to round-off.
  [[nodiscard]] bool converged() const {
    return reason == least_squares_stop::small_step || reason == least_squares_stop::small_decrease;
  }

  /// For those who extend duet: for `to_text`.
  void for_each_field(const auto& f) const {
    f("residuals", residuals);
    f("cost", cost);
    f("iterations", iterations);
    f("reason", to_text(reason));
    f("degrees_of_freedom", degrees_of_freedom);
  }
};

namespace detail {

template <class F, class X, class R = double>
class nonlinear_least_squares_problem;
template <class Y>
struct residual_blocks;

} // namespace detail

/// Minimises Σ wᵢ ρ(|rᵢ(x)|) over x by damped least squares (Levenberg–Marquardt) with exact
/// derivatives.
///
/// \param f      residuals, a function of any scalar: f(x) returns a scalar, or a vector of
///   residuals; a vector, array or `std::vector` of fixed-size vectors has residuals of several
///   components, whose norms the loss takes
/// \param start  initial estimate: a scalar, vector, rotation, pose, or an array, `std::vector` or
///   tuple of them; f takes the elements of a tuple as its arguments
///
/// Rotations and poses move in their tangent spaces, q exp(δ/2), from which they never leave the
/// unit sphere. Scalars and components of vectors may have bounds. Each iteration evaluates f over
/// dual numbers, solves the linear problem by QR of the Jacobian, scaled by its columns (Moré
/// 1978), and takes the damping from the gain ratio. The iteration goes on until steps are down
/// to round-off, so that the estimate is as exact as its condition allows.
///
/// Time grows with the square of the number of parameters, about 200 at most; for large sparse
/// problems use Ceres.
///
/// Where the Jacobian vanishes, as at a maximum of the cost, no step follows: `undetermined` then
/// names the parameters.
///
/// \throws invalid_input for options of wrong size or value, a start out of bounds, fewer residuals
///   than one, and residuals or derivatives that are not finite at the start
///
/// Example: `nonlinear_least_squares([](const auto& x) { return x * x - 2; }, 1.0).estimate` is √2.
template <detail::FunctionOfAny F, class X>
  requires detail::ParameterSet<detail::own_t<X>>
[[nodiscard]] nonlinear_least_squares_result<detail::own_t<X>>
nonlinear_least_squares(const F& f, const X& start,
                        const nonlinear_least_squares_options& options = {}) {
  static_assert(
      requires {
        detail::residual_blocks<
            std::decay_t<decltype(detail::result_of_call(detail::call(f, start)))>>::block_size;
      },
      "duet: nonlinear_least_squares: the function must return a scalar, a vector of residuals, or "
      "a vector of fixed-size vectors");
  detail::nonlinear_least_squares_problem<F, detail::own_t<X>> problem(f, start, options);
  return problem.minimised();
}

template <detail::FunctionOfAny F, class X, class... Options>
  requires(!detail::ParameterSet<detail::own_t<X>>)
DUET_REFUSED("nonlinear_least_squares: the start must be a double, an Eigen vector of double, a "
             "rotation, a pose, or an array, std::vector or tuple of these")
nonlinear_least_squares_result<Eigen::VectorXd> nonlinear_least_squares(const F&, const X&,
                                                                        const Options&...);
template <detail::FunctionOfAny F, class A, class B, class... More>
  requires(detail::ParameterSet<detail::own_t<A>>&& detail::ParameterSet<detail::own_t<B>>)
DUET_REFUSED("pass several parameters as a tuple: nonlinear_least_squares(f, std::tuple(a, b))")
nonlinear_least_squares_result<Eigen::VectorXd> nonlinear_least_squares(const F&, const A&,
                                                                        const B&, const More&...);
template <detail::FunctionOfReals F, class... X>
DUET_REFUSED_FUNCTION(nonlinear_least_squares)
nonlinear_least_squares_result<Eigen::VectorXd> nonlinear_least_squares(const F&, const X&...);

namespace detail {

/// Loss, weight ρ′(r)/r and curvature ρ″(r) of a residual of size r.
struct loss_at {
  double loss, weight, curvature;
};
[[nodiscard]] inline loss_at loss_of(const loss_function& f, double r) {
  const double k = f.scale, s = r / k, t = std::max(0., 1 - s * s), u = 1 / (1 + s * s);
  return f.form == loss_function::kind::tukey
             ? loss_at{k * k / 6 * (1 - t * t * t), t * t, t * (1 - 5 * s * s)}
         : f.form == loss_function::kind::cauchy
             ? loss_at{k * k / 2 * std::log1p(s * s), u, (1 - s * s) * u * u}
         : f.form == loss_function::kind::huber && r > k ? loss_at{k * (r - k / 2), k / r, 0}
                                                         : loss_at{r * r / 2, 1, 1};
}

/// Residuals as blocks of components.
template <VectorLike Y>
struct residual_blocks<Y> {
  static constexpr int block_size = 1;
  static Eigen::Index count(const Y& y) { return vector_argument<Y>::size(y); }
  static const auto& component(const Y& y, Eigen::Index i) { return detail::component(y, i); }
};
template <class Y>
  requires(Scalar<Y> || Arithmetic<Y>)
struct residual_blocks<Y> {
  static constexpr int block_size = 1;
  static Eigen::Index count(const Y&) { return 1; }
  static const Y& component(const Y& y, Eigen::Index) { return y; }
};
template <class Y>
  requires EigenMatrix<typename Y::value_type>
struct residual_blocks<Y> {
  static constexpr int block_size = Y::value_type::SizeAtCompileTime;
  static_assert(block_size > 0,
                "duet: nonlinear_least_squares: residuals must be vectors of fixed size");
  static Eigen::Index count(const Y& y) { return Eigen::Index(y.size()); }
  static const auto& component(const Y& y, Eigen::Index i) {
    return y[std::size_t(i / block_size)](i % block_size);
  }
};

/// The problem in tangent coordinates at the estimate, for `levenberg_marquardt`.
///
/// \tparam R  scalar of the linear problem: as a parameter its matrices compile only where used
template <class F, class X, class R>
class nonlinear_least_squares_problem {
  using vector = Eigen::VectorX<R>;
  using matrix = Eigen::MatrixX<R>;
  using tag = tag_for<void, F>;
  using set = parameters<X>;
  static constexpr int dimension = manifold<X>::dimension;
  static constexpr int partials =
      dimension > 0 && dimension <= single_pass_limit ? dimension : chunk;
  using variable = dual<double, partials, tag>;
  using options_type = nonlinear_least_squares_options;
  static constexpr int block_size = residual_blocks<std::decay_t<decltype(result_of_call(
      call(std::declval<const F&>(), std::declval<const X&>())))>>::block_size;

public:
  nonlinear_least_squares_problem(const F& f, const X& start, const options_type& options)
      : f_(f), x_(start), options_(options), size_(tangent_dimension(start)),
        lower_(bound("lower", options.lower, -std::numeric_limits<double>::infinity())),
        upper_(bound("upper", options.upper, std::numeric_limits<double>::infinity())),
        scale_(vector::Zero(size_)) {
    require(size_ > 0, "duet: nonlinear_least_squares: there are no parameters");
    require(options.loss.scale > 0 && std::isfinite(options.loss.scale),
            "duet: nonlinear_least_squares: the scale of the loss is ", options.loss.scale,
            " (expected a finite positive number)");
    const vector values = values_of(start);
    for (Eigen::Index i = 0; i < size_; ++i) {
      const bool has_bounds = lower_[i] > -std::numeric_limits<double>::infinity() ||
                              upper_[i] < std::numeric_limits<double>::infinity();
      require(!has_bounds || (lower_[i] <= values[i] && values[i] <= upper_[i]),
              "duet: nonlinear_least_squares: ", name(i), " is ", values[i],
              ", outside its bounds, ", lower_[i], " to ", upper_[i],
              " (rotations and poses cannot have bounds)");
    }
  }

  [[nodiscard]] nonlinear_least_squares_result<X> minimised() {
    const double cost = linearise();
    for (Eigen::Index i = 0; i < residuals_.size(); ++i) {
      const Eigen::Index residual = i / block_size;
      require(std::isfinite(residuals_[i]), "duet: nonlinear_least_squares: residual ", residual,
              " is ", residuals_[i], " at the start");
      for (Eigen::Index k = 0; k < size_; ++k) {
        require(std::isfinite(jacobian_(i, k)), "duet: nonlinear_least_squares: residual ",
                residual, " has the derivative ", jacobian_(i, k), " with respect to ", name(k),
                " at the start");
      }
    }
    require(std::isfinite(cost), "duet: nonlinear_least_squares: the cost is ", cost,
            " at the start");
    const double rounding =
        8 * std::numeric_limits<double>::epsilon() * std::sqrt(double(residuals_.size()));
    const descent<double> d =
        levenberg_marquardt<double>(*this, {options_.max_iterations, 1e-3, rounding});
    nonlinear_least_squares_result<X> result;
    is_final_ = options_.loss.form != loss_function::kind::squares;
    result.cost = linearise();
    result.estimate = x_;
    result.residuals = residuals_;
    result.iterations = d.iterations;
    result.reason = d.reason;
    set_covariance(result);
    return result;
  }

  /// Residuals and Jacobian at the estimate, reduced to R of J = Q R and Qᵀr; returns the cost.
  [[nodiscard]] double linearise() {
    matrix& jacobian = jacobian_;
    for (Eigen::Index first = 0; first < size_; first += partials) {
      const auto y = result_of_call(call(f_, set::at(x_, 0, [&](double value, Eigen::Index k) {
                                           return first <= k && k < first + partials
                                                      ? variable::variable(value, int(k - first))
                                                      : variable(value);
                                         })));
      using blocks = residual_blocks<std::decay_t<decltype(y)>>;
      const Eigen::Index rows = blocks::count(y) * blocks::block_size;
      if (first == 0) {
        set_residuals(y);
        jacobian.resize(rows, size_);
      }
      for (Eigen::Index i = 0; i < rows; ++i) {
        for (int k = 0; k < partials && first + k < size_; ++k) {
          jacobian(i, first + k) = part<tag>(blocks::component(y, i), k + 1);
        }
      }
    }
    const double cost = weigh(&jacobian);
    for (Eigen::Index k = 0; k < size_; ++k) {
      scale_[k] = std::max(.7 * scale_[k], jacobian.col(k).norm());
    }
    gradient_ = jacobian.transpose() * weighted_;
    matrix both(jacobian.rows(), size_ + 1);
    both << jacobian, weighted_;
    const Eigen::HouseholderQR<matrix> qr(both);
    const Eigen::Index rows = std::min(size_, both.rows());
    const matrix r = qr.matrixQR().topRows(rows).template triangularView<Eigen::Upper>();
    r_ = r.leftCols(size_);
    right_ = r.col(size_);
    return cost;
  }

  /// The step that minimises |r + J δ|² + λ |D δ|² within the bounds.
  [[nodiscard]] bool solve(double damping) {
    const vector values = values_of(x_);
    const Eigen::Index rows = r_.rows(), more = damping > 0 ? size_ : 0;
    std::vector<bool> is_fixed(std::size_t(size_), false);
    step_ = vector::Zero(size_);
    for (Eigen::Index k = 0; k < size_; ++k) {
      is_fixed[std::size_t(k)] = scale_[k] == 0 || is_held(values, k);
    }
    for (bool is_within = false; !is_within;) {
      matrix a = matrix::Zero(rows + more, size_);
      vector b = vector::Zero(rows + more);
      b.head(rows) = -right_;
      for (Eigen::Index k = 0; k < size_; ++k) {
        if (is_fixed[std::size_t(k)]) {
          b.head(rows) -= r_.col(k) * step_[k];
        } else {
          a.col(k).head(rows) = r_.col(k) / scale_[k];
        }
        if (more > 0) {
          a(rows + k, k) = std::sqrt(damping);
        }
      }
      const Eigen::ColPivHouseholderQR<matrix> qr(a);
      vector y = qr.solve(b);
      for (Eigen::Index k = 0; k < size_; ++k) {
        step_[k] = is_fixed[std::size_t(k)] ? step_[k] : y[k] / scale_[k];
      }
      if (damping > 0) {
        const vector bend = acceleration(qr, is_fixed);
        if (!(bend.norm() <= max_bend * y.norm())) {
          return false;
        }
        y += bend;
      }
      is_within = true;
      for (Eigen::Index k = 0; k < size_; ++k) {
        if (is_fixed[std::size_t(k)]) {
          continue;
        }
        step_[k] = y[k] / scale_[k];
        const double next = values[k] + step_[k];
        if (next < lower_[k] || next > upper_[k]) {
          step_[k] = (next < lower_[k] ? lower_[k] : upper_[k]) - values[k];
          is_fixed[std::size_t(k)] = true;
          is_within = false;
        }
      }
    }
    return step_.allFinite();
  }

  [[nodiscard]] bool solve_better() { return false; }

  /// Largest change of a parameter relative to its size, for rotations in radians.
  [[nodiscard]] double step_size() const {
    const vector values = values_of(x_);
    double result = 0;
    for (Eigen::Index k = 0; k < size_; ++k) {
      const double size = std::max(std::abs(values[k]), std::numeric_limits<double>::min());
      result = std::max(result, std::abs(step_[k]) / (std::isnan(values[k]) ? 1 : size));
    }
    return result;
  }
  [[nodiscard]] double predicted_decrease() const {
    return -gradient_.dot(step_) - (r_ * step_).squaredNorm() / 2;
  }
  [[nodiscard]] double cost_after_step() {
    next_ = moved();
    set_residuals(result_of_call(call(f_, next_)));
    return weigh(nullptr);
  }
  void accept() { x_ = next_; }

private:
  /// Largest length of the second-order correction of a step, relative to the step.
  static constexpr double max_bend = .2;

  /// The estimate after the step.
  [[nodiscard]] X moved() const {
    X result = set::at(x_, 0, [&](double value, Eigen::Index k) {
      for (const double bound : {lower_[k], upper_[k]}) {
        if (step_[k] == bound - value) {
          return bound; // exactly, which the sum need not be
        }
      }
      return value + step_[k];
    });
    normalise(result);
    return result;
  }

  /// Second-order correction a/2 of the step δ, J a = −r″ of the second derivative r″ along δ
  /// (geodesic acceleration, Transtrum and Sethna 2012), scaled as the columns; `qr` is that of the
  /// damped Jacobian.
  [[nodiscard]] vector acceleration(const Eigen::ColPivHouseholderQR<matrix>& qr,
                                    const std::vector<bool>& is_fixed) const {
    using along_step = taylor<double, 2, tag>;
    const auto y = result_of_call(call(f_, set::at(x_, 0, [&](double value, Eigen::Index k) {
                                         return value + step_[k] * along_step::variable(0.);
                                       })));
    using blocks = residual_blocks<std::decay_t<decltype(y)>>;
    constexpr int size = blocks::block_size;
    vector second(residuals_.size());
    for (Eigen::Index i = 0; i < second.size(); ++i) {
      second[i] = part<tag>(blocks::component(y, i), 2);
    }
    for (Eigen::Index i = 0; i < second.size() / size; ++i) {
      auto its = second.template segment<size>(i * size);
      whiten(i, its);
      its *= roots_[i];
    }
    vector right = -(jacobian_.transpose() * second) / 2;
    for (Eigen::Index k = 0; k < size_; ++k) {
      right[k] = is_fixed[std::size_t(k)] ? 0 : right[k] / scale_[k];
    }
    return solve_normal_equations(qr, right);
  }

  /// Values of scalars and components of vectors; NaN for rotations and poses.
  [[nodiscard]] vector values_of(const X& x) const {
    vector result(size_);
    set::values(x, result, 0);
    return result;
  }
  [[nodiscard]] std::string name(Eigen::Index k) const {
    const std::string result = set::name(x_, k);
    return result.empty() ? "the parameter" : result[0] == ' ' ? result.substr(1) : result;
  }
  /// True if parameter k is at a bound beyond which the cost decreases.
  [[nodiscard]] bool is_held(const vector& values, Eigen::Index k) const {
    return (values[k] <= lower_[k] && gradient_[k] > 0) ||
           (values[k] >= upper_[k] && gradient_[k] < 0);
  }

  /// Takes the values of residuals, over any scalar.
  template <class Y>
  void set_residuals(const Y& y) {
    using blocks = residual_blocks<Y>;
    const Eigen::Index count = blocks::count(y);
    if (residuals_.size() == 0) {
      require(count > 0, "duet: nonlinear_least_squares: the function returns no residuals");
      require_weights("nonlinear_least_squares", options_.weights, std::size_t(count), "residuals");
      whitening_ = inverse_roots<matrix>("nonlinear_least_squares", options_.covariances,
                                         std::size_t(count), block_size, "residuals");
      residuals_.resize(count * block_size);
    }
    require(count * block_size == residuals_.size(),
            "duet: nonlinear_least_squares: the number of residuals changed from ",
            residuals_.size() / block_size, " to ", count);
    for (Eigen::Index i = 0; i < residuals_.size(); ++i) {
      residuals_[i] = double(part<tag>(blocks::component(y, i), 0));
    }
  }

  /// Whitens residuals, and the Jacobian if there is one, and scales both by the loss; returns the
  /// cost. (Triggs et al. 2000: curvature along a residual is ρ″, not less than a tenth of ρ′/r, so
  /// that the matrix stays positive definite.)
  [[nodiscard]] double weigh(matrix* jacobian) {
    constexpr int size = block_size;
    const Eigen::Index count = residuals_.size() / size;
    weighted_.resize(count * size);
    roots_.resize(count);
    double cost = 0;
    for (Eigen::Index i = 0; i < count; ++i) {
      Eigen::Matrix<R, size, 1> r = residuals_.template segment<size>(i * size);
      whiten(i, r);
      const double length = r.norm();
      const double weight = options_.weights.empty() ? 1 : options_.weights[std::size_t(i)];
      const loss_at loss = loss_of(options_.loss, length);
      cost += weight * loss.loss;
      if (jacobian == nullptr) {
        continue;
      }
      auto rows = jacobian->template middleRows<size>(i * size);
      whiten(i, rows);
      const double root = roots_[i] = std::sqrt(weight * loss.weight);
      rows *= root;
      weighted_.template segment<size>(i * size) = root * r;
      if (loss.weight > 0 && loss.curvature != loss.weight) {
        const double ratio = std::sqrt(std::max(.1, loss.curvature / loss.weight));
        const Eigen::Matrix<R, size, 1> u = r / length;
        rows += (ratio - 1) * u * (u.transpose() * rows).eval();
        weighted_.template segment<size>(i * size) /= ratio;
        if (is_final_) {
          const vector along = rows.transpose() * u;
          curvature_change_ +=
              (loss.curvature / (loss.weight * ratio * ratio) - 1) * along * along.transpose();
        }
      }
      if (is_final_) {
        gradient_bias_.add(length, size, weight, loss.weight, loss.curvature);
        const vector gradient = rows.transpose() * weighted_.template segment<size>(i * size);
        gradient_squares_ += gradient * gradient.transpose();
      }
    }
    return cost;
  }

  /// Covariance, degrees of freedom and undetermined parameters at the estimate.
  void set_covariance(nonlinear_least_squares_result<X>& result) const {
    const double infinity = std::numeric_limits<double>::infinity();
    const vector values = values_of(x_);
    std::vector<Eigen::Index> free; // columns of R
    for (Eigen::Index k = 0; k < size_; ++k) {
      if (!is_held(values, k)) {
        free.push_back(k);
      }
    }
    result.degrees_of_freedom = int(residuals_.size());
    result.covariance = matrix::Zero(size_, size_);
    if (free.empty()) {
      return;
    }
    const Eigen::Index n = Eigen::Index(free.size());
    vector units(n);
    for (Eigen::Index k = 0; k < n; ++k) {
      const double scale = r_.col(free[std::size_t(k)]).norm();
      units[k] = scale > 0 ? 1 / scale : 1;
    }
    Eigen::ColPivHouseholderQR<matrix> qr(r_.rows(), n);
    qr.setThreshold(1e3 * double(n) * std::numeric_limits<double>::epsilon());
    qr.compute(r_(Eigen::all, free) * units.asDiagonal());
    const Eigen::Index rank = qr.rank();
    const auto position = qr.colsPermutation().indices();
    const auto top =
        qr.matrixQR().topLeftCorner(rank, rank).template triangularView<Eigen::Upper>();
    // Columns of the null space are [−R₁⁻¹ R₂; I].
    const matrix dependence = top.solve(qr.matrixQR().topRightCorner(rank, n - rank));
    std::vector<bool> is_undetermined(std::size_t(n), false);
    for (Eigen::Index k = 0; k < n; ++k) {
      is_undetermined[std::size_t(position[k])] =
          k >= rank || dependence.row(k).cwiseAbs().sum() > 1e-6;
    }
    std::vector<Eigen::Index> kept; // parameters of the independent columns
    for (Eigen::Index k = 0; k < rank; ++k) {
      kept.push_back(free[std::size_t(position[k])]);
    }
    const vector scale = units(position.head(rank));
    const matrix identity = matrix::Identity(rank, rank);
    const double components = double(residuals_.size()), freedom = components - double(rank);
    matrix inverse;
    if (options_.loss.form == loss_function::kind::squares) {
      inverse = top.solve(identity);
      inverse *= inverse.transpose().eval(); // (RᵀR)⁻¹
      inverse *= !whitening_.empty() ? 1
                 : freedom > 0       ? 2 * result.cost / freedom
                                     : std::numeric_limits<double>::quiet_NaN();
    } else if (rank > 0) { // sandwich H⁻¹ (Σ gᵢgᵢᵀ) H⁻¹ of the gradients gᵢ of single losses
      const auto scaled = [&](const matrix& m) -> matrix {
        return scale.asDiagonal() * m(kept, kept) * scale.asDiagonal();
      };
      const matrix h = scaled(r_.transpose() * r_ + curvature_change_);
      inverse = Eigen::ColPivHouseholderQR<matrix>(h).solve(identity);
      inverse = inverse * scaled(gradient_squares_) * inverse.transpose();
      inverse *= gradient_bias_.factor(double(rank));
    }
    result.degrees_of_freedom = int(freedom);
    result.covariance(kept, kept) = scale.asDiagonal() * inverse * scale.asDiagonal();
    for (Eigen::Index k = 0; k < n; ++k) {
      if (is_undetermined[std::size_t(k)]) {
        const Eigen::Index at = free[std::size_t(k)];
        result.covariance.row(at).setZero();
        result.covariance.col(at).setZero();
        result.covariance(at, at) = infinity;
        result.undetermined.push_back(name(at));
      }
    }
  }

  /// Whitens the components of residual i, or their derivatives.
  template <class Rows>
  void whiten(Eigen::Index i, Rows& rows) const {
    if (!whitening_.empty()) {
      rows = (whitening_[whitening_.size() > 1 ? std::size_t(i) : 0] * rows).eval();
    }
  }

  [[nodiscard]] vector bound(const char* name, const vector& given, double none) const {
    require(given.size() == 0 || given.size() == size_, "duet: nonlinear_least_squares: ", name,
            " has ", given.size(), " entries for ", size_, " parameters");
    for (Eigen::Index i = 0; i < given.size(); ++i) {
      require(!std::isnan(given[i]), "duet: nonlinear_least_squares: ", name, "[", i, "] is ",
              given[i]);
    }
    return given.size() > 0 ? given : vector(vector::Constant(size_, none));
  }

  const F& f_;
  X x_, next_ = x_;
  options_type options_;
  Eigen::Index size_;
  std::vector<matrix> whitening_; ///< L⁻¹ of the covariances L Lᵀ
  vector lower_, upper_;
  vector residuals_, weighted_; ///< components of f; whitened and scaled by the loss
  vector roots_;                ///< √(wᵢ ρ′/r)
  matrix jacobian_;             ///< of `weighted_`
  matrix r_;                    ///< R of the QR decomposition of the Jacobian
  vector right_, gradient_;     ///< Qᵀr, Jᵀr
  vector scale_;                ///< largest norms of columns of the Jacobian so far
  vector step_;
  bool is_final_ = false; ///< true to compute these, for the covariance
  gradient_bias<double> gradient_bias_;
  /// Σ gᵢgᵢᵀ of the gradients of single losses; H − JᵀJ, H with the curvature of the loss
  matrix gradient_squares_ = matrix::Zero(size_, size_), curvature_change_ = gradient_squares_;
};

} // namespace detail
} // namespace duet
