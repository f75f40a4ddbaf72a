// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/comparison/jacobian_problem.hpp>
#include <duet/comparison/slips_at_points.hpp>
#include <duet/core/text/number_text.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/rotation.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <vector>

/// \file
/// Slips of single columns, entries and terms, and of the numbers that represent rotations.

namespace duet::detail {
DUET_ABI_BEGIN

/// Hypotheses about columns, terms of sums, and stored numbers.
class slips_of_terms : protected slips_at_points {
protected:
  using slips_at_points::slips_at_points;

  /// For each column, or row, of a rectangle the index of that of the exact matrix whose entries it
  /// contains; −1 if it contains no such line.
  [[nodiscard]] std::vector<Eigen::Index> sources_of_lines(const scope& at, bool is_columns) const {
    const matrix& whole = samples_[0].exact;
    const Eigen::Index count = is_columns ? at.columns : at.rows,
                       all = is_columns ? whole.cols() : whole.rows();
    const auto line = [&](const matrix& m, Eigen::Index i) -> matrix {
      return is_columns ? m.block(at.row, i, at.rows, 1) : m.block(i, at.column, 1, at.columns);
    };
    std::vector<Eigen::Index> from;
    for (Eigen::Index k = 0; k < count; ++k) {
      const Eigen::Index begin = is_columns ? at.column : at.row, own = begin + k;
      Eigen::Index source = -1;
      // First the line itself, then one that contains it, then a column that follows the last
      // source, then in order of distance.
      std::vector<Eigen::Index> order = {own};
      const auto partner = std::find(from.begin(), from.end(), own);
      if (partner != from.end()) {
        order.push_back(begin + (partner - from.begin()));
      }
      if (is_columns && k > 0) {
        order.push_back((from.back() + 1) % all);
      }
      for (Eigen::Index n = 1; n < all; ++n) {
        order.push_back((own + n) % all);
      }
      for (std::size_t n = 0; n < order.size() && source < 0; ++n) {
        const Eigen::Index other = order[n];
        const bool is_source =
            std::all_of(samples_.begin(), samples_.end(), [&](const jacobian_sample& s) {
              const matrix exact = line(s.exact, other);
              return is_within(line(s.written, own) - exact, s.allowed + s.little_error, 1e-9,
                               exact, exact);
            });
        source = is_source ? other : -1;
      }
      from.push_back(source);
    }
    return from;
  }

  /// True if columns, or rows, of several arguments, or results, are exchanged differently.
  ///
  /// \param from  sources of the lines of a rectangle
  [[nodiscard]] bool has_two_exchanges(const scope& at, const std::vector<Eigen::Index>& from,
                                       bool is_columns) const {
    std::set<std::vector<Eigen::Index>> exchanges; // empty: with other arguments
    const Eigen::Index begin = is_columns ? at.column : at.row,
                       end = begin + Eigen::Index(from.size());
    for (const jacobian_part& p : is_columns ? problem_.arguments : problem_.results) {
      const Eigen::Index size = p.dimension == 6 ? 3 : p.dimension;
      for (Eigen::Index first = p.first; first < p.first + p.dimension; first += size) {
        std::vector<Eigen::Index> own;
        bool is_exchanged = false, has_outside = false;
        for (Eigen::Index k = std::max(first, begin); k < std::min(first + size, end); ++k) {
          const Eigen::Index source = from[std::size_t(k - begin)];
          own.push_back(source - first);
          is_exchanged = is_exchanged || source != k;
          has_outside = has_outside || source < first || source >= first + size;
        }
        if (is_exchanged) {
          exchanges.insert(has_outside ? std::vector<Eigen::Index>() : own);
        }
      }
    }
    return exchanges.size() > 1;
  }

