// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/errors.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/derivative/levenberg_marquardt.hpp>
#include <duet/derivative/manifold.hpp>
#include <duet/dual_quaternion/exponential_jacobian.hpp>
#include <duet/dual_quaternion/twist.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/exponential_jacobian.hpp>
#include <duet/quaternion/norm.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/rotation.hpp>
#include <duet/quaternion/three_vector.hpp>
#include <duet/spline/basis.hpp>
#include <duet/spline/blocks.hpp>
#include <duet/spline/cumulative_bspline.hpp>
#include <duet/spline/fit_start.hpp>
#include <duet/spline/fit_statistics.hpp>
#include <duet/spline/interpolate.hpp>
#include <duet/spline/matrix_rows.hpp>
#include <duet/spline/orientations.hpp>
#include <duet/spline/product_jacobian.hpp>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

/// \file
/// Least-squares fit of curves to rotations or poses: fewer control points than samples, noise
/// smoothed out.

namespace duet {

/// Options of `fit`.
struct fit_options {
  /// Characteristic length: distance between poses that counts as much as a rotation by 1 rad.
  double characteristic_length = 1;
  /// Outlier threshold, in the unit of the residuals. Larger residuals count by their size, not by
  /// their square (Huber's loss). Samples farther off than four times the threshold and twelve
  /// times the median of their neighbours are ignored, so that outliers, however far, do not move
  /// the curve. 0: three times the median residual. Infinity, the default: plain least squares.
  double outlier_threshold = std::numeric_limits<double>::infinity();
  /// Relative weights wᵢ > 0 of the samples; empty, the default: all equal.
  std::vector<double> weights = {};
  /// Covariance matrices Σᵢ of the samples' errors, or one for all: 3 × 3 of rotation vectors in
  /// the sample's body axes, rad²; for poses 6 × 6 of twists [v; ω] there. Residuals, and with them
  /// `outlier_threshold`, are then |Lᵢ⁻¹ rᵢ| in standard deviations, Σᵢ = Lᵢ Lᵢᵀ, and
  /// `characteristic_length` has no effect. Empty, the default: errors of one size.
  std::vector<Eigen::MatrixXd> covariances = {};
  int max_iterations = 100;      ///< maximum number of Levenberg–Marquardt iterations
  bool keeps_covariance = false; ///< true to make `fit_result::covariance` available
};

/// Fitted curve and the distances of the samples from it.
template <CurveType Spline>
struct fit_result {
  using real_type = typename Spline::real_type;
  using covariance_type = curve_covariance<Spline>;
  Spline curve; ///< fitted curve, with the given knots
  /// Residual |2 log(S(uᵢ)* Qᵢ)| of each sample: in radians; for poses the root of the sum of
  /// squares of the angle and (distance/characteristic length); with `fit_options::covariances` in
  /// standard deviations.
  std::vector<real_type> residuals;
  real_type rms;  ///< root of the weighted mean square of `residuals`, outliers included
  int iterations; ///< number of Levenberg–Marquardt iterations
  real_type
      outlier_threshold; ///< outlier threshold in effect: larger residuals counted as outliers
  real_type inlier_rms;  ///< as `rms`, of the residuals up to `outlier_threshold`
  /// Number of components of the samples that count, less those of the control points.
  int degrees_of_freedom;
  /// A sentence if the residuals are not random: they change their signs too rarely for
  /// independent errors (runs test), as they do if the knots are too wide for the motion. Else
  /// empty.
  std::string remark;
  /// For those who extend duet: terms of the covariance, with `fit_options::keeps_covariance`.
  std::optional<
      detail::sandwich_terms<real_type, covariance_type::dimension, std::size_t(Spline::order) - 1>>
      terms;

  /// Covariance of the control points and the motion, to first order in the errors:
  /// σ²(JᵀWJ)⁻¹ with σ² = Σ wᵢ|rᵢ|²/`degrees_of_freedom`, NaN without any; (JᵀJ)⁻¹ of whitened
  /// residuals if there are covariances; with a finite outlier threshold H⁻¹(Σ gᵢgᵢᵀ)H⁻¹
  /// (sandwich) of the gradients gᵢ of single losses, corrected for the number of control points,
  /// and the Hessian H of their sum.
  ///
  /// \throws invalid_input without `fit_options::keeps_covariance`
  [[nodiscard]] covariance_type covariance() const {
    detail::require(terms.has_value(), "duet: fit_result: there is no covariance (set ",
                    "fit_options::keeps_covariance)");
    return {curve, terms->covariance()};
  }

