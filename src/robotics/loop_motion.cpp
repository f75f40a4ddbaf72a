// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "loop_closure_solver.hpp"

#include <duet/core/errors.hpp>
#include <duet/core/random_source.hpp>
#include <duet/core/text/number_text.hpp>
#include <duet/core/text/printable.hpp>
#include <duet/dual/taylor.hpp>
#include <duet/kinematics/constrained_mechanism.hpp>
#include <duet/robotics/closed_tree.hpp>
#include <duet/robotics/loop_motion.hpp>

#include <Eigen/Core>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace duet::detail {
namespace {

/// A configuration on the curve, x = (dependent coordinates per unit, s), with its derivatives.
struct curve_point {
  Eigen::VectorXd x;
  Eigen::VectorXd tangent;   ///< unit tangent dx per unit of arc length
  Eigen::MatrixXd matrix;    ///< the matrix A of `solution_curve`
  Eigen::MatrixXd image;     ///< orthonormal columns that span the image of A
  double min_singular_value; ///< smallest nonzero singular value of A

  [[nodiscard]] double s() const { return x[x.size() - 1]; }
  [[nodiscard]] double s_rate() const { return tangent[tangent.size() - 1]; }
};

/// A branch point of a curve.
struct branch_point_data {
  Eigen::VectorXd x; ///< coordinates as in `curve_point`
  /// Unit tangents: straight on, those of other branches in pairs of opposites, back.
  std::vector<Eigen::VectorXd> tangents;
  std::vector<curve_point> points; ///< a point of the curve along each tangent
};

/// The configurations q(s) of a mechanism whose driven coordinates are on the straight line u₀ + s
/// w, |w| = 1 in units of the coordinates, as a curve in (q_dependent, s), which is smooth where s
/// reverses: the kernel of A = (∂F/∂q_dependent, ∂F/∂u w) is its tangent.
class solution_curve {
public:
  /// \param direction  direction of the driven coordinates, each per unit; of any length except for
  /// 0
  solution_curve(const closed_chain_mechanism& of, const Eigen::VectorXd& q0,
                 std::vector<int> drives, const Eigen::VectorXd& direction)
      : of_(of), q0_(q0), drives_(std::move(drives)), dependent_(all_but(of.size(), drives_)),
        direction_(direction.normalized()) {}

  /// The first point; empty if the curve has no tangent there.
  [[nodiscard]] std::optional<curve_point> start(double direction) const {
    Eigen::VectorXd x(Eigen::Index(dependent_.size()) + 1);
    x << q0_.cwiseQuotient(of_.units())(dependent_), 0;
    return point(x, Eigen::VectorXd::Unit(x.size(), x.size() - 1) * direction);
  }

  /// All coordinates of the tree.
  [[nodiscard]] Eigen::VectorXd coordinates(const Eigen::VectorXd& x) const {
    Eigen::VectorXd q = q0_.cwiseQuotient(of_.units());
    q(dependent_) = x.head(x.size() - 1);
    q(drives_) += x[x.size() - 1] * direction_;
    return q.cwiseProduct(of_.units());
  }

  /// Rates of all coordinates along a tangent.
  [[nodiscard]] Eigen::VectorXd rates(const Eigen::VectorXd& tangent) const {
    Eigen::VectorXd v(of_.size());
    v(dependent_) = tangent.head(tangent.size() - 1);
    v(drives_) = tangent[tangent.size() - 1] * direction_;
    return v.cwiseProduct(of_.units());
  }

  /// The next point, at a step along the tangent (predictor) and back to the curve (corrector).
  /// Empty if the step is too large for the direction of the tangent, the distance back to the
  /// curve, and the volume spanned by the equations and the tangent to change little. That volume
  /// keeps its sign unless another branch meets the curve. (If two more meet it, it may keep its
  /// sign: near such points half the step is checked.)
  [[nodiscard]] std::optional<curve_point> advance(const curve_point& from, double step) const {
    const auto to = reached(from, step);
    if (to && from.min_singular_value + to->min_singular_value < 2 * step &&
        !reached(from, step / 2)) {
      return std::nullopt;
    }
    return to;
  }