  /// Columns that contain other columns, and rows that contain other rows.
  void try_columns() {
    for (const bool is_columns : {true, false}) {
      for (const scope& at : scopes_) {
        const std::vector<Eigen::Index> from = sources_of_lines(at, is_columns);
        const std::set<Eigen::Index> different(from.begin(), from.end());
        // Copies of columns are one slip if all come from the same distance.
        std::set<Eigen::Index> distances;
        std::string list;
        for (std::size_t k = 0; k < from.size(); ++k) {
          distances.insert(from[k] - at.column - Eigen::Index(k));
          list += (k == 0 ? "" : ", ") + std::to_string(from[k]);
        }
        distances.erase(0);
        const bool is_injective = different.size() == from.size();
        const bool is_slip = is_columns
                                 ? !distances.empty() && (is_injective || distances.size() == 1)
                                 : at.columns > 1 || (at.rows > 1 && is_injective);
        if (*different.begin() >= 0 && is_slip && !has_two_exchanges(at, from, is_columns)) {
          accept(message(from.size() == 1
                             ? (is_columns ? "wrong index: column " : "wrong index: row ")
                         : !is_columns  ? "permuted or wrong rows: "
                         : is_injective ? "permuted or shifted: columns "
                                        : "wrong index: columns ",
                         list, " of the matrix"),
                 at.name);
          return;
        }
      }
    }
    // Shifted, with zeros at the end.
    for (const int shift : {1, -1, 3, -3}) {
      attempt_change(message("shifted by ", shift, " columns"), [&](const matrix& m) {
        const Eigen::Index kept = m.cols() - std::abs(shift);
        matrix out = kept > 0 ? matrix(matrix::Zero(m.rows(), m.cols())) : matrix();
        if (kept > 0) {
          out.middleCols(std::max(shift, 0), kept) = m.middleCols(std::max(-shift, 0), kept);
        }
        return out;
      });
    }
  }

  /// A term that contains a wrong constant: the error of one block is a constant matrix.
  void try_constants() {
    for (const scope& at : scopes_) {
      if (at.argument == nullptr || at.result == nullptr) {
        continue;
      }
      const matrix first = of(samples_[0].written, at) - of(samples_[0].exact, at);
      // Where several right entries are constant as well, any others would be.
      Eigen::Index count = 0;
      bool is_whole = true;
      for (Eigen::Index i = 0; i < first.size(); ++i) {
        const bool is_wrong = std::abs(first(i)) > samples_[0].allowed;
        count += is_wrong ? 1 : 0;
        is_whole = is_whole &&
                   (!is_wrong || std::all_of(samples_.begin(), samples_.end(), [&](const auto& s) {
                     const double x = of(s.exact, at)(i), y = of(samples_[0].exact, at)(i);
                     return std::abs(x - y) <= s.allowed + 1e-9 * std::abs(x);
                   }));
      }
      if ((!is_whole || count < 2) &&
          fits_all(at, [&](const auto& s) -> matrix { return of(s.exact, at) + first; })) {
        accept("one summand: off by a constant", at.name);
        return;
      }
    }
  }

  /// Numbers that a term may contain: states and components of vectors in other axes.
  struct numbers {
    std::vector<std::string> names;
    std::vector<double> values;
  };

  /// \param with_inverses  also one divided by them
  [[nodiscard]] numbers numbers_of(const jacobian_sample& s, bool with_inverses = false) const {
    numbers n;
    n.names = {"1"};
    n.values = {1};
    const auto add = [&](const std::string& name, const Eigen::Ref<const vector>& v) {
      for (Eigen::Index i = 0; i < v.size(); ++i) {
        n.names.push_back(v.size() == 1 ? name : name + "[" + std::to_string(i) + "]");
        n.values.push_back(v[i]);
      }
    };
    for (const jacobian_part& a : parts_of_state()) {
      if (a.is_motion()) {
        const quaternion<double> q = rotation_at(a, s.state);
        add(a.name, Eigen::Vector4d(q.w(), q.x(), q.y(), q.z()));
      }
      if (a.type != kind::rotation) {
        add(a.vector_name(), s.state.segment(a.vector_first(), a.vector_size()));
      }
    }
    for (const jacobian_part& r : problem_.results) {
      if (!r.is_motion() && n.values.size() < 30) {
        add(r.name, s.truth.value.segment(r.state, r.dimension));
      }
    }
    const std::vector<motion> all = motions();
    const bool has_poses = std::any_of(all.begin(), all.end(),
                                       [](const motion& m) { return m.part->type == kind::pose; });
    for (const named_vector& v : vectors_of(s, has_poses)) {
      if (v.name[0] == '(' && n.values.size() < 48) {
        add(v.name, v.value);
      }
    }
    for (std::size_t f = 1, count = n.values.size(); f < count && with_inverses; ++f) {
      n.names.push_back("1/" + n.names[f]);
      n.values.push_back(1 / n.values[f]);
    }
    return n;
  }