  /// For those who extend duet: for `to_text`.
  void for_each_field(const auto& f) const {
    f("residuals", residuals);
    f("rms", rms);
    f("iterations", iterations);
    f("outlier_threshold", outlier_threshold);
    f("inlier_rms", inlier_rms);
    f("degrees_of_freedom", degrees_of_freedom);
    f("remark", remark);
  }
};

namespace detail {

template <class T, int Order>
class bspline_fit;

/// Checks the Schoenberg–Whitney condition: every control point needs a separate sample where its
/// basis function is not zero, or it would be arbitrary.
///
/// \param counts  counts(i) is true if sample i counts
/// \param advice  remedy, for the message
/// \throws invalid_input if the condition is violated
template <int Order, Real R, class Counts>
void require_samples_for_control_points(const bspline_basis<Order, R>& basis,
                                        const std::vector<R>& u, const Counts& counts,
                                        const char* advice) {
  const std::vector<R>& knots = basis.knots();
  std::size_t sample = 0;
  for (std::size_t i = 0; i < basis.size(); ++i) {
    const R low = knots[i];
    const R high = knots[i + std::size_t(Order)];
    const auto is_inside = [&](std::size_t k) {
      const R& x = u[k];
      return counts(k) && ((x > low && x < high) || (x == low && i == 0) ||
                           (x == high && i + 1 == basis.size()));
    };
    while (sample < u.size() && u[sample] < high && !is_inside(sample)) {
      ++sample;
    }
    require(sample < u.size() && is_inside(sample),
            "duet: fit: there are too few samples for control point ", i,
            ", which acts on parameters from ", low, " to ", high, " (", advice, ")");
    ++sample;
  }
}

/// Root of the weighted mean square of the residuals up to a limit, which does not overflow; empty
/// weights: all equal.
template <class R>
[[nodiscard]] R root_mean_square(const std::vector<R>& residuals,
                                 const std::vector<double>& weights, const R& limit) {
  using std::sqrt;
  const auto counts = [&](const R& residual) { return !(residual > limit); };
  R largest(0);
  for (const R& residual : residuals) {
    if (counts(residual) && !(residual <= largest)) {
      largest = residual;
    }
  }
  R squares(0), sum(0); // of residuals relative to the largest
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    if (counts(residuals[i])) {
      const R ratio = largest > 0 ? R(residuals[i] / largest) : R(0);
      const R weight = weights.empty() ? R(1) : R(weights[i]);
      squares += weight * (ratio * ratio);
      sum += weight;
    }
  }
  return largest - largest == 0 && sum > 0 ? R(largest * sqrt(squares / sum)) : largest;
}

} // namespace detail

/// Fits a curve of type `Spline` with given knots to rotations or poses.
///
/// Minimises Σ wᵢ ρ(|2 log(S(uᵢ)* Qᵢ)|) over the control points by damped least squares
/// (Levenberg–Marquardt). ρ is Huber's loss, ρ(r) = ½ r² up to the outlier threshold
/// `options.outlier_threshold`; samples far beyond it do not count. wᵢ are `options.weights`;
/// residuals are whitened by `options.covariances` if there are any.
///
/// Time and memory are linear in the number of samples. The signs of the samples do not matter.
///
/// \param knots  knots of the curve, for example `knots_every(parameters, 10, Order)`, or those of
///               chosen parameters, `clamped_knots(few_parameters, Order)`; fewer knots smooth more
/// \throws invalid_sample for a sample that is not finite, not a unit, outside the knots' domain or
/// does not follow the sample before
/// \throws invalid_input for counts that differ, too few samples on part of the domain, a
/// characteristic length or weight that is not positive, a negative outlier threshold, or a
/// covariance that is not positive definite
/// \throws no_convergence if the iteration does not converge
template <CurveType Spline, class R, detail::SampleOf<Spline> T>
[[nodiscard]] fit_result<Spline> fit(std::vector<R> parameters, std::vector<quaternion<T>> samples,
                                     std::vector<R> knots, const fit_options& options = {}) {
  static_assert(std::is_same_v<Spline, cumulative_bspline<T, Spline::order>> &&
                    std::is_same_v<R, real_type_t<T>>,
                "duet: fit makes cumulative_bspline<T, Order> from quaternion<T>");
  detail::check_samples("fit", parameters, samples.size(), 0);
  detail::require(options.characteristic_length > 0 && options.outlier_threshold >= 0,
                  "duet: fit: characteristic_length is ", options.characteristic_length,
                  " and outlier_threshold is ", options.outlier_threshold,
                  " (expected a positive length and a non-negative threshold)");
  detail::require_weights("fit", options.weights, samples.size(), "samples");
  const bspline_basis<Spline::order, R> basis(std::move(knots));
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (!basis.contains(parameters[i])) {
      parameters[i] = basis.rounded_into_domain(parameters[i]);
    }
    if (!basis.contains(parameters[i])) {
      detail::raise(invalid_sample(
          i, detail::message("parameter ", detail::all_digits(parameters[i]),
                             " is outside the knots' domain, ", detail::all_digits(basis.front()),
                             " to ", detail::all_digits(basis.back()),
                             " (clamped_knots of parameters from ", parameters.front(), " to ",
                             parameters.back(), " have all samples in it)")));
    }
  }
  detail::require_samples_for_control_points(
      basis, parameters, [](std::size_t) { return true; }, "use fewer knots there");
  detail::bspline_fit<T, Spline::order> problem(
      basis, parameters, normalized_quaternions(std::move(samples)), options);
  detail::require_samples_for_control_points(
      basis, parameters, [&](std::size_t i) { return problem.counts(i); },
      "the others are outliers; use fewer knots there");
  const int iterations = problem.solve();
  const std::vector<R> residuals = problem.residuals();
  const R threshold = problem.outlier_threshold();
  return {problem.curve(basis),
          residuals,
          detail::root_mean_square(residuals, options.weights, std::numeric_limits<R>::infinity()),
          iterations,
          threshold,
          detail::root_mean_square(residuals, options.weights, threshold),
          problem.degrees_of_freedom(),
          problem.remark(),
          options.keeps_covariance ? std::optional(problem.covariance_terms()) : std::nullopt};
}