  /// The point near x that is reached by minimum-norm steps.
  ///
  /// \param before  the tangent to orient the new one by
  /// \param max_norm    maximum norm of the first step
  [[nodiscard]] std::optional<curve_point>
  nearest_point(Eigen::VectorXd x, const Eigen::VectorXd& before, double max_norm) const {
    return correct(x, false, max_norm) ? point(x, before) : std::nullopt;
  }

  /// The point at s, from a point near it.
  [[nodiscard]] std::optional<curve_point> at(double s, const curve_point& guess,
                                              double max_norm) const {
    Eigen::VectorXd x = guess.x;
    x[x.size() - 1] = s;
    return correct(x, true, max_norm) ? point(x, guess.tangent) : std::nullopt;
  }

  /// A step along the tangent from one point and the point of the curve that it leads to.
  struct curve_interval {
    curve_point end;
    double step;
  };
  /// The part of a step up to the zero of a rate, a function of points that changes sign along the
  /// step: by the Illinois variant of regula falsi (false position), which halves the weight of a
  /// bound that is kept.
  template <class Rate>
  [[nodiscard]] curve_interval zero(const curve_point& from, const curve_point& to, double step,
                                    const Rate& rate) const {
    double a = 0, b = step, at_a = rate(from), at_b = rate(to);
    curve_interval result{to, step};
    for (int i = 0, side = 0; i < 60 && at_a != at_b; ++i) {
      const double c = (a * at_b - b * at_a) / (at_b - at_a);
      const auto next = reached(from, c);
      if (!next) {
        break;
      }
      result = {*next, c};
      const double at_c = rate(*next);
      if (std::abs(at_c) < 1e-15 || std::abs(b - a) < 1e-15) {
        break;
      }
      const bool is_beyond = (at_c < 0) == (at_b < 0);
      (is_beyond ? b : a) = c;
      (is_beyond ? at_b : at_a) = at_c;
      const int now = is_beyond ? 1 : -1;
      (is_beyond ? at_a : at_b) *= side == now ? .5 : 1;
      side = now;
    }
    return result;
  }

  /// Residuals F at x.
  [[nodiscard]] Eigen::VectorXd residuals(const Eigen::VectorXd& x) const {
    return of_.residuals(coordinates(x));
  }

  /// The branch point ahead of a point of the curve, to round-off; empty if no branch point is
  /// near, or if branches touch there, so that second derivatives do not separate them.
  ///
  /// \param step  half of the last rejected step; a branch point is near if it is small
  [[nodiscard]] std::optional<branch_point_data> branch_point_ahead(const curve_point& from,
                                                                    double step) const {
    const auto x = step < 1e-3 ? singular_point(from, 4 * step) : std::nullopt;
    if (!x || from.tangent.dot(*x - from.x) <= 0) {
      return std::nullopt;
    }
    const std::vector<Eigen::VectorXd> lines = tangents(*x);
    const Eigen::VectorXd incoming = (from.x - *x).normalized();
    const auto nearest = std::max_element(lines.begin(), lines.end(), [&](auto& p, auto& q) {
      return std::abs(p.dot(incoming)) < std::abs(q.dot(incoming));
    });
    if (nearest == lines.end() || std::abs(nearest->dot(incoming)) < .95) {
      return std::nullopt;
    }
    const Eigen::VectorXd back = nearest->dot(incoming) < 0 ? -*nearest : *nearest;
    std::vector<Eigen::VectorXd> directions = {-back};
    for (auto line = lines.begin(); line != lines.end(); ++line) {
      if (line != nearest) {
        directions.insert(directions.end(), {*line, -*line});
      }
    }
    directions.push_back(back);
    branch_point_data result{*x, {}, {}};
    for (const Eigen::VectorXd& direction : directions) {
      if (const auto point = point_along(*x, direction)) {
        result.tangents.push_back(direction);
        result.points.push_back(*point);
      } else if (&direction == &directions.front() || &direction == &directions.back()) {
        return std::nullopt;
      }
    }
    return result;
  }

private:
  /// The matrix A at x.
  [[nodiscard]] Eigen::MatrixXd matrix(const Eigen::VectorXd& x) const {
    const Eigen::MatrixXd j = unit_jacobian(of_, coordinates(x));
    Eigen::MatrixXd a(j.rows(), x.size());
    a << columns(j, dependent_), columns(j, drives_) * direction_;
    return a;
  }

