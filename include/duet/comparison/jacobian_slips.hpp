// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/comparison/jacobian_problem.hpp>
#include <duet/comparison/slips_of_terms.hpp>
#include <duet/quaternion/exponential_jacobian.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/rotation.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cstddef>
#include <functional>
#include <initializer_list>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

/// \file
/// Search for the single slip that makes a handwritten Jacobian wrong. For `judge_jacobian`.

namespace duet::detail {
DUET_ABI_BEGIN

/// Searches all slips of blocks, points and terms, also in one factor of a chain and in derivatives
/// by stored numbers.
class jacobian_slip_search : protected slips_of_terms {
public:
  /// \param samples  with at least one that is wrong; the wrong ones are searched first
  jacobian_slip_search(const jacobian_problem& problem, const std::vector<jacobian_sample>& samples)
      : slips_of_terms(problem, samples) {}

  [[nodiscard]] std::vector<jacobian_slip> found() {
    // Any hypothesis fits errors that are no larger than it may leave: only branches are tried
    // there.
    const scope least = scopes_.front();
    std::erase_if(scopes_, [&](const scope& at) {
      return fits_all(
          at, [&](const jacobian_sample& s) { return of(s.exact, at); }, 1e-8);
    });
    if (scopes_.empty()) {
      scopes_ = {least};
      if (problem_.written) {
        try_regions();
      }
      return std::move(slips_);
    }
    try_algebra();
    try_frames();
    if (problem_.truth) {
      try_other_points();
      try_parts_of_sums();
    }
    try_summands();
    if (samples_[0].outer.size() == 0) {
      try_columns();
      try_constants();
      if (last_ == first_ && last_row_ == first_row_) {
        try_entry();
      }
      if (problem_.written) {
        try_charts();
        try_regions();
        for (const std::function<void()>& attempts : std::initializer_list<std::function<void()>>{
                 [&] { try_parts_by_intermediates(); }, [&] { try_stored_numbers(); },
                 [&] { try_chains(); },
                 [&] {
                   try_other_arms();
                   try_axes_of_results();
                 },
                 [&] { try_weights(); }, [&] { try_other_terms(); }}) {
          if (slips_.empty()) {
            attempts();
          }
        }
        for (const jacobian_slip& s : weak_) {
          if (!slips_.empty()) {
            accept(s.name, s.block);
          }
        }
      } else if (!problem_.constants.empty() && slips_.empty()) {
        try_chains(); // a constant may follow in the chain
      }
    }
    return std::move(slips_);
  }

private:
  /// Parts of sums by products of two rotations and by moved points.
  void try_parts_by_intermediates() {
    for (const intermediate& z : intermediates()) {
      if (z.part.type != kind::pose) {
        try_parts_by(z.part.name, [&](const vector& state, double factor) {
          vector value = z.evaluate(state).value;
          if (z.part.type == kind::vector) {
            value *= factor;
          } else {
            set_rotation(value, z.part,
                         factor == 0 ? quaternion<double>(1) : conj(rotation_at(z.part, value)));
          }
          return z.set(state, value);
        });
      }
    }
  }

  /// A function of some arguments through which others may depend on these.
  struct intermediate {
    jacobian_part part; ///< its kind and name
    std::vector<const jacobian_part*> arguments;
    std::function<jacobian_evaluation(const vector&)> evaluate;
    std::function<vector(vector, const vector&)> set; ///< a state that gives another value
    /// The rotated vector in a moved point, and the vector that is rotated.
    std::function<std::pair<Eigen::Vector3d, Eigen::Vector3d>(const vector&)> rotated{};
    const jacobian_part* axis = nullptr; ///< of a joint: a constant
  };