/// Rejected: rotations for a curve of poses, or poses for a curve of rotations.
template <CurveType Spline, class R, class T, class... More>
  requires(!detail::SampleOf<T, Spline>)
DUET_REFUSED("fit: the scalar of the curve differs from that of the samples: rotations make a "
             "cumulative_bspline<double>, poses a cumulative_bspline<dual<double, 1, screw_tag>>")
fit_result<Spline> fit(const std::vector<R>&, const std::vector<quaternion<T>>&,
                       const std::vector<R>&, const More&...);
DUET_REFUSES_ROWS(fit, fit_result, "(parameters, samples, knots)")
template <CurveType Spline, class U, class T>
DUET_REFUSED("fit: the knots are missing: fit<Curve>(parameters, samples, clamped_knots(breaks, "
             "4))")
fit_result<Spline> fit(const U&, const std::vector<quaternion<T>>&);
template <CurveType Spline, class U, class T>
DUET_REFUSED("fit: the knots are missing: fit<Curve>(parameters, samples, clamped_knots(breaks, "
             "4), options)")
fit_result<Spline> fit(const U&, const std::vector<quaternion<T>>&, const fit_options&);

namespace detail {

/// Residuals of samples at given parameters, as functions of the control points of the curve.
template <class T, int Order>
class bspline_residuals {
protected:
  using R = real_type_t<T>;
  using element = quaternion<T>;
  static constexpr int dimension = manifold<element>::dimension;
  static constexpr int unknowns = Order * dimension;
  static constexpr std::size_t factors = std::size_t(Order) - 1;
  using tangent = Eigen::Matrix<R, dimension, 1>;
  using square = Eigen::Matrix<R, dimension, dimension>;
  using basis_type = bspline_basis<Order, R>;

  bspline_residuals(const basis_type& basis, const std::vector<R>& u, std::vector<element> data,
                    const fit_options& options)
      : samples_(std::move(data)), characteristic_length_(R(options.characteristic_length)),
        sample_weights_(options.weights),
        whitening_(inverse_roots<square>("fit", options.covariances, samples_.size(), dimension,
                                         "samples")) {
    first_.reserve(u.size());
    weights_.reserve(u.size());
    for (const R& parameter : u) {
      const std::size_t span = basis.find_span(parameter);
      first_.push_back(basis.first_function(span));
      weights_.push_back(basis.template weights<0>(span, parameter)[0]);
    }
  }

  [[nodiscard]] const std::vector<element>& samples() const { return samples_; }
  /// Index of the first of the `Order` control points on which each sample depends.
  [[nodiscard]] const std::vector<std::size_t>& first() const { return first_; }

  /// Norm, without overflow.
  [[nodiscard]] static R size_of(const tangent& r) {
    const R norm = r.norm();
    return norm <= std::numeric_limits<R>::max() ? norm : R(r.stableNorm());
  }

  [[nodiscard]] std::vector<R> residuals(const std::vector<element>& controls) const {
    std::vector<R> result;
    result.reserve(samples_.size());
    last_span last;
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      result.push_back(size_of(residual_at(i, controls, last)));
    }
    return result;
  }