  /// The quadratic forms wᵀ ∂²F(K v, K v) in v, for each column w.
  [[nodiscard]] std::vector<Eigen::MatrixXd>
  forms_at(const Eigen::VectorXd& x, const Eigen::MatrixXd& w, const Eigen::MatrixXd& k) const {
    Eigen::MatrixXd unit_rates(of_.size(), k.cols());
    for (Eigen::Index i = 0; i < k.cols(); ++i) {
      unit_rates.col(i) = rates(k.col(i)).cwiseQuotient(of_.units());
    }
    return quadratic_forms(of_, coordinates(x), w, unit_rates);
  }

  [[nodiscard]] std::optional<curve_point> reached(const curve_point& from, double step) const {
    const auto to = nearest_point(from.x + step * from.tangent, from.tangent, step / 4);
    if (!to || to->tangent.dot(from.tangent) < .95) {
      return std::nullopt;
    }
    const double change = volume(*to, from.image) / volume(from, from.image);
    return change > .25 && change < 4 ? to : std::nullopt;
  }

  [[nodiscard]] std::optional<curve_point> point(const Eigen::VectorXd& x,
                                                 const Eigen::VectorXd& before) const {
    curve_point result{x, {}, matrix(x), {}, 0};
    const rank_revealing_svd svd(result.matrix);
    if (svd.rank != x.size() - 1) {
      return std::nullopt;
    }
    result.tangent = svd.kernel();
    result.tangent *= result.tangent.dot(before) < 0 ? -1 : 1;
    result.image = svd.image();
    result.min_singular_value = svd.rank > 0 ? svd.s[svd.rank - 1] : 1;
    return result;
  }

  [[nodiscard]] static double volume(const curve_point& at, const Eigen::MatrixXd& image) {
    Eigen::MatrixXd m(at.x.size(), at.x.size());
    m << image.transpose().lazyProduct(at.matrix), at.tangent.transpose();
    return m.fullPivLu().determinant();
  }

  /// Corrector: Newton's method with minimum-norm steps, of which the first must not exceed
  /// `max_norm`.
  [[nodiscard]] bool correct(Eigen::VectorXd& x, bool s_is_fixed, double max_norm) const {
    const Eigen::Index n = x.size() - (s_is_fixed ? 1 : 0);
    double before = max_norm;
    for (int i = 0; i < 12; ++i) {
      const Eigen::VectorXd f = residuals(x);
      const rank_revealing_svd svd(matrix(x).leftCols(n));
      if (svd.rank < x.size() - 1) {
        return false;
      }
      const Eigen::VectorXd dx = -svd.solve(f, x.size() - 1);
      const double length = dx.norm();
      if (!(length <= max_norm)) {
        return false;
      }
      const double rounding = 1e-14 * std::max(1.0, x.norm());
      x.head(n) += dx;
      if (length <= rounding || (length < 1e-10 && length > before / 4)) {
        return residuals(x).norm() <= 1e-11 * std::max(1.0, x.norm());
      }
      if (i > 0 && length > before / 2) {
        return false;
      }
      before = length;
    }
    return false;
  }