  /// A term that an error may be a multiple of.
  struct term {
    std::string name;
    matrix value;
    bool is_weighted = false; ///< also with a coefficient of its own at every sample
  };

  /// Terms of a row or column of three entries, or of 3 x 3: vectors a, a x b, cross matrices of
  /// them, a b^T, (a.b) 1, rotations, and their products. Weighted are cross matrices and their
  /// squares, as in Jacobians of exp, and a b^T, as in derivatives of lengths.
  [[nodiscard]] std::vector<term> terms_of(const jacobian_sample& s, const scope& at) const {
    std::vector<term> list;
    const std::vector<named_vector>& v = vectors_of(s);
    if (at.rows * at.columns == 3) {
      const auto add = [&](const std::string& name, const Eigen::Vector3d& x) {
        list.push_back({name, at.rows == 1 ? matrix(x.transpose()) : matrix(x)});
      };
      for (std::size_t a = 0; a < v.size(); ++a) {
        add(v[a].name, v[a].value);
        for (std::size_t b = a + 1; b < v.size(); ++b) {
          add(v[a].name + " x " + v[b].name, v[a].value.cross(v[b].value));
        }
      }
      return list;
    }
    list.push_back({"the identity matrix", matrix::Identity(3, 3)});
    const auto add_cross = [&](const std::string& name, const Eigen::Vector3d& x) {
      const matrix cross = cross_matrix(x);
      list.push_back({"the cross matrix of " + name, cross, true});
      list.push_back({"the squared cross matrix of " + name, product_of(cross, cross), true});
    };
    for (std::size_t a = 0; a < v.size(); ++a) {
      add_cross(v[a].name, v[a].value);
      for (std::size_t b = 0; b < v.size(); ++b) {
        list.push_back({v[a].name + " " + v[b].name + "^T",
                        product_of(v[a].value, v[b].value.transpose()), true});
        if (b >= a) {
          list.push_back({"(" + v[a].name + " . " + v[b].name + ") 1",
                          v[a].value.dot(v[b].value) * matrix::Identity(3, 3)});
        }
      }
    }
    for (const motion& m : motions()) {
      const Eigen::Matrix3d r = rotation_of(s, m);
      if (m.part->type == kind::rotation) {
        add_cross("log " + m.name, rotation_vector(rotation(pose_of(s, m))));
      }
      list.push_back({"the rotation matrix of " + m.name, r});
      for (const named_vector& x : v) {
        list.push_back({"the rotation matrix of " + m.name + " times the cross matrix of " + x.name,
                        product_of(r, cross_matrix(x.value))});
      }
    }
    return list;
  }

