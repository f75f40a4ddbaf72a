// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/comparison/jacobian_problem.hpp>
#include <duet/core/constants.hpp>
#include <duet/core/text/number_text.hpp>
#include <duet/quaternion/exponential_jacobian.hpp>
#include <duet/quaternion/rotation.hpp>

#include <Eigen/Core>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <functional>
#include <iterator>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// \file
/// Slips that change a block of a Jacobian by matrix algebra: signs, frames, moment arms.

namespace duet::detail {
DUET_ABI_BEGIN

/// Hypotheses about what the handwritten matrix is, within a rectangle of entries that contains all
/// wrong ones, as a function of the truth. One is accepted if it is right at all samples.
class slips_of_blocks {
protected:
  using matrix = Eigen::MatrixXd;

  using vector = Eigen::VectorXd;

  using kind = jacobian_part::kind;

  /// \param samples  with at least one that is wrong; the wrong ones are searched first
  slips_of_blocks(const jacobian_problem& problem, const std::vector<jacobian_sample>& samples)
      : problem_(problem), inputs_(problem.arguments_and_constants()) {
    for (const bool is_wrong : {true, false}) {
      std::copy_if(samples.begin(), samples.end(), std::back_inserter(samples_),
                   [&](const jacobian_sample& s) { return s.is_wrong == is_wrong; });
    }
    double worst = 0;
    const auto relative_error = [](const jacobian_sample& s) {
      return largest_entry(error_of(s)) / largest_entry(s.exact);
    };
    if (samples_[0].outer.size() == 0) {
      for (const jacobian_sample& s : samples_) {
        worst = s.is_wrong ? std::max(worst, relative_error(s)) : worst;
      }
      for (jacobian_sample& s : samples_) { // round-off leaves at least half of the digits
        const bool is_little = s.is_wrong && relative_error(s) < 1e-6 * std::min(worst, 1.);
        s.little_error = is_little ? largest_entry(error_of(s)) : 0;
      }
    }
    find_wrong_entries();
    find_scopes();
  }

  /// A rectangle of entries.
  struct scope {
    std::string name;
    Eigen::Index row, rows, column, columns;
    const jacobian_part* argument; ///< nullptr if several
    const jacobian_part* result;
  };

  /// Entries of a rectangle by a hypothesis; empty if it does not apply.
  using hypothesis = std::function<matrix(const jacobian_sample&, const scope&)>;

  static matrix of(const matrix& m, const scope& s) {
    return m.block(s.row, s.column, s.rows, s.columns);
  }

  /// Error of all that is written, and of the rows in the columns of a rectangle; what a term of a
  /// rectangle makes of it.
  [[nodiscard]] static matrix error_of(const jacobian_sample& s) {
    return s.outer.size() > 0 ? matrix(s.written - product_of(s.outer, s.exact))
                              : matrix(s.written - s.exact);
  }
  [[nodiscard]] static matrix error_in(const jacobian_sample& s, const scope& at) {
    return s.outer.size() > 0 ? matrix(error_of(s).middleCols(at.column, at.columns))
                              : of(error_of(s), at);
  }
  [[nodiscard]] static matrix effect_of(const jacobian_sample& s, const scope& at,
                                        const matrix& term) {
    return s.outer.size() > 0 ? product_of(s.outer.middleCols(at.row, at.rows), term) : term;
  }

  void find_wrong_entries() {
    first_row_ = first_ = std::numeric_limits<Eigen::Index>::max();
    for (const jacobian_sample& s : samples_) {
      const bool has_factor = s.outer.size() > 0; // rows are not those of the written matrix
      const matrix error = error_of(s);
      for (Eigen::Index i = 0; s.is_wrong && i < error.rows(); ++i) {
        for (Eigen::Index k = 0; k < error.cols(); ++k) {
          if (!(std::abs(error(i, k)) <= s.allowed)) {
            first_row_ = has_factor ? first_row_ : std::min(first_row_, i);
            last_row_ = has_factor ? last_row_ : std::max(last_row_, i);
            first_ = std::min(first_, k);
            last_ = std::max(last_, k);
          }
        }
      }
    }
  }

  void add_scope(const std::string& name, Eigen::Index row, Eigen::Index rows, Eigen::Index column,
                 Eigen::Index columns, const jacobian_part* argument, const jacobian_part* result) {
    const bool is_known = std::any_of(scopes_.begin(), scopes_.end(), [&](const scope& s) {
      return s.row == row && s.rows == rows && s.column == column && s.columns == columns;
    });
    if (row <= first_row_ && last_row_ < row + rows && column <= first_ &&
        last_ < column + columns && !is_known) {
      scopes_.push_back({name, row, rows, column, columns, argument, result});
    }
  }