  /// Point where A loses rank and F vanishes, by the Gauss–Newton method for x and W with
  ///
  ///   UᵀF = 0,   AᵀU W = 0,   W₀ᵀW = 1,
  ///
  /// where U spans the image of A near that point, so that redundant equations are omitted, and W
  /// spans the lost part of the image. There are more equations than unknowns, but at a crossing of
  /// branches all are fulfilled and their matrix has full column rank: its kernel is zero except if
  /// there is a v ≠ 0 in the kernel of A with wᵀ ∂²F(v, ·) = 0 on that kernel, as where branches
  /// touch. Where branches only nearly meet some equations are not fulfilled.
  [[nodiscard]] std::optional<Eigen::VectorXd> singular_point(const curve_point& from,
                                                              double within) const {
    const Eigen::MatrixXd& u = from.image;
    const Eigen::Index n = from.x.size(), r = u.cols();
    const rank_revealing_svd reduced(Eigen::MatrixXd(u.transpose().lazyProduct(from.matrix)));
    const Eigen::VectorXd& s = reduced.s;
    Eigen::Index lost = 0; // rank that is lost, as far as visible from this point
    while (lost < r && s[r - 1 - lost] < 10 * within * s[0]) {
      ++lost;
    }
    if (lost == 0) {
      return std::nullopt;
    }
    const Eigen::Index all = n + r * lost;
    const Eigen::MatrixXd w0 = reduced.u.rightCols(lost);
    Eigen::VectorXd x = from.x;
    Eigen::MatrixXd w = w0;
    for (int i = 0; i < 12; ++i) {
      const Eigen::MatrixXd a = u.transpose().lazyProduct(matrix(x));
      const auto forms = forms_at(x, u.lazyProduct(w), Eigen::MatrixXd::Identity(n, n));
      Eigen::VectorXd f(r + n * lost + lost * lost);
      Eigen::MatrixXd j = Eigen::MatrixXd::Zero(f.size(), all);
      f.head(r) = u.transpose() * residuals(x);
      j.topLeftCorner(r, n) = a;
      for (Eigen::Index k = 0; k < lost; ++k) {
        const Eigen::Index column = n + r * k, row = r + n * k, last = r + n * lost + lost * k;
        f.segment(row, n) = a.transpose() * w.col(k);
        f.segment(last, lost) = w0.transpose() * w.col(k) - Eigen::VectorXd::Unit(lost, k);
        j.block(row, 0, n, n) = forms[std::size_t(k)];
        j.block(row, column, n, r) = a.transpose();
        j.block(last, column, lost, r) = w0.transpose();
      }
      const rank_revealing_svd svd(j);
      if (svd.rank < all) {
        return std::nullopt; // branches touch
      }
      const Eigen::VectorXd step = -svd.solve(f, all);
      x += step.head(n);
      for (Eigen::Index k = 0; k < lost; ++k) {
        w.col(k) += step.segment(n + r * k, r);
      }
      if (!((x - from.x).norm() < within)) {
        return std::nullopt;
      }
      if (step.norm() < 1e-13) {
        const bool closes = residuals(x).norm() <= 1e-12 * std::max(1.0, x.norm());
        return closes ? std::optional(x) : std::nullopt;
      }
    }
    return std::nullopt;
  }

  /// Lines along which rates have accelerations: v in the kernel K of A with wᵀ ∂²F(v, v) = 0 for
  /// all w orthogonal to its image. For a kernel of dimension two these are the zeros of a form in
  /// the plane, otherwise they are searched for from random starts.
  [[nodiscard]] std::vector<Eigen::VectorXd> tangents(const Eigen::VectorXd& x) const {
    const rank_revealing_svd a(matrix(x));
    const Eigen::MatrixXd kernel = a.kernel();
    const std::vector<Eigen::MatrixXd> forms = forms_at(x, a.cokernel(), kernel);
    std::vector<Eigen::VectorXd> zeros;
    if (kernel.cols() == 2) {
      for (const double angle : zeros_in_plane(forms)) {
        zeros.push_back(Eigen::Vector2d(std::cos(angle), std::sin(angle)));
      }
    }
    random_source random(1);
    for (int start = 0; kernel.cols() > 2 && start < 100 * kernel.cols(); ++start) {
      const auto v = common_zero(forms, random_direction(random, kernel.cols()), 1e-12);
      const bool is_new = v && std::none_of(zeros.begin(), zeros.end(), [&](const auto& other) {
                            return std::abs(other.dot(*v)) > 1 - 1e-9;
                          });
      if (is_new) {
        zeros.push_back(*v);
      }
    }
    std::vector<Eigen::VectorXd> result;
    for (const Eigen::VectorXd& v : zeros) {
      const Eigen::VectorXd line = kernel * v;
      result.push_back(first_that_moves(rates(line)) < 0 ? -line : line);
    }
    std::sort(result.begin(), result.end(), [&](const auto& p, const auto& q) {
      return first_that_moves(rates(p) - rates(q)) > 0;
    });
    return result;
  }