  /// Points moved by rotations and poses and back, products of two rotations or poses, and
  /// rotations by vectors.
  [[nodiscard]] std::vector<intermediate> intermediates() const {
    std::vector<intermediate> list;
    const Eigen::Index columns = tangent_size(inputs_);
    const bool is_right = problem_.side == perturbation::right;
    for (const jacobian_part& m : inputs_) {
      if (!m.is_motion()) {
        continue;
      }
      for (const jacobian_part& v : inputs_) {
        if (v.type != kind::vector || v.dimension != 3) {
          continue;
        }
        std::vector<const jacobian_part*> offsets = {nullptr};
        for (const jacobian_part& w : inputs_) {
          if (m.type == kind::rotation && &w != &v && w.type == kind::vector && w.dimension == 3) {
            offsets.push_back(&w);
          }
        }
        for (const jacobian_part* w : offsets) {
          for (const bool is_back : {false, true}) {
            intermediate z;
            z.arguments = {&m, &v};
            const bool is_pose = m.type == kind::pose;
            z.part = {
                kind::vector,
                is_back ? message(m.name, "^-1 ",
                                  w != nullptr ? message("(", v.name, " - ", w->name, ")") : v.name)
                        : message(m.name, " ", v.name, w != nullptr ? " + " + w->name : ""),
                0, 0, 3};
            if (w != nullptr) {
              z.arguments.push_back(w);
            }
            const auto offset_at = [is_pose, w, &m](const vector& x) -> Eigen::Vector3d {
              return is_pose        ? Eigen::Vector3d(x.segment<3>(m.state + 4))
                     : w != nullptr ? Eigen::Vector3d(x.segment<3>(w->state))
                                    : Eigen::Vector3d::Zero();
            };
            const auto axes_at = [=, &m](const vector& x) -> Eigen::Matrix3d {
              const Eigen::Matrix3d r = rotation_matrix(rotation_at(m, x));
              return is_back ? Eigen::Matrix3d(r.transpose()) : r;
            };
            z.rotated = [=, &v](const vector& x) {
              const Eigen::Vector3d point = x.segment<3>(v.state);
              const Eigen::Vector3d before =
                  is_back ? Eigen::Vector3d(point - offset_at(x)) : point;
              return std::pair(Eigen::Vector3d(product_of(axes_at(x), before)), before);
            };
            z.evaluate = [=, this, &m, &v, rotated_at = z.rotated](const vector& x) {
              const Eigen::Matrix3d one = Eigen::Matrix3d::Identity(), axes = axes_at(x);
              // By right perturbation: of R p + t, R, -R p^ and R; of R^T (p - t), -1, y^ and R^T.
              const auto [rotated, before] = rotated_at(x);
              matrix j = matrix::Zero(3, columns);
              j.middleCols(v.first, 3) = axes;
              if (is_pose) {
                j.middleCols(m.first, 3) = is_back ? Eigen::Matrix3d(-one) : axes;
              } else if (w != nullptr) {
                j.middleCols(w->first, 3) = is_back ? Eigen::Matrix3d(-axes) : one;
              }
              j.middleCols(m.first + m.dimension - 3, 3) =
                  is_back ? matrix(cross_matrix(rotated)) : product_of(axes, cross_matrix(-before));
              if (!is_right) {
                const matrix adjoint = Ad(conj(pose_at(m, x)));
                j.middleCols(m.first, m.dimension) =
                    product_of(j.middleCols(m.first, m.dimension),
                               adjoint.bottomRightCorner(m.dimension, m.dimension));
              }
              return evaluation_of(is_back ? rotated : Eigen::Vector3d(rotated + offset_at(x)), j);
            };
            z.set = [=, &v](vector x, const vector& value) {
              const Eigen::Matrix3d back = axes_at(x).transpose();
              x.segment<3>(v.state) = is_back
                                          ? Eigen::Vector3d(product_of(back, value) + offset_at(x))
                                          : Eigen::Vector3d(product_of(back, value - offset_at(x)));
              return x;
            };
            list.push_back(std::move(z));
          }
        }
      }
      for (const jacobian_part& n : inputs_) {
        if (&n == &m || n.type != m.type) {
          continue;
        }
        for (const bool is_back : {true, false}) {
          intermediate z;
          z.arguments = {&m, &n};
          z.part = {m.type, message(m.name, is_back ? "^-1 " : " ", n.name), 0, 0, m.dimension};
          const jacobian_part whole{m.type, "", 0, 0, m.dimension};
          z.evaluate = [=, this, &m, &n](const vector& x) {
            // In body axes: of a^-1 b, -Ad(b^-1 a) and 1; of a b, Ad(b^-1) and 1. In fixed axes: of
            // a^-1 b, -Ad(a^-1) and Ad(a^-1); of a b, 1 and Ad(a).
            const auto a = pose_at(m, x), b = pose_at(n, x);
            const auto adjoint = [&](const dual_quaternion<double>& c) -> matrix {
              return Ad(c).bottomRightCorner(m.dimension, m.dimension);
            };
            const matrix one = matrix::Identity(m.dimension, m.dimension);
            matrix j = matrix::Zero(m.dimension, columns);
            if (is_right) {
              j.middleCols(m.first, m.dimension) =
                  is_back ? matrix(-adjoint(conj(b) * a)) : adjoint(conj(b));
              j.middleCols(n.first, n.dimension) = one;
            } else {
              j.middleCols(m.first, m.dimension) = is_back ? matrix(-adjoint(conj(a))) : one;
              j.middleCols(n.first, n.dimension) = adjoint(is_back ? conj(a) : a);
            }
            vector value = vector::Zero(m.state_size());
            set_pose(value, whole, (is_back ? conj(a) : a) * b);
            return evaluation_of(value, j);
          };
          z.set = [=, &m, &n](vector x, const vector& value) {
            const auto a = pose_at(m, x);
            set_pose(x, n, (is_back ? a : conj(a)) * pose_at(whole, value));
            return x;
          };
          list.push_back(std::move(z));
        }
      }
    }
    add_increments(list);
    return list;
  }

