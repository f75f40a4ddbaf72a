// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "loops/branch_finder.hpp"

#include "loops/rank_revealing_svd.hpp"
#include "loops/second_derivatives.hpp"

#include <duet/core/random_source.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

namespace duet::detail {
DUET_ABI_BEGIN

namespace {

class branch_finder {
public:
  explicit branch_finder(const solution_curve& curve) : curve_(curve) {}

  [[nodiscard]] std::optional<branch_point_data> ahead(const curve_point& from, double step) const {
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
    const Eigen::VectorXd& s = reduced.singular_values();
    Eigen::Index lost = 0; // rank that is lost, as far as visible from this point
    while (lost < r && s[r - 1 - lost] < 10 * within * s[0]) {
      ++lost;
    }
    if (lost == 0) {
      return std::nullopt;
    }
    const Eigen::Index all = n + r * lost;
    const Eigen::MatrixXd w0 = reduced.left().rightCols(lost);
    Eigen::VectorXd x = from.x;
    Eigen::MatrixXd w = w0;
    for (int i = 0; i < 12; ++i) {
      const Eigen::MatrixXd a = u.transpose().lazyProduct(curve_.matrix(x));
      const auto forms = curve_.forms(x, u.lazyProduct(w), Eigen::MatrixXd::Identity(n, n));
      Eigen::VectorXd f(r + n * lost + lost * lost);
      Eigen::MatrixXd j = Eigen::MatrixXd::Zero(f.size(), all);
      f.head(r) = u.transpose() * curve_.residuals(x);
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
      if (svd.rank() < all) {
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
        const bool closes = curve_.residuals(x).norm() <= 1e-12 * std::max(1.0, x.norm());
        return closes ? std::optional(x) : std::nullopt;
      }
    }
    return std::nullopt;
  }

  /// Lines along which rates have accelerations: v in the kernel K of A with wᵀ ∂²F(v, v) = 0 for
  /// all w orthogonal to its image. For a kernel of dimension two these are the zeros of a form in
  /// the plane, otherwise they are searched for from random starts.
  [[nodiscard]] std::vector<Eigen::VectorXd> tangents(const Eigen::VectorXd& x) const {
    const rank_revealing_svd a(curve_.matrix(x));
    const Eigen::MatrixXd kernel = a.kernel();
    const std::vector<Eigen::MatrixXd> forms = curve_.forms(x, a.cokernel(), kernel);
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
      result.push_back(first_that_moves(curve_.rates(line)) < 0 ? -line : line);
    }
    std::sort(result.begin(), result.end(), [&](const auto& p, const auto& q) {
      return first_that_moves(curve_.rates(p) - curve_.rates(q)) > 0;
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
    const Eigen::VectorXd form = svd.right().col(0);
    const double cosine = -form[0] / std::hypot(form[1], form[2]);
    if (!(std::abs(cosine) < 1)) {
      return {};
    }
    const double centre = std::atan2(form[2], form[1]), half_width = std::acos(cosine);
    std::vector<double> result;
    for (const double twice : {centre + half_width, centre - half_width}) {
      const Eigen::VectorXd rest = parts * Eigen::Vector3d(1, std::cos(twice), std::sin(twice));
      if (rest.norm() < rank_revealing_svd::rank_tolerance * svd.singular_values()[0]) {
        result.push_back(twice / 2);
      }
    }
    return result;
  }

  /// A point of the curve that leaves x along a tangent.
  [[nodiscard]] std::optional<curve_point> point_along(const Eigen::VectorXd& x,
                                                       const Eigen::VectorXd& tangent) const {
    for (double step = 1e-3; step > 1e-5; step /= 2) {
      const auto point = curve_.nearest_point(x + step * tangent, tangent, step / 4);
      if (point && point->tangent.dot(tangent) > .99) {
        return point;
      }
    }
    return std::nullopt;
  }

  const solution_curve& curve_;
};

} // namespace

std::optional<branch_point_data> branch_point_ahead(const solution_curve& curve,
                                                    const curve_point& from, double step) {
  return branch_finder(curve).ahead(from, step);
}

DUET_ABI_END
} // namespace duet::detail