  /// The first of these rates that is not round-off.
  [[nodiscard]] static double first_that_moves(const Eigen::VectorXd& rates) {
    const auto moves = [](double x) { return std::abs(x) > 1e-9; };
    const auto found = std::find_if(rates.begin(), rates.end(), moves);
    return found == rates.end() ? 0 : *found;
  }

  /// The angles θ within a half turn for which all forms vanish at (cos θ, sin θ), from the form of
  /// which they all are nearly multiples, a cos² θ + 2 b cos θ sin θ + c sin² θ = (a + c) / 2 + (a
  /// − c) / 2 cos 2θ + b sin 2θ.
  [[nodiscard]] static std::vector<double>
  zeros_in_plane(const std::vector<Eigen::MatrixXd>& forms) {
    Eigen::MatrixXd parts(Eigen::Index(forms.size()), 3);
    for (std::size_t k = 0; k < forms.size(); ++k) {
      const Eigen::MatrixXd& form = forms[k];
      parts.row(Eigen::Index(k)) << (form(0, 0) + form(1, 1)) / 2, (form(0, 0) - form(1, 1)) / 2,
          form(0, 1);
    }
    const rank_revealing_svd svd(parts);
    const Eigen::VectorXd form = svd.v.col(0);
    const double cosine = -form[0] / std::hypot(form[1], form[2]);
    if (!(std::abs(cosine) < 1)) {
      return {};
    }
    const double centre = std::atan2(form[2], form[1]), half_width = std::acos(cosine);
    std::vector<double> result;
    for (const double twice : {centre + half_width, centre - half_width}) {
      const Eigen::VectorXd rest = parts * Eigen::Vector3d(1, std::cos(twice), std::sin(twice));
      if (rest.norm() < rank_revealing_svd::rank_tolerance * svd.s[0]) {
        result.push_back(twice / 2);
      }
    }
    return result;
  }

  /// A point of the curve that leaves x along a tangent.
  [[nodiscard]] std::optional<curve_point> point_along(const Eigen::VectorXd& x,
                                                       const Eigen::VectorXd& tangent) const {
    for (double step = 1e-3; step > 1e-5; step /= 2) {
      const auto point = nearest_point(x + step * tangent, tangent, step / 4);
      if (point && point->tangent.dot(tangent) > .99) {
        return point;
      }
    }
    return std::nullopt;
  }

  const closed_chain_mechanism& of_;
  Eigen::VectorXd q0_;
  std::vector<int> drives_, dependent_;
  Eigen::VectorXd direction_;
};

/// Texts of coordinates, separated by commas.
[[nodiscard]] std::string listed(const std::vector<int>& these, const auto& text_of) {
  std::string result;
  for (const int i : these) {
    result += (result.empty() ? "" : ", ") + text_of(i);
  }
  return result;
}
[[nodiscard]] std::string coordinate_list(const closed_chain_mechanism& of,
                                          const std::vector<int>& these) {
  return printable(
      listed(these, [&](int i) { return of.tree().coordinate_names()[std::size_t(i)]; }));
}

/// Names of the coordinates that move most, among those whose rates are not zero.
[[nodiscard]] std::string moving_coordinates(const closed_chain_mechanism& of,
                                             const Eigen::VectorXd& rates) {
  const Eigen::VectorXd sizes = rates.cwiseQuotient(of.units()).cwiseAbs();
  std::vector<int> moving = all_but(of.size(), {});
  std::erase_if(moving, [&](int i) { return !(sizes[i] > 1e-4 * sizes.maxCoeff()); });
  return coordinate_list(of, moving);
}

/// Traces a motion along one of its driven coordinates.
class tracer {
public:
  tracer(const driven_motion& motion, int drive, const trace_options& options)
      : of_(motion.mechanism()), options_(options),
        curve_(of_, motion.start(), motion.drives(),
               Eigen::VectorXd::Unit(Eigen::Index(motion.drives().size()), drive)),
        angles_(periodic_coordinates(of_).angles) {}