  /// Half-angle vector from control point i − 1 to i.
  [[nodiscard]] static vector3<T> increment(const std::vector<element>& controls, std::size_t i) {
    return log_vector(relative_rotation(controls[i - 1], controls[i]), "fit");
  }

  /// Control points perturbed by tangent vectors in their body axes, one after the other.
  [[nodiscard]] static std::vector<element>
  moved_by(std::vector<element> controls, const Eigen::Matrix<R, Eigen::Dynamic, 1>& step) {
    for (std::size_t i = 0; i < controls.size(); ++i) {
      const tangent d = step.template segment<dimension>(Eigen::Index(i) * dimension);
      controls[i] = normalized(element(manifold<element>::plus(controls[i], d, frame::body)));
    }
    return controls;
  }

  [[nodiscard]] bool is_whitened() const { return !whitening_.empty(); }
  [[nodiscard]] R weight_of(std::size_t i) const {
    return sample_weights_.empty() ? R(1) : R(sample_weights_[i]);
  }
  /// Cost Σ wᵢ ρ(rᵢ) with a limit of Huber's loss for each sample; samples with limit 0 do not
  /// count.
  [[nodiscard]] R cost_of(const std::vector<element>& controls,
                          const std::vector<R>& limits) const {
    R sum(0);
    last_span last;
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      if (limits[i] > 0) {
        sum += weight_of(i) * huber_loss(size_of(residual_at(i, controls, last)), limits[i]);
      }
    }
    return sum;
  }

  /// Span of the caller's last sample, valid until the control points change: the control point at
  /// its start, and the increments, half-angle vectors.
  struct last_span {
    std::size_t first = std::size_t(-1);
    element start;
    std::array<vector3<T>, factors> increments;
  };

  [[nodiscard]] tangent residual_at(std::size_t i, const std::vector<element>& controls,
                                    last_span& last) const {
    move_to(first_[i], controls, last);
    element value = last.start;
    for (std::size_t j = 0; j < factors; ++j) {
      value = value * exp_of_multiple(weights_[i][j], last.increments[j]);
    }
    return scaled(twice(residual(value, i)), i);
  }

  struct linear_residual {
    tangent value;
    /// Derivatives with respect to the control points in body axes, one after the other,
    /// transposed.
    Eigen::Matrix<R, unknowns, dimension> gradient;
  };

  /// Residual i and its derivatives: it changes by −J_l⁻¹(r) times the rate of the value.
  [[nodiscard]] linear_residual linearised(std::size_t i, const std::vector<element>& controls,
                                           last_span& last) const {
    move_to(first_[i], controls, last);
    linear_residual result;
    std::array<matrix_rows<T>, std::size_t(Order)> blocks;
    const element value = value_of_product(last.start, last.increments.data(), weights_[i], blocks);
    const vector3<T> r = twice(residual(value, i));
    result.value = scaled(r, i);
    put(rows_of(matrix3<T>(-left_jacobian_inverse(r))), blocks, i, result.gradient);
    return result;
  }

private:
  /// Moves to the span of the control points from `first` on.
  static void move_to(std::size_t first, const std::vector<element>& controls, last_span& last) {
    if (last.first == first) {
      return;
    }
    last.first = first;
    last.start = controls[first];
    for (std::size_t j = 0; j < factors; ++j) {
      last.increments[j] = increment(controls, first + j + 1);
    }
  }

  /// Logarithm log(S* Q) along the shorter arc.
  [[nodiscard]] vector3<T> residual(const element& value, std::size_t i) const {
    const bool is_opposite = innermost(dot(value, samples_[i])) < 0;
    return log_vector(relative_rotation(value, is_opposite ? element(-samples_[i]) : samples_[i]),
                      "fit");
  }

  [[nodiscard]] static vector3<T> twice(const vector3<T>& half) { return R(2) * components(half); }

  [[nodiscard]] const square& whitening(std::size_t i) const {
    return whitening_[whitening_.size() > 1 ? i : 0];
  }

  /// Residual in its unit: [v/characteristic length; ω] for poses; in standard deviations if there
  /// are covariances.
  [[nodiscard]] tangent scaled(const vector3<T>& r, std::size_t i) const {
    tangent result;
    if constexpr (dimension == 3) {
      result = r;
    } else {
      result = twist_of<R>(r);
    }
    if (!whitening_.empty()) {
      result = whitening(i).lazyProduct(result).eval();
    } else if constexpr (dimension == 6) {
      result.template head<3>() /= characteristic_length_;
    }
    return result;
  }

  /// Stores the transposed derivatives `by_value` times the blocks, scaled as the residual.
  void put(const matrix_rows<T>& by_value,
           const std::array<matrix_rows<T>, std::size_t(Order)>& blocks, std::size_t i,
           Eigen::Matrix<R, unknowns, dimension>& gradient) const {
    for (std::size_t j = 0; j < blocks.size(); ++j) {
      const matrix3<T> m = matrix_of(rows_product(by_value, blocks[j]));
      auto block = gradient.template middleRows<dimension>(Eigen::Index(j) * dimension);
      if constexpr (dimension == 3) {
        block = m.transpose();
      } else {
        block = unfolded(m).transpose();
      }
      if (is_whitened()) {
        block = block.lazyProduct(whitening(i).transpose()).eval();
      } else if constexpr (dimension == 6) {
        block.template leftCols<3>() /= characteristic_length_;
      }
    }
  }

  std::vector<element> samples_;
  R characteristic_length_;
  std::vector<double> sample_weights_;
  std::vector<square> whitening_; ///< empty, one for all samples or one for each
  std::vector<std::size_t> first_;
  std::vector<std::array<R, factors>> weights_;
};