  /// Rotations exp((v - w) t) by a vector or a difference of two, also times a number, as by an
  /// angular velocity less its bias in a time step.
  void add_increments(std::vector<intermediate>& list) const {
    const bool is_right = problem_.side == perturbation::right;
    std::vector<const jacobian_part*> vectors = {nullptr}, scalars = {nullptr};
    for (const jacobian_part& a : inputs_) {
      if (a.type == kind::vector && a.dimension == 3) {
        vectors.push_back(&a);
      } else if (a.type == kind::number) {
        scalars.push_back(&a);
      }
    }
    for (const jacobian_part* v : vectors) {
      for (const jacobian_part* w : vectors) {
        for (const jacobian_part* t : scalars) {
          const bool is_joint =
              w == nullptr && problem_.written &&
              std::any_of(problem_.joints.begin(), problem_.joints.end(), [&](const auto& joint) {
                return v != nullptr && t != nullptr && joint.first.state == v->state &&
                       joint.second.state == t->state;
              });
          if (v == nullptr || v == w || !(has_columns(*v) || is_joint)) {
            continue;
          }
          intermediate z;
          z.axis = is_joint ? v : nullptr;
          z.part = {kind::rotation,
                    message("exp(",
                            w != nullptr ? message("(", v->name, " - ", w->name, ")") : v->name,
                            t != nullptr ? " " + t->name : "", ")"),
                    0, 0, 3};
          for (const jacobian_part* each : {v, w, t}) {
            if (each != nullptr) {
              z.arguments.push_back(each);
            }
          }
          const auto offset = [w](const vector& x) -> Eigen::Vector3d {
            return w != nullptr ? Eigen::Vector3d(x.segment<3>(w->state)) : Eigen::Vector3d::Zero();
          };
          const auto time = [t](const vector& x) { return t != nullptr ? x[t->state] : 1.; };
          z.evaluate = [=, this, part = z.part](const vector& x) {
            const Eigen::Vector3d rate = x.segment<3>(v->state) - offset(x);
            const vector3<double> r = time(x) * rate;
            const Eigen::Matrix3d by_vector = is_right ? right_jacobian(r) : left_jacobian(r);
            matrix j = matrix::Zero(3, tangent_size(inputs_));
            j.middleCols(v->first, 3) = time(x) * by_vector;
            if (w != nullptr) {
              j.middleCols(w->first, 3) = -time(x) * by_vector;
            }
            if (t != nullptr) {
              j.col(t->first) = rate;
            }
            vector value = vector::Zero(4);
            set_rotation(value, part, from_rotation_vector(r));
            return evaluation_of(value, j);
          };
          z.set = [=, part = z.part](vector x, const vector& value) {
            x.segment<3>(v->state) =
                rotation_vector(rotation_at(part, value)) / time(x) + offset(x);
            return x;
          };
          list.push_back(std::move(z));
        }
      }
    }
  }

  static void set_pose(vector& x, const jacobian_part& part, const dual_quaternion<double>& a) {
    set_rotation(x, part, rotation(a));
    if (part.type == kind::pose) {
      x.segment<3>(part.state + 4) = translation(a);
    }
  }