  [[nodiscard]] motion_trace run() {
    result_.positions = follow(1);
    result_.positions.insert(result_.positions.begin(), curve_.coordinates(curve_.start(1)->x));
    if (!result_.is_closed) {
      std::vector<Eigen::VectorXd> backwards = follow(-1);
      std::reverse(backwards.begin(), backwards.end());
      result_.positions.insert(result_.positions.begin(), backwards.begin(), backwards.end());
    }
    return result_;
  }

private:
  [[nodiscard]] std::vector<Eigen::VectorXd> follow(double direction) {
    std::vector<Eigen::VectorXd> positions;
    curve_point current = *curve_.start(direction), start = current;
    double done = 0;
    for (double step = options_.largest_step; step > 1e-7 && done < options_.max_length;) {
      auto next = curve_.advance(current, step);
      bool changes_branch = false;
      if (next) {
        add_dead_points(current, *next, step);
      } else {
        step /= 2;
        next = past_branch_point(current, step);
        if (!next) {
          continue;
        }
        step = (next->x - current.x).norm();
        changes_branch = result_.branch_points.back().chosen != 0;
      }
      const Eigen::VectorXd to = curve_.coordinates(next->x);
      if (changes_branch) {
        start = *next;
      } else if (done > 0 && is_between(start, curve_.coordinates(current.x), to)) {
        result_.is_closed = true;
        return positions;
      }
      positions.push_back(to);
      current = *next;
      done += step;
      step = std::min(options_.largest_step, 2 * step);
    }
    result_.stopped_early |= done < options_.max_length;
    return positions;
  }

  /// True if a point of the curve is between two configurations, except for full turns.
  [[nodiscard]] bool is_between(const curve_point& start, const Eigen::VectorXd& from,
                                const Eigen::VectorXd& to) const {
    const Eigen::VectorXd rates = curve_.rates(start.tangent).cwiseQuotient(of_.units()),
                          displacement = (to - from).cwiseQuotient(of_.units());
    Eigen::VectorXd before = (from - curve_.coordinates(start.x)).cwiseQuotient(of_.units());
    for (Eigen::Index i = 0; i < before.size(); ++i) {
      before[i] =
          angles_[std::size_t(i)] ? std::remainder(before[i], 2 * std::numbers::pi) : before[i];
    }
    const Eigen::VectorXd after = before + displacement;
    const double step = displacement.norm();
    return before.norm() < 2 * step && after.norm() < 2 * step && before.dot(rates) < 0 &&
           after.dot(rates) >= 0;
  }

  void add_dead_points(const curve_point& from, const curve_point& to, double step) {
    const Eigen::VectorXd before = curve_.rates(from.tangent), after = curve_.rates(to.tangent);
    for (int i = 0; i < of_.size(); ++i) {
      if (changes_sign(before[i], after[i], i)) {
        const auto dead = curve_.zero(from, to, step, [&](const curve_point& at) {
          return curve_.rates(at.tangent)[i] / of_.units()[i];
        });
        add_dead_point(i, dead.end.x, dead.end.tangent);
      }
    }
  }
  [[nodiscard]] bool changes_sign(double before, double after, int i) const {
    return (before < 0) != (after < 0) && std::abs(after - before) > 1e-9 * of_.units()[i];
  }
  void add_dead_point(int i, const Eigen::VectorXd& x, const Eigen::VectorXd& tangent) {
    const Eigen::VectorXd rates = curve_.rates(tangent);
    result_.dead_points.push_back(
        {i, curve_.coordinates(x), rates, moving_coordinates(of_, rates)});
  }