  /// Rows of a result, or columns of an argument: a single one, half of them or all.
  struct lines {
    std::string name;
    Eigen::Index first, count;
    std::string position = {}; ///< of a single one of several, as "row 2 of "
  };

  /// \param what  "row" or "column"
  [[nodiscard]] static std::vector<lines> lines_of(const jacobian_part& part, const char* what) {
    std::vector<lines> list;
    for (Eigen::Index k = 0; k < part.dimension; ++k) {
      list.push_back(
          {part.name, part.first + k, 1, part.dimension > 1 ? message(what, " ", k, " of ") : ""});
    }
    if (part.dimension == 6) {
      const bool is_pose = part.type == kind::pose;
      list.push_back({part.name + (is_pose ? ".translation" : "[0..2]"), part.first, 3});
      list.push_back({part.name + (is_pose ? ".rotation" : "[3..5]"), part.first + 3, 3});
    } else if (part.type == kind::vector && part.dimension == 4) {
      list.push_back({part.name + "[1..3]", part.first + 1, 3});
    }
    list.push_back({part.name, part.first, part.dimension});
    return list;
  }

  /// All rectangles of the structure that contain the wrong entries, the least first.
  void find_scopes() {
    for (const jacobian_part& r : problem_.results) {
      for (const jacobian_part& a : problem_.arguments) {
        const std::vector<lines> rows = lines_of(r, "row"), columns = lines_of(a, "column");
        for (const int pass : {0, 1, 2}) { // of single rows, of single columns, of all others
          for (const lines& row : rows) {
            for (const lines& column : columns) {
              if (pass != (row.count == 1 ? 0 : column.count == 1 ? 1 : 2)) {
                continue;
              }
              const bool is_entry = row.count * column.count == 1 && r.dimension * a.dimension > 1;
              add_scope(message(is_entry ? message("entry (", row.first - r.first, ", ",
                                                   column.first - a.first, ") of ")
                                         : row.position + column.position,
                                "d ", row.name, " / d ", column.name),
                        row.first, row.count, column.first, column.count, &a, &r);
            }
          }
        }
      }
    }
    const Eigen::Index rows = tangent_size(problem_.results),
                       columns = tangent_size(problem_.arguments);
    for (const jacobian_part& r : problem_.results) {
      for (const lines& row : lines_of(r, "row")) {
        add_scope((row.count > 1 ? "all of " : row.position) + "d " + row.name, row.first,
                  row.count, 0, columns, nullptr, &r);
      }
    }
    for (const jacobian_part& a : problem_.arguments) {
      for (const lines& column : lines_of(a, "column")) {
        add_scope((column.count > 1 ? "all of " : column.position) + "d / d " + column.name, 0,
                  rows, column.first, column.count, &a, nullptr);
      }
    }
    for (auto a = problem_.arguments.begin(); a != problem_.arguments.end(); ++a) {
      const auto end = std::find_if(a, problem_.arguments.end(), [](const jacobian_part& part) {
        return part.type != kind::number;
      });
      if (end - a > 1) {
        add_scope(message("all of d / d ", a->name, " to ", (end - 1)->name), 0, rows, a->first,
                  end - a, nullptr, nullptr);
        a = end - 1;
      }
    }
    add_scope("the whole matrix", 0, rows, 0, columns, nullptr, nullptr);
  }

  [[nodiscard]] static bool fits(const jacobian_sample& s, const scope& at, const matrix& candidate,
                                 double relative = 1e-9) {
    if (!candidate.allFinite()) {
      return false; // at a singularity
    }
    if (s.outer.size() > 0) {
      matrix changed = s.exact;
      changed.block(at.row, at.column, at.rows, at.columns) = candidate;
      const matrix product = product_of(s.outer, changed);
      return is_within(s.written - product, s.allowed + s.little_error, relative, product, product);
    }
    return is_within(of(s.written, at) - candidate, s.allowed + s.little_error, relative,
                     of(s.exact, at), candidate);
  }

  /// True if a rectangle is the written one at all samples.
  ///
  /// \param proposed  (sample): the rectangle; empty if the hypothesis does not apply
  template <class Proposed>
  [[nodiscard]] bool fits_all(const scope& at, const Proposed& proposed,
                              double relative = 1e-9) const {
    return std::all_of(samples_.begin(), samples_.end(), [&](const jacobian_sample& s) {
      const matrix candidate = proposed(s);
      return candidate.size() > 0 && fits(s, at, candidate, relative);
    });
  }

  /// The derivative at another state; NaN where the function refuses it.
  [[nodiscard]] matrix derivative_at(const vector& state) const {
    matrix result = matrix::Constant(samples_[0].exact.rows(), samples_[0].exact.cols(), NAN);
    catching<void>([&] { result = problem_.truth(state).jacobian.template cast<double>(); }, [] {});
    return result;
  }