  /// Slips in derivatives by stored numbers. These are not unique where numbers are bound together:
  /// what is written may be the derivative of a function that continues f to quaternions of any
  /// norm without changing it, or quadratically, as q p q* and p + 2 w v x p + 2 v x (v x p) do.
  void try_stored_numbers() {
    const Eigen::Index stored = stored_size(problem_.arguments);
    if (samples_[0].raw.cols() != stored || stored == samples_[0].exact.cols()) {
      return;
    }
    jacobian_problem part = problem_;
    part.written = nullptr;
    part.arguments.clear();
    std::vector<Eigen::Index> order; // columns as returned
    for (const jacobian_part& a : problem_.arguments) {
      const Eigen::Index count = a.vector_size();
      if (count > 0) {
        part.arguments.push_back({a.type == kind::number ? kind::number : kind::vector,
                                  a.vector_name(), a.vector_first(), a.state, count});
      }
      for (Eigen::Index k = 0; k < count; ++k) {
        order.push_back(a.state + k);
      }
      if (a.is_motion()) {
        const Eigen::Index q = a.state + count;
        part.arguments.push_back({kind::vector, a.name, a.state, q, 4});
        const bool is_w_first = problem_.order == quaternion_order::wxyz;
        for (const Eigen::Index k : {0, 1, 2, 3}) {
          order.push_back(q + (is_w_first ? k : (k + 3) % 4));
        }
      }
    }
    std::copy_if(problem_.arguments.begin(), problem_.arguments.end(),
                 std::back_inserter(part.context),
                 [](const jacobian_part& a) { return a.is_motion(); });
    try_continued(part, order, nullptr);
    const bool has_motions = std::any_of(problem_.results.begin(), problem_.results.end(),
                                         [](const jacobian_part& r) { return r.is_motion(); });
    for (const jacobian_part& a : problem_.arguments) {
      if (a.type == kind::rotation && !has_motions && slips_.empty()) {
        // All of f grows with the square of the norm.
        try_continued(part, order, [&a](const vector&, const auto& there, const matrix&) {
          return std::pair(&a, vector(2 * there.value));
        });
      }
    }
    for (const intermediate& z : intermediates()) {
      for (const bool from_vector : {false, true}) {
        if (z.rotated && has_columns(*z.arguments[0]) && slips_.empty()) {
          // Change of f with the norm of the quaternion: A times twice what is rotated, or twice
          // its difference to the vector before.
          try_continued(part, order, [&](const vector& x, const auto&, const matrix& exact) {
            const matrix factor = z.evaluate(x).jacobian.template cast<double>();
            const matrix outer = divided(in_columns(exact, columns_of(z)), factor);
            const auto [rotated, before] = z.rotated(x);
            return std::pair(
                z.arguments[0],
                vector(2 * product_of(outer, rotated - (from_vector ? 1. : 0.) * before)));
          });
        }
      }
    }
  }

  using growth = std::function<std::pair<const jacobian_part*, vector>(
      const vector&, const jacobian_evaluation&, const matrix&)>;

  /// \param part    the problem with stored numbers as arguments
  /// \param order   columns of what is returned, in the order of the arguments
  /// \param change  the argument with the quaternion, and the derivative of f with its norm
  void try_continued(jacobian_problem part, const std::vector<Eigen::Index>& order,
                     const growth& change) {
    const Eigen::Index stored = Eigen::Index(order.size());
    const auto exact_at = [&](const vector& x, const jacobian_evaluation& truth) {
      const matrix tangent = truth.jacobian.template cast<double>();
      matrix result(tangent.rows(), stored);
      for (const jacobian_part& a : problem_.arguments) {
        const matrix chart = chart_derivative(a, x, problem_.side, quaternion_order::wxyz);
        result.middleCols(a.state, a.state_size()) =
            divided(tangent.middleCols(a.first, a.dimension), chart);
      }
      if (change) {
        const auto [argument, by_norm] = change(x, truth, tangent);
        for (const jacobian_part& p : part.arguments) {
          if (p.dimension == 4 && p.state == argument->state) {
            result.middleCols(p.first, 4) += by_norm * x.segment(p.state, 4).transpose();
          }
        }
      }
      return result;
    };
    part.truth = [&](const vector& x) {
      jacobian_evaluation there = problem_.truth(x);
      there.jacobian = exact_at(x, there).template cast<long double>();
      return there;
    };
    std::vector<jacobian_sample> samples = samples_;
    for (jacobian_sample& s : samples) {
      const matrix error = s.written - s.exact;
      s.exact = exact_at(s.state, s.truth);
      s.written.resize(s.raw.rows(), stored);
      for (Eigen::Index k = 0; k < stored; ++k) {
        s.written.col(k) = s.raw.col(order[std::size_t(k)]);
      }
      // Beyond unit quaternions the handwritten function may be continued otherwise: columns of
      // other rotations become the exact ones plus their error in tangent coordinates.
      for (const jacobian_part& a : problem_.arguments) {
        if (a.is_motion() && (last_ < a.first || first_ >= a.first + a.dimension)) {
          const matrix chart = chart_derivative(a, s.state, problem_.side, quaternion_order::wxyz);
          s.written.middleCols(a.state, a.state_size()) =
              s.exact.middleCols(a.state, a.state_size()) +
              divided(error.middleCols(a.first, a.dimension), chart);
        }
      }
      s.allowed += 1e-12 * largest_entry(s.exact);
      s.is_wrong = largest_entry(s.written - s.exact) > s.allowed;
    }
    append(jacobian_slip_search(part, samples).found(), ", by stored numbers");
  }