  /// Errors that are a multiple of one term and one number: a constant one; or one that differs
  /// between samples, which nine entries confirm; or a term with a constant vector.
  void try_summands() {
    const std::vector<const jacobian_sample*> used = some_wrong_samples();
    for (const scope& at : scopes_) {
      const bool is_square = at.rows == 3 && at.columns == 3;
      if (used.size() < 4 || (at.rows * at.columns != 3 && !is_square)) {
        continue;
      }
      std::vector<std::vector<term>> terms(used.size()); // of the first samples, until one refutes
      std::vector<numbers> factors;
      std::vector<matrix> errors;
      bool is_of_all = true; // a multiple of the whole, and no term of it
      for (const jacobian_sample* s : used) {
        factors.push_back(numbers_of(*s, !is_square));
        errors.push_back(error_in(*s, at));
        const matrix all = effect_of(*s, at, of(s->exact, at));
        is_of_all =
            is_of_all && largest_entry(errors.back() - coefficient(errors.back(), all) * all) <=
                             1e-6 * largest_entry(errors.back());
      }
      // Weighted terms by a factor of NAN.
      const auto changed = [&](const jacobian_sample& s, std::size_t t, std::size_t f,
                               double factor) -> matrix {
        matrix value = terms_of(s, at)[t].value * numbers_of(s, !is_square).values[f];
        value *=
            std::isnan(factor) ? coefficient(error_in(s, at), effect_of(s, at, value)) : factor;
        return of(s.exact, at) + value;
      };
      terms[0] = terms_of(*used[0], at);
      const auto allowed_of = [&](std::size_t n) {
        return 4 * used[n]->allowed + used[n]->little_error + 1e-9 * largest_entry(errors[n]);
      };
      const auto is_found = [&](std::size_t t, std::size_t f, bool is_weighted) {
        double factor = NAN;
        bool is_lost = is_weighted; // the right matrix, in the round-off of the term
        for (std::size_t n = 0; n < used.size(); ++n) {
          if (terms[n].empty()) {
            terms[n] = terms_of(*used[n], at);
          }
          const matrix value = effect_of(*used[n], at, terms[n][t].value * factors[n].values[f]);
          factor = n == 0 || is_weighted ? coefficient(errors[n], value) : factor;
          is_lost = is_lost && std::abs(factor) * largest_entry(terms[n][t].value) >
                                   most_condition * largest_entry(used[n]->exact);
          if (!(largest_entry(errors[n] - factor * value) <= allowed_of(n))) {
            return false;
          }
        }
        const auto proposed = [&](const jacobian_sample& s) {
          return changed(s, t, f, is_weighted ? NAN : factor);
        };
        return !is_lost && factor != 0 && fits_all(at, proposed, 1e-8);
      };
      for (const bool is_weighted : {false, true}) {
        for (std::size_t t = 0; t < terms[0].size(); ++t) {
          // Whatever the number, the error of one sample must be a multiple of the term.
          const matrix value = effect_of(*used[0], at, terms[0][t].value);
          const double left = largest_entry(errors[0] - coefficient(errors[0], value) * value);
          if (!(left <= allowed_of(0))) {
            continue;
          }
          const std::size_t count = is_weighted ? 1 : factors[0].values.size();
          for (std::size_t f = 0; f < count; ++f) {
            if ((!is_weighted || (terms[0][t].is_weighted && !is_of_all)) &&
                is_found(t, f, is_weighted)) {
              accept(message("sign of one summand, or one missing or of wrong ",
                             is_weighted ? "coefficient" : "factor", ": a multiple of ",
                             f > 0 ? factors[0].names[f] + " " : "", terms[0][t].name),
                     at.name);
              return;
            }
          }
        }
        if (!is_weighted && try_terms_with_constants(at)) {
          return;
        }
      }
    }
  }