/// Corrects Gauss–Newton steps by limited-memory BFGS (two-loop recursion). The Gauss–Newton matrix
/// lacks the second derivatives of the residuals and would need hundreds of steps if residuals are
/// large.
template <Real R>
class gradient_changes {
  using vector = Eigen::Matrix<R, Eigen::Dynamic, 1>;

public:
  [[nodiscard]] bool empty() const { return changes_.empty(); }
  void clear() { changes_.clear(); }

  /// Records the step to the next point, and the gradient before the step.
  void step(vector taken, const vector& gradient) {
    step_ = std::move(taken);
    gradient_ = gradient;
  }
  /// Records the gradient after the step. The change counts if the cost is convex along the step.
  void arrive(const vector& gradient) {
    if (step_.size() != gradient.size()) {
      return;
    }
    change c{step_, gradient - gradient_, R(0)};
    c.product = c.step.dot(c.gradient);
    if (c.product > 0) {
      if (changes_.size() == 8) {
        changes_.erase(changes_.begin());
      }
      changes_.push_back(std::move(c));
    }
  }

  /// Replaces x by H⁻¹ x, where H is the factorised matrix with the corrections.
  template <class Factors>
  void solve(const Factors& factors, vector& x) const {
    std::vector<R> along(changes_.size());
    for (std::size_t k = changes_.size(); k-- > 0;) {
      along[k] = changes_[k].step.dot(x) / changes_[k].product;
      x -= along[k] * changes_[k].gradient;
    }
    factors.solve(x);
    for (std::size_t k = 0; k < changes_.size(); ++k) {
      x += (along[k] - changes_[k].gradient.dot(x) / changes_[k].product) * changes_[k].step;
    }
  }

private:
  struct change {
    vector step, gradient;
    R product;
  };

  vector step_, gradient_;
  std::vector<change> changes_;
};

/// Least-squares problem of `fit`: minimises Σ wᵢ ρ(rᵢ) over the control points, which are
/// perturbed in their tangent spaces (body axes). The normal equations are banded, as a sample
/// depends on `Order` neighbouring control points.
template <class T, int Order>
class bspline_fit : bspline_residuals<T, Order> {
  using residual_type = bspline_residuals<T, Order>;
  using residual_type::dimension;
  using residual_type::first;
  using residual_type::residual_at;
  using residual_type::samples;
  using residual_type::size_of;
  using residual_type::unknowns;
  using typename residual_type::basis_type;
  using typename residual_type::element;
  using typename residual_type::R;
  using typename residual_type::tangent;
  using vector = Eigen::Matrix<R, Eigen::Dynamic, 1>;
  using matrix_type = block_band_matrix<R, dimension, std::size_t(Order) - 1>;

public:
  bspline_fit(const basis_type& basis, const std::vector<R>& u, std::vector<element> data,
              const fit_options& options)
      : bspline_fit(basis, u, central_sample(data, R(options.characteristic_length)), data,
                    options) {}

private:
  /// Constructs the problem with samples relative to one of them, which preserves digits of small
  /// rotations and translations between samples.
  bspline_fit(const basis_type& basis, const std::vector<R>& u, const element& origin,
              std::vector<element> data, const fit_options& options)
      : residual_type(basis, u, samples_relative_to(origin, std::move(data)), options),
        options_(options), basis_(&basis), u_(&u), origin_(origin),
        limits_(u.size(), R(options.outlier_threshold)) {
    if (is_robust()) {
      controls_ =
          robust_centre<T>().controls(basis, u, this->samples(), R(options.characteristic_length));
      approach();
    } else {
      controls_ = control_points_at_averages(basis, u, this->samples());
      const std::vector<R> sizes = residuals();
      if (!(*std::max_element(sizes.begin(), sizes.end()) < too_far<R>())) {
        const auto [index, size] = farthest_from_neighbours();
        raise(invalid_sample(
            index, message("is ", size, " from the samples around it, too far for least ",
                           "squares (fit_options::outlier_threshold makes the fit robust)")));
      }
    }
  }

public:
  /// True if sample i counts; outliers that are too far off do not.
  [[nodiscard]] bool counts(std::size_t i) const { return limits_[i] > 0; }
  [[nodiscard]] R outlier_threshold() const { return R(options_.outlier_threshold); }