  /// \param j  with columns for arguments and constants
  [[nodiscard]] jacobian_evaluation evaluation_of(const vector& value, const matrix& j) const {
    const Eigen::Index columns = tangent_size(problem_.arguments);
    const long_matrix all = j.template cast<long double>();
    return {value, all.leftCols(columns), 0, all.rightCols(j.cols() - columns)};
  }
  [[nodiscard]] bool has_columns(const jacobian_part& part) const {
    return part.first < tangent_size(problem_.arguments);
  }
  /// True for the columns of the arguments that an intermediate result depends on.
  [[nodiscard]] std::vector<bool> columns_of(const intermediate& z) const {
    std::vector<bool> result(std::size_t(tangent_size(problem_.arguments)), false);
    for (const jacobian_part* a : z.arguments) {
      if (has_columns(*a)) {
        std::fill_n(result.begin() + a->first, a->dimension, true);
      }
    }
    return result;
  }
  /// The matrix with zeros in all other columns.
  [[nodiscard]] static matrix in_columns(matrix m, const std::vector<bool>& is_column) {
    for (Eigen::Index k = 0; k < m.cols(); ++k) {
      if (!is_column[std::size_t(k)]) {
        m.col(k).setZero();
      }
    }
    return m;
  }
  /// Without rows of results, or of halves of them, in which all is right.
  [[nodiscard]] matrix in_wrong_rows(matrix m) const {
    for (const jacobian_part& r : problem_.results) {
      const Eigen::Index size = r.dimension == 6 ? 3 : r.dimension;
      for (Eigen::Index row = r.first; row < r.first + r.dimension; row += size) {
        if (last_row_ < row || first_row_ >= row + size) {
          m.middleRows(row, size).setZero();
        }
      }
    }
    return m;
  }

  /// The matrix with the columns of the axis of a joint, too.
  [[nodiscard]] static matrix with_axis(const matrix& m, const jacobian_evaluation& there,
                                        const intermediate& z) {
    if (z.axis == nullptr) {
      return m;
    }
    matrix all(m.rows(), m.cols() + 3);
    all << m, there.by_constants.middleCols(z.axis->first - m.cols(), 3).template cast<double>();
    return all;
  }