  /// Some wrong samples, special inputs and random ones, the largest errors first.
  [[nodiscard]] std::vector<const jacobian_sample*> some_wrong_samples() const {
    std::size_t wrong = 0;
    while (wrong < samples_.size() && samples_[wrong].is_wrong) {
      ++wrong;
    }
    std::vector<const jacobian_sample*> list;
    const std::size_t count = std::min<std::size_t>(wrong, 30);
    for (std::size_t n = 0; n < count; ++n) {
      list.push_back(&samples_[wrong - 1 - n * wrong / count]);
    }
    std::sort(list.begin(), list.end(), [](const jacobian_sample* x, const jacobian_sample* y) {
      return largest_entry(error_of(*x)) > largest_entry(error_of(*y));
    });
    return list;
  }

  /// Lists a slip. Of those that say in the same block the same with other words, as the sign of
  /// all and the sign of what is odd in an argument, only the first.
  void accept(const std::string& name, const std::string& block) {
    const auto start = [](const std::string& text) {
      const std::size_t part = text.find(": the part ");
      return part == text.npos ? text : text.substr(0, part);
    };
    const auto is_of = [&](const char* first, const std::string& later, const jacobian_slip& s) {
      return s.name.substr(0, std::strlen(first)) == first && name.substr(0, later.size()) == later;
    };
    const bool is_known = std::any_of(slips_.begin(), slips_.end(), [&](const jacobian_slip& s) {
      return s.name == name ||
             (s.block == block &&
              (start(s.name) == start(name) || is_of("sign", "sign of ", s) ||
               is_of("missing", "missing: one", s) || is_of("half", "half of ", s) ||
               is_of("half", "twice ", s) || is_of("half", "scaled by a constant", s)));
    });
    if (!is_known) {
      slips_.push_back({name, block});
    }
  }

  /// Accepts a hypothesis for the least rectangle in which it is right at all samples.
  bool attempt(const std::string& name, const hypothesis& propose) {
    for (const scope& at : scopes_) {
      if (fits_all(at, [&](const jacobian_sample& s) { return propose(s, at); })) {
        accept(name, at.name);
        return true;
      }
    }
    return false;
  }

  /// Attempts a change of the entries of a rectangle alone.
  template <class Change>
  bool attempt_change(const std::string& name, const Change& change) {
    return attempt(name, [&](const jacobian_sample& s, const scope& at) -> matrix {
      return change(of(s.exact, at));
    });
  }

  /// True if a matrix is that of a rotation, or the adjoint one of a pose.
  [[nodiscard]] static bool is_adjoint(const matrix& m) {
    if (m.rows() != m.cols() || (m.rows() != 3 && m.rows() != 6)) {
      return false;
    }
    const Eigen::Matrix3d r = m.bottomRightCorner(3, 3);
    const double tolerance = 1e-9;
    return largest_entry(product_of(r, r.transpose()) - matrix::Identity(3, 3)) < tolerance &&
           r.determinant() > 0 &&
           (m.rows() == 3 || (largest_entry(m.topLeftCorner(3, 3) - r) < tolerance &&
                              largest_entry(m.bottomLeftCorner(3, 3)) < tolerance));
  }