  /// A point behind a branch point, if steps became so small that one may be near.
  [[nodiscard]] std::optional<curve_point> past_branch_point(const curve_point& from, double step) {
    const auto crossing = curve_.branch_point_ahead(from, step);
    if (!crossing) {
      return std::nullopt;
    }
    branch_point at{curve_.coordinates(crossing->x), {}, 0};
    for (const Eigen::VectorXd& tangent : crossing->tangents) {
      at.tangents.push_back(curve_.rates(tangent));
    }
    const std::size_t met = result_.branch_points.size();
    at.chosen = met < options_.branches.size() ? options_.branches[met] : 0;
    require(at.chosen < at.tangents.size(), "duet: trace: branch ", at.chosen,
            " does not exist, branch point ", met, " has ", at.tangents.size());
    result_.branch_points.push_back(at);
    const curve_point& to = crossing->points[at.chosen];
    const Eigen::VectorXd before = curve_.rates(from.tangent), after = curve_.rates(to.tangent);
    for (int i = 0; i < of_.size(); ++i) {
      const bool rests = std::abs(at.tangents[0][i]) < 1e-9 * of_.units()[i];
      if (at.chosen == 0 && rests && changes_sign(before[i], after[i], i)) {
        add_dead_point(i, crossing->x, crossing->tangents[0]);
      }
    }
    return to;
  }

  const closed_chain_mechanism& of_;
  trace_options options_;
  solution_curve curve_;
  std::vector<bool> angles_; ///< as in `periodic_coordinates`
  motion_trace result_;
};

} // namespace
} // namespace duet::detail