  [[nodiscard]] cumulative_bspline<T, Order> curve(const basis_type& basis) const {
    std::vector<element> controls;
    for (const element& control : controls_) {
      controls.push_back(origin_ * control);
    }
    std::vector<vector3<T>> increments{vector3<T>::Zero()};
    for (std::size_t i = 1; i < controls_.size(); ++i) {
      increments.push_back(this->increment(controls_, i));
    }
    return {basis, std::move(controls), std::move(increments)};
  }

  [[nodiscard]] std::vector<R> residuals() const { return residual_type::residuals(controls_); }

  [[nodiscard]] int degrees_of_freedom() const {
    int count = -int(controls_.size());
    for (std::size_t i = 0; i < samples().size(); ++i) {
      count += counts(i);
    }
    return dimension * count;
  }
  /// Sentence on residuals that are not random.
  [[nodiscard]] std::string remark() const {
    std::vector<tangent> residuals;
    typename residual_type::last_span last;
    double largest = 1; // size of the samples, in the unit of residuals
    for (std::size_t i = 0; i < samples().size(); ++i) {
      if (counts(i)) {
        residuals.push_back(residual_at(i, controls_, last));
        if constexpr (dimension == 6) {
          largest = std::max(largest, double(translation(samples()[i]).norm()) /
                                          options_.characteristic_length);
        }
      }
    }
    return remark_on_runs(residuals, this->is_whitened() ? 1e-6 : 1e-12 * largest);
  }
  /// Terms of the covariance of the control points.
  [[nodiscard]] sandwich_terms<R, dimension, std::size_t(Order) - 1> covariance_terms() {
    const R freedom(degrees_of_freedom());
    matrix_type products; // Σ gᵢ gᵢᵀ; for plain least squares its expectation
    const R cost = assemble(R(1), &products);
    if (is_robust()) {
      const std::vector<R> sizes = residuals();
      gradient_bias<R> bias;
      for (std::size_t i = 0; i < sizes.size(); ++i) {
        const bool is_inlier = sizes[i] <= limits_[i];
        if (counts(i)) {
          bias.add(sizes[i], dimension, this->weight_of(i),
                   is_inlier ? R(1) : R(limits_[i] / sizes[i]), R(is_inlier ? 1 : 0));
        }
      }
      products.scale(bias.factor(R(dimension * int(controls_.size()))));
    } else {
      products = normal_;
      if (!this->is_whitened()) {
        products.scale(freedom > 0 ? R(2 * cost / freedom) : std::numeric_limits<R>::quiet_NaN());
      }
    }
    return {normal_, products};
  }

  /// Minimises the cost over the control points; returns the number of steps.
  ///
  /// \throws no_convergence if the iteration does not converge
  int solve() { return iterations_ + descend(options_.max_iterations, true); }

  /// The problem at the control points so far, for `levenberg_marquardt`.
  [[nodiscard]] R linearise() {
    is_bold_ = must_converge_ && is_robust();
    const R cost = assemble(is_bold_ ? R(0.9) : R(0));
    if (++descent_steps_ >
        10) { // Gauss–Newton steps alone are mostly enough, and faster at the end
      changes_.arrive(-gradient_);
    }
    return cost;
  }
  [[nodiscard]] bool solve(const R& damping) {
    damping_ = damping;
    moved_ = moved_control_points(damping, step_);
    return !moved_.empty();
  }
  [[nodiscard]] bool solve_better() {
    if (!changes_.empty()) {
      changes_.clear();
      return true;
    }
    if (is_bold_) {
      is_bold_ = false;
      static_cast<void>(assemble(R(0)));
      return true;
    }
    return false;
  }
  [[nodiscard]] const R& step_size() const { return step_; }
  /// ½ δᵀ((2 − φ) g + λ D δ) of the step δ, which is φ times that of the linear problem; g is the
  /// negative gradient and D the diagonal of JᵀWJ.
  [[nodiscard]] R predicted_decrease() const {
    R sum = (2 - fraction_) * last_step_.dot(gradient_);
    for (std::size_t i = 0; i < normal_.rows(); ++i) {
      const auto d = last_step_.template segment<dimension>(Eigen::Index(i) * dimension);
      sum += damping_ * d.cwiseAbs2().dot(normal_.at(i, i).diagonal());
    }
    return sum / 2;
  }
  [[nodiscard]] R cost_after_step() const { return this->cost_of(moved_, limits_); }
  void accept() {
    controls_ = std::move(moved_);
    changes_.step(last_step_, -gradient_);
  }

private:
  static constexpr R max_rotation = R(0.5);
  static constexpr R min_outlier_threshold =
      R(1e-9); ///< samples that fit to round-off have no outliers