  /// Slips in one factor of a chain: the function depends on some arguments through an
  /// intermediate one, J = A Z, and the slip is in A or in Z.
  void try_chains() {
    for (const intermediate& z : intermediates()) {
      const std::vector<bool> is_column = columns_of(z);
      // The slip may be in the columns of some arguments alone.
      std::vector<bool> is_used = is_column;
      bool has_wrong_elsewhere = false;
      for (const jacobian_part& a : problem_.arguments) {
        if (last_ < a.first || first_ >= a.first + a.dimension) {
          std::fill_n(is_used.begin() + a.first, a.dimension, false);
        } else {
          has_wrong_elsewhere = has_wrong_elsewhere || !is_column[std::size_t(a.first)];
        }
      }
      if (has_wrong_elsewhere) {
        continue;
      }
      std::vector<jacobian_sample> inner, outer;
      bool is_chain = true;
      bool has_outer = z.axis == nullptr; // one column does not determine it
      for (const jacobian_sample& s : samples_) {
        const jacobian_evaluation middle = z.evaluate(s.state);
        const matrix factor = middle.jacobian.template cast<double>();
        const matrix exact = in_columns(in_wrong_rows(s.exact), is_column),
                     written = in_columns(in_wrong_rows(s.written), is_column),
                     used = in_columns(factor, is_used),
                     all = in_wrong_rows(with_axis(exact, s.truth, z)),
                     all_factors = with_axis(factor, middle, z), a = divided(all, all_factors),
                     b = divided(written, used);
        is_chain =
            is_chain && is_within(all - product_of(a, all_factors), s.allowed, 1e-9, all, all);
        if (z.axis != nullptr && !is_invertible(product_of(all_factors, all_factors.transpose()))) {
          continue; // no rotation, so that A is unknown
        }
        for (Eigen::Index k = 0; k < exact.cols() && has_outer; ++k) {
          const double error = largest_entry(written.col(k) - product_of(b, used.col(k)));
          has_outer =
              !is_used[std::size_t(k)] || error <= s.allowed + 1e-9 * largest_entry(written.col(k));
        }
        if (!is_chain) {
          break;
        }
        jacobian_sample sample = s;
        sample.allowed += 1e-12 * largest_entry(s.exact);
        sample.exact = factor;
        sample.written = written;
        sample.outer = a;
        sample.truth = middle;
        inner.push_back(sample);
        sample.outer.resize(0, 0);
        sample.exact = a;
        sample.written = b;
        sample.allowed += 1e-10 * largest_entry(a);
        sample.raw = b;
        sample.is_wrong = largest_entry(a - b) > sample.allowed;
        sample.state.resize(s.state.size() + middle.value.size());
        sample.state << s.state, middle.value;
        sample.truth = s.truth;
        outer.push_back(sample);
      }
      if (!is_chain || inner.empty() || !inner[0].is_wrong) {
        continue;
      }
      jacobian_problem part = problem_;
      part.written = nullptr;
      if (has_outer && std::any_of(outer.begin(), outer.end(),
                                   [](const jacobian_sample& s) { return s.is_wrong; })) {
        part.truth = [&](const vector& x) {
          const Eigen::Index size = samples_[0].state.size();
          const vector state = z.set(x.head(size), x.tail(x.size() - size));
          jacobian_evaluation there = problem_.truth(state);
          const matrix factor = z.evaluate(state).jacobian.template cast<double>();
          const matrix exact =
              in_columns(in_wrong_rows(there.jacobian.template cast<double>()), is_column);
          there.jacobian = divided(exact, factor).template cast<long double>();
          return there;
        };
        part.arguments = {z.part};
        part.arguments[0].name = "(" + z.part.name + ")";
        part.arguments[0].state = samples_[0].state.size();
        part.context = problem_.arguments;
        for (const jacobian_part* a : z.arguments) {
          if (!has_columns(*a)) {
            part.context.push_back(*a);
            std::erase_if(part.constants, [a](const auto& c) { return c.state == a->state; });
          }
        }
        append(jacobian_slip_search(part, outer).found());
      }
      part.arguments = problem_.arguments;
      part.constants = problem_.constants;
      part.context.clear();
      part.results = {z.part};
      part.results[0].name = "(" + z.part.name + ")";
      part.truth = z.evaluate;
      append(jacobian_slip_search(part, inner).found());
    }
  }

  /// Slips in the matrix before a change to the axes of an argument.
  void try_axes_of_results() {
    const Eigen::Index rows = samples_[0].exact.rows();
    jacobian_problem part = problem_;
    part.truth = nullptr;
    part.written = nullptr;
    for (const motion& m : motions()) {
      for (const int power : {1, -1}) {
        std::vector<jacobian_sample> samples = samples_;
        for (jacobian_sample& s : samples) {
          const matrix axes = adjoint(s, m, rows, -power);
          if (axes.size() == 0) {
            return;
          }
          s.exact = product_of(axes, s.exact);
          s.written = product_of(axes, s.written);
          s.allowed += 1e-12 * largest_entry(s.exact);
        }
        append(jacobian_slip_search(part, samples).found(),
               message(", in the axes of ", m.name, power < 0 ? "^-1" : ""));
      }
    }
  }

  void append(const std::vector<jacobian_slip>& more,
              const std::string& where = ", inherited through the chain") {
    for (const jacobian_slip& s : more) {
      accept(s.name, s.block + where);
    }
  }
};

DUET_ABI_END
} // namespace duet::detail