  /// Terms that are linear in a constant vector, as one that the function has captured.
  bool try_terms_with_constants(const scope& at) {
    using constant = Eigen::Vector3d;
    const auto is_found = [&](const std::string& text, const auto& value) {
      return try_constant_vector(
          message("sign of one summand, or one missing or of wrong factor: ", text, ", c ="), at,
          [&](const jacobian_sample& s, const constant& c) -> matrix {
            const matrix m = value(s, c);
            return at.rows == 1 ? matrix(m.transpose()) : m;
          });
    };
    const bool is_square = at.rows * at.columns == 9;
    for (const motion& m : motions(true)) {
      for (const bool is_inverse : {false, true}) {
        if (is_found(message(m.name, is_inverse ? "^-1" : "",
                             is_square ? " times the cross matrix of c" : " c"),
                     [&](const jacobian_sample& s, const constant& c) -> matrix {
                       const matrix r = rotation_of(s, m);
                       const matrix of_constant = is_square ? matrix(cross_matrix(c)) : matrix(c);
                       return is_inverse ? product_of(r.transpose(), of_constant)
                                         : product_of(r, of_constant);
                     })) {
          return true;
        }
      }
    }
    struct form {
      const char *before, *after;
      matrix (*value)(const Eigen::Vector3d& x, const constant& c);
      bool is_square = true;
    };
    static constexpr form forms[] = {
        {"", " x c", [](const auto& x, const auto& c) -> matrix { return x.cross(c); }, false},
        {"", " c^T",
         [](const auto& x, const auto& c) -> matrix { return product_of(x, c.transpose()); }},
        {"c ", "^T",
         [](const auto& x, const auto& c) -> matrix { return product_of(c, x.transpose()); }},
        {"(", " . c) 1",
         [](const auto& x, const auto& c) -> matrix { return x.dot(c) * matrix::Identity(3, 3); }},
        {"the cross matrix of ", " x c",
         [](const auto& x, const auto& c) -> matrix { return cross_matrix(x.cross(c)); }}};
    for (std::size_t n = 0; n < vectors_of(samples_[0]).size(); ++n) {
      for (const form& f : forms) {
        if (f.is_square == is_square &&
            is_found(message(f.before, vectors_of(samples_[0])[n].name, f.after),
                     [&](const jacobian_sample& s, const constant& c) {
                       return f.value(vectors_of(s)[n].value, c);
                     })) {
          return true;
        }
      }
    }
    return false;
  }

  /// Another term instead of the right one. Few factors, and neither the identity matrix nor a b^T,
  /// as these explain two slips as well.
  void try_other_terms() {
    const std::vector<const jacobian_sample*> used = some_wrong_samples();
    for (const scope& at : scopes_) {
      const bool is_square = at.rows == 3 && at.columns == 3;
      if (used.size() < 4 || (at.rows * at.columns != 3 && !is_square)) {
        continue;
      }
      const std::vector<term> terms = terms_of(*used[0], at);
      for (std::size_t t = 0; t < terms.size(); ++t) {
        for (const double factor : {1., -1., 2., -2., .5, -.5}) {
          const bool is_specific =
              !terms[t].name.ends_with("^T") && terms[t].name != "the identity matrix";
          if (is_specific && fits(*used[0], at, factor * terms[t].value) &&
              fits_all(at, [&](const jacobian_sample& s) -> matrix {
                return factor * terms_of(s, at)[t].value;
              })) {
            accept(message("another term instead: ", to_text(float(factor)), " ", terms[t].name),
                   at.name);
            return;
          }
        }
      }
    }
  }

  /// A wrong weight: a block times a function of the arguments that are numbers.
  void try_weights() {
    std::vector<const jacobian_part*> variables;
    std::string names;
    for (const jacobian_part& a : inputs_) {
      if (a.type == kind::number) {
        names += (variables.empty() ? "" : ", ") + a.name;
        variables.push_back(&a);
      }
    }
    for (const scope& at : scopes_) {
      if (at.argument == nullptr || at.result == nullptr || at.rows * at.columns < 9) {
        continue;
      }
      std::map<std::vector<double>, double> factors;
      const bool is_function =
          std::all_of(samples_.begin(), samples_.end(), [&](const jacobian_sample& s) {
            std::vector<double> values;
            for (const jacobian_part* a : variables) {
              values.push_back(s.state[a->state]);
            }
            const matrix exact = of(s.exact, at);
            const double factor = coefficient(of(s.written, at), exact);
            return largest_entry(exact) == 0 ||
                   fits(s, at, factors.emplace(values, factor).first->second * exact, 1e-8);
          });
      if (is_function && factors.size() < samples_.size()) { // equal ones confirm it
        accept("wrong weight: scaled by a function of " + names, at.name);
        return;
      }
    }
  }