  [[nodiscard]] bool is_robust() const {
    return options_.outlier_threshold < std::numeric_limits<double>::infinity();
  }

  /// Damped least squares (Levenberg–Marquardt); returns the number of steps.
  ///
  /// \throws no_convergence if `must_converge` and the iteration does not
  int descend(int max_steps, bool must_converge) {
    using std::sqrt;
    const R rounding = 8 * std::numeric_limits<R>::epsilon() * sqrt(R(samples().size()));
    must_converge_ = must_converge;
    descent_steps_ = 0;
    descent_options<R> options{max_steps, R(0), rounding};
    if (!must_converge) {
      options.min_decrease = R(0.1);
      options.is_polished = false;
    }
    const descent<R> d = levenberg_marquardt<R>(*this, options);
    if (must_converge && d.reason == least_squares_stop::no_decrease) {
      fail("finds no step that reduces the cost", d.iterations, d.step);
    }
    if (must_converge && d.reason == least_squares_stop::iteration_limit) {
      fail("does not converge", max_steps, d.step);
    }
    return d.iterations;
  }

  /// Approaches the samples robustly: the outlier limits follow from medians of the distances of
  /// the surrounding samples from the curve so far.
  void approach() {
    constexpr int rounds = 12;
    R scale = std::numeric_limits<R>::infinity(); // sum of the limits
    for (int round = 0; round < rounds; ++round) {
      const R last = scale;
      scale = set_limits();
      if (!(scale < R(0.9) * last)) {
        break;
      }
      iterations_ += descend(round == 0 ? 1 : 4, false);
    }
    if (!(options_.outlier_threshold > 0)) {
      std::vector<R> sizes = residuals();
      options_.outlier_threshold =
          double(std::max(R(3 * median_within(sizes)), min_outlier_threshold));
    }
    static_cast<void>(set_limits());
    for (R& limit : limits_) {
      limit = std::min(limit, R(options_.outlier_threshold));
    }
  }

  R set_limits() {
    const R min_limit = std::max(R(options_.outlier_threshold), min_outlier_threshold);
    return set_outlier_limits(residuals(), first(), min_limit, limits_);
  }

  /// Assembles JᵀWJ and −JᵀW r at the control points, W the weights of Huber's loss; returns the
  /// cost there.
  ///
  /// \param omitted   share of the curvature along residuals beyond the limit to omit. The loss has
  ///                  none there: with a share of 1 the matrix is its second derivative. Steps with
  ///                  most of it omitted are correct near the solution, but possibly too long far
  ///                  from it; with all of it they are too short.
  /// \param products  receives the sum of gᵢgᵢᵀ, gᵢ the gradients of single losses, if not null
  [[nodiscard]] R assemble(const R& omitted, matrix_type* products = nullptr) {
    R cost(0);
    gradient_.setZero(Eigen::Index(controls_.size()) * dimension);
    normal_.set_zero(controls_.size());
    typename residual_type::last_span last;
    using square_of_span = Eigen::Matrix<R, unknowns, unknowns>;
    square_of_span squares = square_of_span::Zero(), squares_of_gradients = squares;
    const auto flush = [](std::size_t span, square_of_span& from, matrix_type& to) {
      for (std::size_t a = 0; a < std::size_t(Order); ++a) {
        for (std::size_t b = 0; b <= a; ++b) {
          to.at(span + a, span + b) += from.template block<dimension, dimension>(
              Eigen::Index(a) * dimension, Eigen::Index(b) * dimension);
        }
      }
      from.setZero();
    };
    const auto flush_all = [&](std::size_t span) { // called once for all samples on a span
      flush(span, squares, normal_);
      if (products) {
        flush(span, squares_of_gradients, *products);
      }
    };
    if (products) {
      products->set_zero(controls_.size());
    }
    for (std::size_t i = 0; i < samples().size(); ++i) {
      if (!counts(i)) {
        continue;
      }
      if (first()[i] != last.first && last.first != std::size_t(-1)) {
        flush_all(last.first);
      }
      const auto [value, gradient] = this->linearised(i, controls_, last);
      const R length = size_of(value), sample_weight = this->weight_of(i);
      cost += sample_weight * huber_loss(length, limits_[i]);
      const R weight =
          length <= limits_[i] ? sample_weight : R(sample_weight * (limits_[i] / length));
      gradient_.template segment<unknowns>(Eigen::Index(last.first) * dimension) -=
          weight * (gradient * value);
      const Eigen::Matrix<R, unknowns, dimension> weighted = weight * gradient;
      for (int a = 0; a < unknowns; ++a) { // by columns, which Eigen handles fast
        squares.col(a).noalias() += gradient.lazyProduct(weighted.row(a).transpose());
      }
      if (weight < sample_weight && omitted > 0) {
        const Eigen::Matrix<R, unknowns, 1> along = gradient * (value / length);
        squares -= omitted * weight * along.lazyProduct(along.transpose());
      }
      if (products) {
        const Eigen::Matrix<R, unknowns, 1> of_loss = weighted * value;
        squares_of_gradients += of_loss.lazyProduct(of_loss.transpose());
      }
    }
    if (last.first != std::size_t(-1)) {
      flush_all(last.first);
    }
    return cost;
  }