  void try_algebra() {
    const auto is_square = [](const matrix& m) { return m.rows() == m.cols() && m.rows() > 1; };
    const auto try_factor = [&](const std::string& name, double factor) {
      return attempt_change(name, [&](const matrix& m) -> matrix { return factor * m; });
    };
    try_factor("sign", -1);
    try_factor("missing: zero", 0);
    for (const double sign : {1., -1.}) {
      attempt_change(sign > 0 ? "transposed (column-major data in a row-major array)"
                              : "transposed, with the sign changed",
                     [&](const matrix& m) -> matrix {
                       return is_square(m) ? matrix(sign * m.transpose()) : matrix();
                     });
    }
    // Sums of an identity matrix, or minus one, and something else.
    for (const double one : {1., -1.}) {
      for (const auto& [name, factor] : {std::pair("sign of", -1.), std::pair("missing:", 0.),
                                         std::pair("twice", 2.), std::pair("half of", .5)}) {
        attempt(
            message(name, " one summand: all but ", one < 0 ? "minus " : "", "the identity matrix"),
            [&, one, factor = factor](const jacobian_sample& s, const scope& at) -> matrix {
              const matrix m = of(s.exact, at),
                           identity = one * matrix::Identity(m.rows(), m.cols());
              const bool is_opposite =
                  factor == 0 &&
                  std::all_of(samples_.begin(), samples_.end(), [&](const jacobian_sample& other) {
                    return is_adjoint(-one * of(other.exact, at));
                  });
              return is_square(m) && !is_opposite ? matrix(identity + factor * (m - identity))
                                                  : matrix();
            });
      }
    }
    attempt_change("Jacobian of the inverse", [&](const matrix& m) -> matrix {
      return is_square(m) && is_invertible(m) ? inverse_of(m) : matrix();
    });
    for (const bool is_by_columns : {true, false}) {
      attempt_change(is_by_columns ? "column-major data in a row-major array"
                                   : "row-major data in a column-major array",
                     [&](const matrix& m) -> matrix {
                       const Eigen::Index rows = m.rows(), columns = m.cols();
                       if (rows == 1 || columns == 1 || rows == columns) {
                         return {};
                       }
                       return is_by_columns ? matrix(m.reshaped(columns, rows).transpose())
                                            : matrix(m.transpose().reshaped(rows, columns));
                     });
    }
    for (const char* const which : {"columns", "rows", "rows and columns"}) {
      attempt_change(message(which, " [omega; v] for [v; omega]"), [&](matrix m) -> matrix {
        const bool has_rows = which[0] == 'r', has_columns = which != std::string_view("rows");
        if ((has_rows && m.rows() != 6) || (has_columns && m.cols() != 6)) {
          return {};
        }
        for (Eigen::Index k = 0; k < 3 && has_rows; ++k) {
          m.row(k).swap(m.row(k + 3));
        }
        for (Eigen::Index k = 0; k < 3 && has_columns; ++k) {
          m.col(k).swap(m.col(k + 3));
        }
        return m;
      });
    }
    const double degree = constant::pi<double>() / 180;
    try_factor("half angle for full angle: factor 1/2", .5);
    try_factor("half angle for full angle: factor 2", 2);
    try_factor("degrees: factor pi/180", degree);
    try_factor("degrees: factor 180/pi", 1 / degree);
    // Numbers of the state; lengths of results, of vectors and of their differences.
    const auto try_powers = [&](const std::string& name, const auto& number) {
      if (std::all_of(samples_.begin(), samples_.end(),
                      [&](const jacobian_sample& s) { return number(s) == 0; })) {
        return;
      }
      for (const int power : {1, -1, 2, -2}) {
        attempt(name + (power == 1 ? "" : message("^", power)),
                [&](const jacobian_sample& s, const scope& at) -> matrix {
                  const bool is_undefined = number(s) == 0 && power < 0 && s.outer.size() == 0;
                  return is_undefined ? of(s.written, at)
                                      : matrix(std::pow(number(s), power) * of(s.exact, at));
                });
      }
    };
    const auto try_length = [&](const std::string& name, const auto& length) {
      try_powers("not normalised, or wrong power of a length: scaled by |" + name + "|", length);
    };
    const std::vector<jacobian_part> parts = parts_of_state();
    for (const jacobian_part& a : parts) {
      if (a.type == kind::number) {
        try_powers("scaled by " + a.name,
                   [&](const jacobian_sample& s) { return s.state[a.state]; });
      }
    }
    for (const jacobian_part& r : problem_.results) {
      if (!r.is_motion()) {
        try_length(r.name, [&](const jacobian_sample& s) {
          return s.truth.value.segment(r.state, r.dimension).norm();
        });
      }
    }
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const Eigen::Index a = parts[i].vector_state();
      if (a >= 0) {
        try_length(parts[i].name,
                   [&](const jacobian_sample& s) { return s.state.segment<3>(a).norm(); });
      }
      for (std::size_t k = i + 1; k < parts.size() && a >= 0; ++k) {
        const Eigen::Index b = parts[k].vector_state();
        if (b >= 0) {
          try_length(message(parts[i].name, " - ", parts[k].name), [&](const jacobian_sample& s) {
            return (s.state.segment<3>(a) - s.state.segment<3>(b)).norm();
          });
        }
      }
    }
    // A constant factor, taken from the largest entry of the first wrong sample.
    for (const scope& at : scopes_) {
      if (samples_[0].outer.size() > 0) {
        break;
      }
      const matrix exact = of(samples_[0].exact, at), written = of(samples_[0].written, at);
      Eigen::Index i = 0, k = 0;
      if (exact.cwiseAbs().maxCoeff(&i, &k) > 0) {
        const double factor = written(i, k) / exact(i, k);
        const bool is_named = std::abs(std::abs(factor) - 1) < 1e-9 || factor == 0;
        if (!is_named &&
            try_factor(message("scaled by a constant, ", to_text(float(factor))), factor)) {
          break;
        }
      }
    }
  }

  /// Arguments, constants, and further numbers of the state.
  [[nodiscard]] std::vector<jacobian_part> parts_of_state() const {
    std::vector<jacobian_part> parts = inputs_;
    parts.insert(parts.end(), problem_.context.begin(), problem_.context.end());
    return parts;
  }