  /// Columns for stored numbers that follow another convention.
  void try_charts() {
    for (const jacobian_part& a : problem_.arguments) {
      if (!a.is_motion() || samples_[0].raw.cols() == samples_[0].exact.cols()) {
        continue;
      }
      const Eigen::Index q = a.type == kind::pose ? 3 : 0; // index of the quaternion
      const bool is_w_first = problem_.order == quaternion_order::wxyz;
      using reading = std::function<matrix(const jacobian_sample&, const matrix&)>;
      const auto try_reading = [&](const std::string& name, const reading& read) {
        if (std::all_of(samples_.begin(), samples_.end(), [&](const jacobian_sample& s) {
              matrix written = s.written;
              written.middleCols(a.first, a.dimension) =
                  read(s, s.raw.middleCols(a.state, a.state_size()));
              return is_within(written - s.exact, s.allowed + s.little_error, 1e-9, s.exact,
                               s.exact);
            })) {
          accept(name, message("all of d / d ", a.name));
        }
      };
      const auto charted = [&](const jacobian_sample& s, const matrix& m, quaternion_order order,
                               perturbation side) -> matrix {
        return product_of(m, chart_derivative(a, s.state, side, order));
      };
      try_reading(is_w_first ? "w last for w first" : "w first for w last",
                  [&](const jacobian_sample& s, const matrix& m) {
                    return charted(s, m,
                                   is_w_first ? quaternion_order::xyzw : quaternion_order::wxyz,
                                   problem_.side);
                  });
      try_reading("conjugate rotation", [&](const jacobian_sample& s, matrix m) {
        m.middleCols(q + (is_w_first ? 1 : 0), 3) *= -1;
        return charted(s, m, problem_.order, problem_.side);
      });
      for (const bool is_first : {true, false}) {
        for (const double factor : {1., 2., .5}) {
          for (const bool is_alone : {false, true}) { // the translation's columns are right
            try_reading("missing chart factor L(q)/2: derivatives by tangent coordinates in "
                        "columns of the quaternion",
                        [&](const jacobian_sample& s, matrix m) -> matrix {
                          const matrix by_rotation =
                              factor * m.middleCols(q + (is_first ? 0 : 1), 3);
                          m.middleCols(q, 4).setZero();
                          matrix out = is_alone || q == 0
                                           ? charted(s, m, problem_.order, problem_.side)
                                           : m.leftCols(6);
                          out.rightCols(3) += by_rotation;
                          return out;
                        });
          }
        }
      }
      if (q > 0) {
        try_reading("[q; t] for [t; q]", [&](const jacobian_sample& s, const matrix& m) -> matrix {
          matrix moved(m.rows(), 7);
          moved << m.rightCols(3), m.leftCols(4);
          return charted(s, moved, problem_.order, problem_.side);
        });
      }
    }
  }