  /// Control points after one step; empty if there is no step with this damping.
  [[nodiscard]] std::vector<element> moved_control_points(const R& damping, R& step) {
    factors_ = normal_;
    if (damping > 0) {
      factors_.scale_diagonal(1 + damping);
    }
    if (!factors_.factorise()) {
      return {};
    }
    vector delta = gradient_;
    changes_.solve(factors_, delta);
    step = delta.template lpNorm<Eigen::Infinity>();
    if (!delta.allFinite()) {
      return {};
    }
    // Only rotations of control points are bounded: the curve is linear in translations.
    R largest_angle(0);
    for (Eigen::Index i = dimension; i <= delta.size(); i += dimension) {
      largest_angle = std::max(largest_angle, R(delta.template segment<3>(i - 3).norm()));
    }
    fraction_ = largest_angle > max_rotation ? R(max_rotation / largest_angle) : R(1);
    last_step_ = fraction_ * delta;
    return this->moved_by(controls_, last_step_);
  }

  /// Index of the sample farthest from the samples around it, and its distance from them.
  [[nodiscard]] std::pair<std::size_t, R> farthest_from_neighbours() const {
    const std::vector<R> sizes = residual_type::residuals(
        robust_centre<T>().controls(*basis_, *u_, samples(), R(options_.characteristic_length)));
    const auto farthest = std::max_element(sizes.begin(), sizes.end());
    return {std::size_t(farthest - sizes.begin()), *farthest};
  }

  /// Control points half a turn apart, as text for messages: the curve jumps beyond, so that the
  /// cost can have no minimum. Empty if there are none.
  [[nodiscard]] std::string half_turn() const {
    constexpr double bound = 3.1; // rad
    for (std::size_t i = 1; i < controls_.size(); ++i) {
      if (4 * innermost(this->increment(controls_, i).squaredNorm()) > bound * bound) {
        return message(", control points ", i - 1, " and ", i,
                       " half a turn apart, where the curve jumps");
      }
    }
    return "";
  }

  /// Reports failure. If plain least squares fail because of a sample far from all others, the
  /// message names it.
  [[noreturn]] void fail(const char* what, int iterations, const R& step) const {
    const auto [index, size] = farthest_from_neighbours();
    std::string cause = half_turn();
    if (!is_robust() && size > 30) {
      cause += message(": sample ", index, " is ", size, " from the samples around it ",
                       "(fit_options::outlier_threshold makes the fit robust)");
    }
    raise(no_convergence(message("duet: fit: the iteration ", what, " after ",
                                 iterations_ + iterations, " steps, the last one ", step, cause)));
  }

  fit_options options_;
  const basis_type* basis_;
  const std::vector<R>* u_;
  element origin_;        ///< sample to which the others are relative
  std::vector<R> limits_; ///< outlier limits of Huber's loss for each sample; 0: does not count
  std::vector<element> controls_, moved_; ///< control points; after the step
  R step_{0}, damping_{0};                ///< largest coordinate of the step, and its damping
  R fraction_{1};                         ///< of the step of the linear problem that is taken
  int iterations_ = 0, descent_steps_ = 0;
  bool must_converge_ = false, is_bold_ = false;
  matrix_type normal_, factors_;
  vector gradient_, last_step_; ///< negative gradient
  gradient_changes<R> changes_;
};

} // namespace detail
} // namespace duet