namespace duet {
DUET_ABI_BEGIN

driven_motion::driven_motion(closed_chain_mechanism mechanism, const Eigen::VectorXd& q0,
                             std::vector<int> drives, const driven_motion_options& options)
    : mechanism_(std::move(mechanism)), drives_(std::move(drives)),
      dependent_(detail::all_but(mechanism_.size(), drives_)), options_(options),
      start_(mechanism_.assemble(q0, drives_)), solve_(solver(start_)) {
  const detail::rank_revealing_svd all = detail::linearised(mechanism_, start_);
  const Eigen::Index free = mechanism_.size() - all.rank;
  detail::require(free == Eigen::Index(drives_.size()), "duet: driven_motion: ", drives_.size(),
                  " driven coordinates (expected ", free, ", the degrees of freedom at the start)");
  require_accelerations();
}

driven_motion driven_motion::warm_started_at(const Eigen::VectorXd& u) const {
  driven_motion result = *this;
  result.start_ = (*this)(u);
  result.solve_ = solver(result.start_);
  return result;
}

Eigen::MatrixXd driven_motion::solver(const Eigen::VectorXd& q) const {
  const Eigen::MatrixXd j = detail::columns(detail::unit_jacobian(mechanism_, q), dependent_);
  const detail::rank_revealing_svd svd(j);
  detail::require(svd.rank == j.cols(), "duet: driven_motion: ", driven(),
                  " does not determine the rates of the other coordinates (dead point)");
  return mechanism_.units()(dependent_).asDiagonal() * svd.v *
         svd.s.head(j.cols()).cwiseInverse().asDiagonal() * svd.u.leftCols(j.cols()).transpose();
}

void driven_motion::require_accelerations() const {
  using T = taylor<double, 2, derivative_tag<closed_chain_mechanism>>;
  for (const int drive : drives_) {
    Eigen::Matrix<T, Eigen::Dynamic, 1> q = start_.cast<T>();
    q[drive] = T::variable(start_[drive]);
    q[drive] = start_[drive] + mechanism_.units()[drive] * (q[drive] - start_[drive]);
    add_infinitesimals(q, solve_);
    double residual = 0;
    for (const T& f : mechanism_.residuals(q)) {
      residual = std::max(residual, std::abs(f.derivative(2)));
    }
    double max_derivative = 1;
    for (const T& x : q) {
      max_derivative =
          std::max({max_derivative, std::abs(x.derivative(1)), std::abs(x.derivative(2))});
    }
    detail::require(residual <= 1e-7 * max_derivative * max_derivative,
                    "duet: driven_motion: a rate of ",
                    mechanism_.tree().coordinate_names()[std::size_t(drive)],
                    " satisfies the equations to first order only: the mechanism does not move");
  }
}

std::string driven_motion::driven() const { return detail::coordinate_list(mechanism_, drives_); }
std::string driven_motion::text(const Eigen::VectorXd& q) const {
  const std::string result = detail::listed(drives_, [&](int i) { return duet::to_text(q[i]); });
  return drives_.size() == 1 ? result : "(" + result + ")";
}
[[noreturn]] void driven_motion::fail(const std::string& what, const Eigen::VectorXd& q,
                                      const Eigen::VectorXd& target) const {
  const Eigen::VectorXd u = q(drives_);
  Eigen::VectorXd to = q;
  to(drives_) = target;
  detail::raise(loop_closure_failure("duet: driven_motion: the loops do not close beyond " +
                                         driven() + " = " + text(q) + " on the line from " +
                                         text(start_) + " to " + text(to) + ": " + what,
                                     {u.begin(), u.end()}));
}

Eigen::VectorXd driven_motion::followed(const Eigen::VectorXd& target) const {
  detail::require(target.allFinite(), "duet: driven_motion: the driven coordinates are not finite");
  const Eigen::VectorXd displacement =
      (target - start_(drives_)).cwiseQuotient(mechanism_.units()(drives_));
  const double length = displacement.norm();
  if (length == 0) {
    return start_;
  }
  const detail::solution_curve curve(mechanism_, start_, drives_, displacement);
  constexpr double min_step = 1e-7;
  auto current = *curve.start(1); // its tangent is defined: drives determine all rates
  const auto require_step = [&](double step) {
    if (step < min_step) {
      fail("continuation fails, branches touch or coordinates are singular",
           curve.coordinates(current.x), target);
    }
  };
  const auto at_target = [&](const Eigen::VectorXd& x) {
    Eigen::VectorXd q = curve.coordinates(x);
    q(drives_) = target;
    return q;
  };
  for (double step = options_.largest_step;;) {
    const auto next = curve.advance(current, step);
    if (!next) {
      step /= 2;
      if (const auto met = curve.branch_point_ahead(current, step)) {
        const Eigen::VectorXd& along = met->tangents[0];
        const double s = met->x[met->x.size() - 1], rate = along[along.size() - 1];
        current = met->points[0];
        step = (current.x - met->x).norm();
        if (current.s() >= length) {
          detail::curve_point guess = current;
          guess.x = met->x + (length - s) / rate * along;
          const auto reached = curve.at(length, guess, step);
          if (reached || curve.residuals(guess.x).norm() <= 1e-12) {
            return at_target(reached ? reached->x : guess.x);
          }
        }
        if (current.s() >= length || current.s_rate() <= 0) {
          fail("dead point at a branch point", curve.coordinates(met->x), target);
        }
        continue;
      }
      require_step(step);
      continue;
    }
    detail::solution_curve::curve_interval to{*next, step};
    if (next->s_rate() <= 0) {
      to = curve.zero(current, *next, step, [](const auto& at) { return at.s_rate(); });
    }
    if (to.end.s() >= length) { // between both points it reaches the target
      const double part = (length - current.s()) / (to.end.s() - current.s());
      const auto guess = curve.advance(current, part * to.step);
      if (const auto reached = curve.at(length, guess ? *guess : to.end, step)) {
        return at_target(reached->x);
      }
    }
    if (next->s_rate() <= 0 && (to.end.s() < length || step < min_step)) {
      fail("dead point, " + detail::moving_coordinates(mechanism_, curve.rates(to.end.tangent)) +
               " still move",
           curve.coordinates(to.end.x), target);
    }
    if (to.end.s() >= length) {
      step /= 2;
      require_step(step);
      continue;
    }
    current = to.end;
    step = std::min(options_.largest_step, 2 * step);
  }
}

motion_trace trace(const driven_motion& motion, int drive, const trace_options& options) {
  const auto count = int(motion.drives().size());
  detail::require(0 <= drive && drive < count, "duet: trace: driven coordinate ", drive,
                  " does not exist, the motion has ", count);
  return detail::tracer(motion, drive, options).run();
}

DUET_ABI_END
} // namespace duet