  /// A rotation or pose, or one relative to another, at a sample; or a rotation by a vector.
  struct motion {
    std::string name;
    const jacobian_part* part;            ///< of an argument or result
    const jacobian_part* other = nullptr; ///< the rotation relative to this one
    bool is_result = false;
    bool is_alone = false;                   ///< the rotation of a pose alone
    std::size_t first_joint = 0, joints = 0; ///< a product of rotations by successive joints
  };

  /// \param with_vectors  also the rotations by vectors, and of poses alone
  [[nodiscard]] std::vector<motion> motions(bool with_vectors = false) const {
    std::vector<motion> list;
    append_motions(list, inputs_);
    const std::size_t count = list.size();
    append_motions(list, problem_.context);
    append_motions(list, problem_.results, true);
    append_joints(list);
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t k = i + 1; k < count; ++k) {
        list.push_back({list[i].name + "^-1 " + list[k].name, list[k].part, list[i].part});
      }
    }
    for (const bool is_result : {true, false}) {
      for (const jacobian_part& v : is_result ? problem_.results : inputs_) {
        if (with_vectors && v.type == kind::pose) {
          list.push_back({v.name + ".rotation", &v, nullptr, is_result, true});
        }
        if (with_vectors && v.type == kind::vector && v.dimension % 3 == 0 && v.dimension < 7) {
          list.push_back(
              {"exp(" + v.name + (v.dimension == 6 ? "[3..5])" : ")"), &v, nullptr, is_result});
        }
      }
    }
    return list;
  }

  static void append_motions(std::vector<motion>& list, const std::vector<jacobian_part>& parts,
                             bool is_result = false) {
    for (const jacobian_part& a : parts) {
      if (a.is_motion()) {
        list.push_back({a.name, &a, nullptr, is_result});
      }
    }
  }
  void append_joints(std::vector<motion>& list) const {
    for (std::size_t i = 0; i < problem_.joints.size(); ++i) {
      std::string name;
      for (std::size_t k = i; k < problem_.joints.size(); ++k) {
        const auto& [axis, angle] = problem_.joints[k];
        name += (k == i ? "exp(" : " exp(") + axis.name + " " + angle.name + ")";
        list.push_back({name, &axis, nullptr, false, false, i, k + 1 - i});
      }
    }
  }

  [[nodiscard]] static const vector& state_of(const jacobian_sample& s, const motion& m) {
    return m.is_result ? s.truth.value : s.state;
  }

  [[nodiscard]] dual_quaternion<double> pose_of(const jacobian_sample& s, const motion& m) const {
    if (m.joints > 0) {
      quaternion<double> q(1);
      for (std::size_t k = m.first_joint; k < m.first_joint + m.joints; ++k) {
        const auto& [axis, angle] = problem_.joints[k];
        q = q * from_rotation_vector(
                    vector3<double>(s.state[angle.state] * s.state.segment<3>(axis.state)));
      }
      return dual_quaternion<double>(q);
    }
    const auto a = pose_at(*m.part, state_of(s, m));
    return m.other != nullptr ? conj(pose_at(*m.other, s.state)) * a
           : m.is_alone       ? dual_quaternion<double>(rotation(a))
                              : a;
  }
  [[nodiscard]] Eigen::Matrix3d rotation_of(const jacobian_sample& s, const motion& m) const {
    return rotation_matrix(rotation(pose_of(s, m)));
  }

  /// A power of the adjoint matrix of size 3 or 6; empty for other sizes.
  [[nodiscard]] matrix adjoint(const jacobian_sample& s, const motion& m, Eigen::Index size,
                               int power) const {
    if (size != 3 && size != 6) {
      return {};
    }
    const auto a = pose_of(s, m), b = power < 0 ? conj(a) : a;
    return Ad(power * power == 4 ? b * b : b).bottomRightCorner(size, size);
  }
  /// A matrix times a factor from the left or from the right; empty if the factor is of another
  /// size.
  [[nodiscard]] static matrix times(const matrix& m, const matrix& factor, bool is_left) {
    return factor.rows() != (is_left ? m.rows() : m.cols()) ? matrix()
           : is_left                                        ? product_of(factor, m)
                                                            : product_of(m, factor);
  }

  [[nodiscard]] static matrix inverse_of(const matrix& m) {
    return divided(matrix::Identity(m.rows(), m.cols()), m);
  }
  /// True if a square matrix has an inverse with half of the digits at least.
  [[nodiscard]] static bool is_invertible(const matrix& m) {
    return largest_entry(product_of(inverse_of(m), m) - matrix::Identity(m.rows(), m.rows())) <
           1 / most_condition;
  }
  void try_frames() {
    for (const motion& m : motions(true)) {
      const bool is_relative = m.other != nullptr;
      for (const int power : {1, -1, 2, -2}) {
        const bool is_right = problem_.side == perturbation::right;
        const std::string other =
            is_right ? "left perturbation for right" : "right perturbation for left";
        const std::string which =
            message("Ad(", m.name, ")", power == 1 ? "" : message("^", power));
        // Of all, or of all but an identity matrix.
        const auto multiplied = [&](bool is_left, double one) -> hypothesis {
          return [&, is_left, one](const jacobian_sample& s, const scope& at) -> matrix {
            const matrix identity = one * matrix::Identity(at.rows, at.columns);
            const matrix product =
                times(of(s.exact, at) - identity,
                      adjoint(s, m, is_left ? at.rows : at.columns, power), is_left);
            const bool applies = product.size() > 0 && (one == 0 || at.rows == at.columns);
            return applies ? matrix(identity + product) : matrix();
          };
        };
        for (const bool is_left : {false, true}) {
          attempt(message("missing or inverted adjoint: all but the identity matrix multiplied by ",
                          which, " from the ", is_left ? "left" : "right"),
                  multiplied(is_left, 1));
        }
        const bool is_own_argument = !is_relative && !m.is_result && power == (is_right ? -1 : 1);
        attempt(message("missing or inverted adjoint: multiplied by ", which, " from the right",
                        is_own_argument ? message(" (of ", m.name, ": ", other, ")") : ""),
                multiplied(false, 0));
        const bool is_own_result = m.is_result && power == (is_right ? 1 : -1);
        attempt(message("other axes or a missing or inverted adjoint: multiplied by ", which,
                        " from the left",
                        is_own_result ? message(" (of ", m.name, ": ", other, ")")
                        : power == 1  ? " (spatial for body axes)"
                        : power == -1 ? " (body for spatial axes)"
                                      : ""),
                multiplied(true, 0));
        if (power * power == 1) {
          attempt(message("exchanged factors: multiplied by ", which,
                          " from the left and by its inverse from the right"),
                  [&](const jacobian_sample& s, const scope& at) -> matrix {
                    return at.rows != at.columns
                               ? matrix()
                               : times(times(of(s.exact, at), adjoint(s, m, at.rows, power), true),
                                       adjoint(s, m, at.rows, -power), false);
                  });
        }
      }
    }
    for (const motion& m : motions()) {
      for (const int power : {1, -1}) {
        attempt(message("another rotation: that of ", m.name, power < 0 ? "^-1" : "", " instead"),
                [&](const jacobian_sample& s, const scope& at) -> matrix {
                  const matrix exact = of(s.exact, at), r = rotation_of(s, m);
                  if (exact.rows() != 3 || exact.cols() != 3 ||
                      largest_entry(product_of(exact, exact.transpose()) - matrix::Identity(3, 3)) >
                          1e-9) {
                    return {};
                  }
                  return Eigen::Matrix3d(exact).determinant() * (power < 0 ? r.transpose() : r);
                });
      }
    }
    try_exponential_jacobians();
    try_moment_arms();
  }

  /// Vectors that may be rotation vectors: of rotations and vectors of three components.
  void try_exponential_jacobians() {
    std::vector<motion> sources;
    for (const bool is_result : {false, true}) {
      for (const jacobian_part& p : is_result ? problem_.results : inputs_) {
        if (p.is_motion() || (p.type == kind::vector && (p.dimension == 3 || p.dimension == 6))) {
          sources.push_back({p.name, &p, nullptr, is_result});
        }
      }
    }
    for (const motion& from : sources) {
      for (const double sign : {1., -1.}) {
        for (const bool is_inverse : {false, true}) {
          for (const bool is_left : {false, true}) {
            // The square makes the inverse of one another's.
            // Power 0: the Jacobian at that multiple of the vector; for 0 two terms of its series.
            for (const auto& [half, power] :
                 {std::pair(1., 1), std::pair(.5, 1), std::pair(1., 2), std::pair(.5, 0),
                  std::pair(2., 0), std::pair(0., 0)}) {
              if (half == .5 && power == 1 && !from.part->is_motion()) {
                continue;
              }
              const std::string which = message(sign > 0 ? "left" : "right", " Jacobian of exp",
                                                is_inverse ? ", inverse," : "");
              const std::string name =
                  power == 0
                      ? message(half == 0  ? "only two terms"
                                : half < 1 ? "half the angle"
                                           : "twice the angle",
                                " in the ", which, " at ", from.name)
                      : message("right only at the identity of ", from.name, ": multiplied by the ",
                                which, half == 1 ? "" : " at half the angle",
                                power == 1 ? "" : " twice (Jacobian for its inverse)", " from the ",
                                is_left ? "left" : "right");
              attempt(name,
                      [&, half = half, power = power](const jacobian_sample& s,
                                                      const scope& at) -> matrix {
                        if ((is_left ? at.rows : at.columns) != 3) {
                          return {};
                        }
                        const vector& state = state_of(s, from);
                        const Eigen::Vector3d phi =
                            (from.part->is_motion()
                                 ? Eigen::Vector3d(rotation_vector(rotation_at(*from.part, state)))
                                 : Eigen::Vector3d(state.segment<3>(from.part->state +
                                                                    from.part->dimension - 3))) *
                            sign;
                        const auto jacobian_at = [&](double factor, bool inverse) -> matrix {
                          const Eigen::Vector3d x = factor * phi;
                          return inverse ? left_jacobian_inverse(x) : left_jacobian(x);
                        };
                        const auto other = [&]() -> matrix {
                          return half > 0 ? jacobian_at(half, is_inverse)
                                          : matrix::Identity(3, 3) +
                                                (is_inverse ? -.5 : .5) * cross_matrix(phi);
                        };
                        const matrix m = power == 0
                                             ? product_of(jacobian_at(1, !is_inverse), other())
                                             : jacobian_at(half, is_inverse);
                        return times(of(s.exact, at), power == 2 ? product_of(m, m) : m, is_left);
                      });
            }
          }
        }
      }
    }
  }

  /// Vectors of three components that a term may contain: of arguments and results, also in other
  /// axes and from other points, of rotations their imaginary part.
  struct named_vector {
    std::string name;
    Eigen::Vector3d value;
  };

  /// \param with_points  also points moved by rotations and poses, and back
  [[nodiscard]] const std::vector<named_vector>& vectors_of(const jacobian_sample& s,
                                                            bool with_points = false) const {
    std::vector<std::vector<named_vector>>& known = vectors_[with_points ? 1 : 0];
    known.resize(samples_.size());
    std::vector<named_vector>& list = known[std::size_t(&s - samples_.data())];
    if (!list.empty()) {
      return list;
    }
    const std::vector<jacobian_part> parts = parts_of_state();
    const auto add = [&](const std::vector<jacobian_part>& from, const vector& state) {
      for (const jacobian_part& a : from) {
        if (a.vector_state() >= 0) {
          list.push_back({a.vector_name(), state.segment<3>(a.vector_state())});
        } else if (a.type == kind::vector && a.dimension == 6) {
          list.push_back({a.name + "[0..2]", state.segment<3>(a.state)});
          list.push_back({a.name + "[3..5]", state.segment<3>(a.state + 3)});
        }
      }
    };
    for (const jacobian_part& a : parts) {
      if (a.is_motion() || (a.type == kind::vector && a.dimension == 4)) {
        list.push_back({"the vector part of " + a.name, s.state.segment<3>(a.state + 1)});
      }
    }
    const std::size_t first = list.size();
    std::vector<jacobian_part> results = problem_.results;
    std::erase_if(results, [](const jacobian_part& r) { return r.is_motion(); });
    add(results, s.truth.value);
    add(parts, s.state);
    const std::size_t count = list.size();
    std::vector<motion> rotations;
    append_motions(rotations, parts);
    append_joints(rotations);
    for (const motion& m : rotations) {
      const Eigen::Matrix3d r = rotation_of(s, m);
      for (std::size_t i = 0; i < count; ++i) {
        const named_vector v = list[i];
        list.push_back({"(" + m.name + " " + v.name + ")", product_of(r, v.value)});
        list.push_back({"(" + m.name + "^-1 " + v.name + ")", product_of(r.transpose(), v.value)});
        for (std::size_t k = first; k < count && with_points && i >= first; ++k) {
          const named_vector w = list[k];
          if (k != i && (m.part->type == kind::rotation || w.name == m.name + ".translation")) {
            list.push_back({"(" + m.name + " " + v.name + " + " + w.name + ")",
                            product_of(r, v.value) + w.value});
            list.push_back({"(" + m.name + "^-1 (" + v.name + " - " + w.name + "))",
                            product_of(r.transpose(), v.value - w.value)});
          }
        }
      }
    }
    return list;
  }

  /// Columns of rotation that contain a moment about a wrong point: J_w + J_v p^ for a vector p of
  /// the arguments, or a constant one.
  void try_moment_arms() {
    const std::vector<motion> rotations = motions();
    for (const jacobian_part& rotated_part : problem_.arguments) {
      if (!rotated_part.is_motion()) {
        continue;
      }
      const Eigen::Index omega = rotated_part.first + rotated_part.dimension - 3;
      for (const jacobian_part& moved : problem_.arguments) {
        if (moved.vector_state() < 0 ||
            (rotated_part.type == kind::pose && &moved != &rotated_part)) {
          continue;
        }
        for (std::size_t axes = 0; axes < 1 + 2 * rotations.size(); ++axes) {
          const auto force = [&](const jacobian_sample& s, const scope& at) -> matrix {
            const matrix v = s.exact.block(at.row, moved.first, at.rows, 3);
            if (axes == 0) {
              return v;
            }
            const Eigen::Matrix3d r = rotation_of(s, rotations[(axes - 1) / 2]);
            return axes % 2 == 1 ? product_of(v, r) : product_of(v, r.transpose());
          };
          const auto covers = [&](const scope& at) {
            return at.column == omega && at.columns == 3;
          };
          for (const jacobian_part& arm : inputs_) {
            if (arm.vector_state() < 0) {
              continue;
            }
            for (const double sign : {1., -1., 2., -2.}) {
              for (const bool is_other_side : {false, true}) {
                attempt(message("moment arm about another point: off by ", arm.vector_name(),
                                is_other_side ? ", and the other side of perturbation" : ""),
                        [&](const jacobian_sample& s, const scope& at) -> matrix {
                          if (!covers(at)) {
                            return {};
                          }
                          matrix out = of(s.exact, at);
                          if (is_other_side) {
                            const Eigen::Matrix3d r =
                                rotation_matrix(rotation_at(rotated_part, s.state));
                            out = product_of(
                                out, problem_.side == perturbation::right ? r.transpose() : r);
                          }
                          return out + product_of(force(s, at),
                                                  cross_matrix(sign * s.state.segment<3>(
                                                                          arm.vector_state())));
                        });
              }
            }
          }
          for (const scope& at : scopes_) {
            if (covers(at)) {
              try_constant_vector(
                  "moment arm about another point: off by the constant", at,
                  [&](const jacobian_sample& s, const Eigen::Vector3d& c) -> matrix {
                    return product_of(force(s, at), cross_matrix(c));
                  });
            }
          }
        }
      }
    }
  }

  /// Columns of rotation J_v a^ with another vector a than the right one.
  void try_other_arms() {
    for (const jacobian_part& m : problem_.arguments) {
      const Eigen::Index omega = m.first + m.dimension - 3;
      for (const jacobian_part& moved : problem_.arguments) {
        if (!m.is_motion() || moved.vector_state() < 0) {
          continue;
        }
        for (std::size_t n = 0; n < vectors_of(samples_[0], true).size(); ++n) {
          for (const double sign : {1., -1.}) {
            attempt(message("moment arm about another point: ",
                            vectors_of(samples_[0], true)[n].name, " instead"),
                    [&](const jacobian_sample& s, const scope& at) -> matrix {
                      return at.column != omega || at.columns != 3
                                 ? matrix()
                                 : product_of(s.exact.block(at.row, moved.first, at.rows, 3),
                                              cross_matrix(sign * vectors_of(s, true)[n].value));
                    });
          }
        }
      }
    }
  }

  /// Limit of the condition number of a matrix that a hypothesis inverts, and of a coefficient of
  /// its own for every sample: beyond it, round-off leaves less than half of the digits.
  static constexpr double most_condition = 1e8; // 1/sqrt(epsilon), rounded

  /// The coefficient of a term in an error.
  [[nodiscard]] static double coefficient(const matrix& error, const matrix& value) {
    const double square = value.squaredNorm();
    return square > 0 ? error.cwiseProduct(value).sum() / square : 0;
  }

  /// A term that is linear in a constant vector, which is found by least squares.
  ///
  /// \param term  (sample, constant): the term
  template <class Term>
  bool try_constant_vector(const std::string& name, const scope& at, const Term& term) {
    const std::vector<const jacobian_sample*> used = some_wrong_samples();
    if (used.size() < 4) {
      return false;
    }
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (const jacobian_sample* s : used) {
      const matrix error = error_in(*s, at);
      matrix columns(error.size(), 3);
      for (int k = 0; k < 3; ++k) {
        const matrix effect = effect_of(*s, at, term(*s, Eigen::Vector3d::Unit(k)));
        columns.col(k) = effect.reshaped();
      }
      normal += product_of(columns.transpose(), columns);
      right += product_of(columns.transpose(), error.reshaped());
    }
    const Eigen::Vector3d c = least_norm_solution(normal, right);
    const auto changed = [&](const jacobian_sample& s) -> matrix {
      return of(s.exact, at) + term(s, c);
    };
    if (!c.allFinite() || c.norm() == 0 || !fits_all(at, changed, 1e-8)) {
      return false;
    }
    accept(message(name, " (", to_text(float(c[0])), ", ", to_text(float(c[1])), ", ",
                   to_text(float(c[2])), ")"),
           at.name);
    return true;
  }

  const jacobian_problem& problem_;

  const std::vector<jacobian_part> inputs_; ///< arguments and constants

  std::vector<jacobian_sample> samples_;

  Eigen::Index first_row_ = 0, last_row_ = -1, first_ = 0, last_ = -1; ///< of the wrong entries
  std::vector<scope> scopes_;
  mutable std::vector<std::vector<named_vector>> vectors_[2]; ///< of the samples

  std::vector<jacobian_slip> slips_;
};

DUET_ABI_END
} // namespace duet::detail