  /// A single entry: another entry, or one wrong term that is a product of few numbers.
  void try_entry() {
    const Eigen::Index i = first_row_, k = first_;
    const scope& at = scopes_.front();
    for (Eigen::Index r = 0; r < samples_[0].exact.rows(); ++r) {
      for (Eigen::Index c = 0; c < samples_[0].exact.cols(); ++c) {
        for (const double sign : {1., -1.}) {
          if ((r != i || c != k) && fits_all(at, [&](const jacobian_sample& s) -> matrix {
                return matrix::Constant(1, 1, sign * s.exact(r, c));
              })) {
            accept(message("wrong index: ", sign < 0 ? "minus " : "", "entry (", r, ", ", c,
                           ") of the matrix"),
                   at.name);
          }
        }
      }
    }
    // Written entries that are c a/b or c a/b^2 times the right ones; errors that are c m, c m/d or
    // c m (a - b), where m is a product of at most three numbers. Some wrong samples refute most.
    std::vector<const jacobian_sample*> used = some_wrong_samples();
    const std::size_t some = used.size();
    std::transform(samples_.begin(), samples_.end(), std::back_inserter(used),
                   [](const jacobian_sample& s) { return &s; });
    std::vector<std::vector<double>> values;
    std::vector<double> errors, tolerances;
    numbers names;
    for (const jacobian_sample* s : used) {
      names = numbers_of(*s);
      values.push_back(names.values);
      values.back().push_back(s->exact(i, k));
      errors.push_back(s->written(i, k) - s->exact(i, k));
      tolerances.push_back(s->allowed + s->little_error +
                           1e-9 * (std::abs(s->exact(i, k)) + std::abs(errors.back())));
    }
    if (some < 4) {
      return;
    }
    const std::size_t count = names.names.size();
    double constant = 1;
    // Of the errors, or of the entries as written.
    const auto is_constant = [&](const auto& ratio_of, bool is_entry = false) {
      const auto number = [&](std::size_t n) {
        return is_entry ? used[n]->written(i, k) : errors[n];
      };
      const double first = ratio_of(values[0]);
      const double factor = number(0) / first;
      if (!std::isfinite(factor)) {
        return false;
      }
      constant = factor;
      for (std::size_t n = 1; n < values.size(); ++n) {
        const double ratio = ratio_of(values[n]); // elsewhere 0/0 refutes nothing
        if (!(std::abs(number(n) - factor * ratio) <= 4 * tolerances[n]) &&
            (n < some || std::isfinite(ratio))) {
          return false;
        }
      }
      return true;
    };
    for (std::size_t a = 0; a < count; ++a) {
      for (std::size_t b = 0; b < count; ++b) {
        for (const bool is_square : {false, true}) {
          if (a != b && (a > 0 || b > 0) &&
              is_constant(
                  [&](const auto& v) {
                    const double factor = v[a] / (is_square ? v[b] * v[b] : v[b]);
                    return v.back() * factor;
                  },
                  true)) {
            accept(message("wrong factor: times ",
                           std::abs(constant - 1) < 1e-9 ? "" : to_text(float(constant)) + " ",
                           names.names[a],
                           b > 0 ? message("/", names.names[b], is_square ? "^2" : "") : ""),
                   at.name);
            return;
          }
        }
      }
    }
    for (std::size_t a = 0; a < count; ++a) {
      for (std::size_t b = a; b < count; ++b) {
        const auto pair = [&](const std::vector<double>& v) { return v[a] * v[b]; };
        for (std::size_t c = b; c < count; ++c) {
          if (is_constant([&](const auto& v) { return pair(v) * v[c]; })) {
            accept_term(names, {a, b, c}, {}, at.name);
            return;
          }
        }
        for (std::size_t c = 1; c < count; ++c) {
          if (is_constant([&](const auto& v) { return pair(v) / v[c]; }) ||
              is_constant([&](const auto& v) { return pair(v) / (v[c] * v[c]); })) {
            accept_term(names, {a, b}, {c}, at.name);
            return;
          }
        }
      }
    }
    for (std::size_t c = 1; c < count; ++c) {
      for (std::size_t d = c + 1; d < count; ++d) {
        for (std::size_t a = 0; a < count; ++a) {
          for (std::size_t b = a; b < count; ++b) {
            for (const double sign : {-1., 1.}) {
              if (is_constant([&](const auto& v) { return v[a] * v[b] * (v[c] + sign * v[d]); })) {
                accept(sign < 0 ? message("wrong index in one summand: ", names.names[d], " for ",
                                          names.names[c], " or the reverse")
                                : message("sign of one summand and wrong index: ", names.names[c],
                                          " + ", names.names[d]),
                       at.name);
                return;
              }
            }
          }
          for (std::size_t b = 1; b < count; ++b) {
            if (is_constant([&](const auto& v) { return v[a] * (v[c] - v[d]) / v[b]; }) ||
                is_constant([&](const auto& v) { return v[a] * (v[c] - v[d]) / (v[b] * v[b]); })) {
              accept(message("wrong index in one summand: ", names.names[d], " for ",
                             names.names[c], " or the reverse"),
                     at.name);
              return;
            }
          }
        }
      }
    }
  }

  void accept_term(const numbers& n, const std::vector<std::size_t>& above,
                   const std::vector<std::size_t>& below, const std::string& block) {
    std::string text;
    for (const std::size_t f : above) {
      text += f == 0 ? "" : (text.empty() ? "" : " ") + n.names[f];
    }
    text = text.empty() ? "1" : text;
    for (const std::size_t f : below) {
      text += "/" + n.names[f];
    }
    accept(message("sign of one summand, or one missing or of wrong factor: a multiple of ", text),
           block);
  }
};

DUET_ABI_END
} // namespace duet::detail
