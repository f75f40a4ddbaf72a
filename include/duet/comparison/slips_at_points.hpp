// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/comparison/jacobian_problem.hpp>
#include <duet/comparison/slips_of_blocks.hpp>
#include <duet/core/constants.hpp>
#include <duet/core/text/number_text.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/rotation.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

/// \file
/// Slips of evaluation: at other points, of one summand, or right in some region only.

namespace duet::detail {
DUET_ABI_BEGIN

/// Hypotheses that evaluate the derivative at other points.
class slips_at_points : protected slips_of_blocks {
protected:
  using slips_of_blocks::slips_of_blocks;

  /// Changes of the arguments at which the handwritten Jacobian may have been evaluated.
  struct other_point {
    std::string name;
    std::function<vector(const jacobian_sample&)> state;
    std::function<double(const jacobian_sample&)> factor{};
  };

  static void set_rotation(vector& state, const jacobian_part& part, const quaternion<double>& q) {
    store_quaternion(q, state.data() + part.state, quaternion_order::wxyz);
  }

  template <class Add>
  static void add_other_axes(const Add& add, const jacobian_part& a, const jacobian_part& b) {
    for (const bool is_inverse : {false, true}) {
      add(message("offset in other axes: ", a.vector_name(), " in those of ", b.name,
                  is_inverse ? "^-1" : ""),
          [&a, &b, is_inverse](vector& x) {
            const Eigen::Matrix3d r = rotation_matrix(rotation_at(b, x));
            const Eigen::Vector3d v = x.segment<3>(a.vector_state());
            x.segment<3>(a.vector_state()) = product_of(is_inverse ? r.transpose() : r, v);
          });
    }
  }

  [[nodiscard]] std::vector<other_point> other_points() const {
    std::vector<other_point> list;
    const auto add = [&](std::string name, auto change) {
      list.push_back({std::move(name), [change = std::move(change)](const jacobian_sample& s) {
                        vector state = s.state;
                        change(state);
                        return state;
                      }});
    };
    for (const jacobian_part& a : inputs_) {
      const Eigen::Index size = a.state_size();
      if (a.is_motion()) {
        const auto add_rotation = [&](const std::string& name, auto change) {
          add(name, [&a, change](vector& x) { set_rotation(x, a, change(rotation_at(a, x))); });
        };
        add_rotation(message("evaluated with ", a.name, " = identity (right only there)"),
                     [](const auto&) { return quaternion<double>(1); });
        add_rotation(message("conjugate rotation of ", a.name),
                     [](const auto& q) { return conj(q); });
        add_rotation(message("half the angle of ", a.name), [](const auto& q) {
          return from_rotation_vector(Eigen::Vector3d(rotation_vector(q) / 2));
        });
        add_rotation(message("twice the angle of ", a.name),
                     [](const auto& q) { return quaternion<double>(q * q); });
        add_rotation(message("w last for w first in ", a.name),
                     [](const auto& q) { return quaternion<double>(q.z(), q.w(), q.x(), q.y()); });
        add_rotation(message("w first for w last in ", a.name),
                     [](const auto& q) { return quaternion<double>(q.x(), q.y(), q.z(), q.w()); });
      }
      if (a.type == kind::pose) {
        add(message("evaluated with ", a.name, " = identity (right only there)"), [&a](vector& x) {
          set_rotation(x, a, quaternion<double>(1));
          x.segment<3>(a.state + 4).setZero();
        });
        add(message("inverse of ", a.name), [&a](vector& x) {
          const quaternion<double> q = rotation_at(a, x);
          x.segment<3>(a.state + 4) =
              product_of(-rotation_matrix(q).transpose(), x.segment<3>(a.state + 4));
          set_rotation(x, a, conj(q));
        });
      }
      if (a.type == kind::vector && size == 4) {
        add(message("conjugate rotation: sign of ", a.name, "[1..3]"),
            [&a](vector& x) { x.segment<3>(a.state + 1) *= -1; });
      }
      if (a.type == kind::vector && size == 6) {
        add(message("[omega; v] for [v; omega] in ", a.name),
            [&a](vector& x) { x.segment<3>(a.state).swap(x.segment<3>(a.state + 3)); });
        for (const Eigen::Index to : {0, 3}) {
          add(message("another vector: ", a.name,
                      to == 0 ? "[3..5] for [0..2]" : "[0..2] for [3..5]"),
              [&a, to](vector& x) { x.segment<3>(a.state + to) = x.segment<3>(a.state + 3 - to); });
        }
      }
      if (a.type != kind::rotation) {
        const Eigen::Index first = a.vector_first(), count = a.vector_size();
        const std::string name = a.vector_name();
        for (const auto& [text, factor] :
             {std::pair("evaluated with 0 for ", 0.), std::pair("sign of ", -1.),
              std::pair("half of ", .5), std::pair("twice ", 2.),
              std::pair("degrees for radians of ", 180 / constant::pi<double>()),
              std::pair("radians for degrees of ", constant::pi<double>() / 180)}) {
          add(text + name,
              [first, count, factor = factor](vector& x) { x.segment(first, count) *= factor; });
        }
        for (Eigen::Index i = 0; i < count && count > 1; ++i) {
          for (Eigen::Index k = 0; k < count; ++k) {
            if (k > i) {
              add(message("indices ", i, " and ", k, " exchanged in ", name),
                  [first, i, k](vector& x) { std::swap(x[first + i], x[first + k]); });
            }
            if (k != i) {
              add(message("wrong index: ", name, "[", k, "] for ", name, "[", i, "]"),
                  [first, i, k](vector& x) { x[first + i] = x[first + k]; });
            }
          }
          add(message("sign of ", name, "[", i, "]"),
              [first, i](vector& x) { x[first + i] = -x[first + i]; });
        }
        if (count == 1) {
          add(message("1 - ", a.name, " for ", a.name),
              [first](vector& x) { x[first] = 1 - x[first]; });
          for (const double scale : {.5, 2.}) {
            add(message("evaluated with ", scale < 1 ? "half of " : "twice ", a.name,
                        ", and the factor right"),
                [first, scale](vector& x) { x[first] *= scale; });
            list.back().factor = [scale](const jacobian_sample&) { return 1 / scale; };
          }
          for (const int power : {0, 1, -1}) {
            add(message("evaluated with 1 for ", a.name,
                        power == 0   ? ""
                        : power == 1 ? ", then multiplied by it"
                                     : ", then divided by it"),
                [first](vector& x) { x[first] = 1; });
            list.back().factor = [first, power](const jacobian_sample& s) {
              return std::pow(s.state[first], power);
            };
          }
        }
      }
      const auto add_other_state = [&](const jacobian_part& b) {
        if (a.type == b.type && a.dimension == b.dimension) {
          add(message("another state: ", b.name, " for ", a.name),
              [&a, &b, size](vector& x) { x.segment(a.state, size) = x.segment(b.state, size); });
        }
      };
      for (const jacobian_part& b : inputs_) {
        if (&a == &b) {
          continue;
        }
        add_other_state(b);
        if (a.type == b.type && a.dimension == b.dimension && &a < &b) {
          add(message(a.name, " and ", b.name, " exchanged"), [&a, &b, size](vector& x) {
            x.segment(a.state, size).swap(x.segment(b.state, size));
          });
        }
        if (a.is_motion() && b.is_motion()) {
          for (const bool is_inverse : {false, true}) {
            for (const bool is_left : {false, true}) {
              const std::string other = b.name + (is_inverse ? "^-1" : "");
              add(message("another point: ", is_left ? other : a.name, " times ",
                          is_left ? a.name : other, " for ", a.name),
                  [&a, &b, is_inverse, is_left](vector& x) {
                    const quaternion<double> q = rotation_at(a, x), p = rotation_at(b, x),
                                             factor = is_inverse ? conj(p) : p;
                    set_rotation(x, a, is_left ? factor * q : q * factor);
                  });
            }
          }
        }
      }
      for (const jacobian_part& b : problem_.context) {
        add_other_state(b);
        if (b.vector_state() >= 0 && a.is_motion()) {
          add_other_axes(add, b, a);
        }
      }
      // Vectors and translations in the axes of another rotation, or from another point.
      if (a.vector_state() >= 0) {
        const std::string name = a.vector_name();
        for (const jacobian_part& b : inputs_) {
          if (b.is_motion()) {
            add_other_axes(add, a, b);
          }
          if (&b != &a && b.vector_state() >= 0) {
            for (const double sign : {1., -1.}) {
              add(message("moment arm about another point: ", name, sign > 0 ? " plus " : " less ",
                          b.name),
                  [&a, &b, sign](vector& x) {
                    x.segment<3>(a.vector_state()) += sign * x.segment<3>(b.vector_state());
                  });
            }
          }
        }
      }
    }
    return list;
  }

  /// The derivative at another point, in the rectangles in which that may be what is written.
  void try_other_points() {
    for (const other_point& point : other_points()) {
      std::vector<const scope*> alive;
      for (const scope& at : scopes_) {
        alive.push_back(&at);
      }
      for (const jacobian_sample& s : samples_) {
        const matrix there = (point.factor ? point.factor(s) : 1) * derivative_at(point.state(s));
        std::erase_if(alive, [&](const scope* at) { return !fits(s, *at, of(there, *at)); });
        if (alive.empty()) {
          break;
        }
      }
      if (!alive.empty()) {
        accept(point.name, alive.front()->name);
      }
    }
  }

  /// Parts of a sum: what does not depend on an argument, what is odd and what is even in it; for
  /// single components of vectors what is odd and what is even.
  void try_parts_of_sums() {
    for (const jacobian_part& a : inputs_) {
      if (a.is_motion()) {
        try_parts_by(a.name, [&](vector x, double factor) {
          set_rotation(x, a, factor == 0 ? quaternion<double>(1) : conj(rotation_at(a, x)));
          return x;
        });
      }
      if (a.type == kind::rotation) {
        continue;
      }
      const Eigen::Index first = a.vector_first(), count = a.vector_size();
      const std::string name = a.vector_name();
      const auto try_components = [&](const std::string& of, Eigen::Index from, Eigen::Index size) {
        try_parts_by(of, [&](vector x, double factor) {
          x.segment(from, size) *= factor;
          return x;
        });
      };
      try_components(name, first, count);
      for (Eigen::Index k = 0; k < count && count > 1; ++k) {
        try_components(message(name, "[", k, "]"), first + k, 1);
      }
    }
  }

  /// \param changed  (state, factor): the state with an argument times 0 or -1
  template <class Changed>
  void try_parts_by(const std::string& argument, const Changed& changed) {
    static constexpr std::pair<const char*, double> changes[] = {{"sign of", -2},
                                                                 {"missing:", -1},
                                                                 {"twice", 1},
                                                                 {"half of", -.5},
                                                                 {"wrong coefficient of", NAN}};
    const std::vector<const jacobian_sample*> some = some_wrong_samples();
    for (int part = 0; part < 3; ++part) {
      std::vector<bool> is_all(scopes_.size(), true); // the part is a multiple of the whole
      std::vector<std::pair<const std::pair<const char*, double>*, const scope*>> alive;
      for (const auto& change : changes) {
        for (const scope& at : scopes_) {
          // A coefficient of its own for every sample needs entries and samples to confirm it.
          if (!std::isnan(change.second) ||
              (at.rows * at.columns >= 9 && some.size() > 3 && samples_[0].outer.size() == 0)) {
            alive.emplace_back(&change, &at);
          }
        }
      }
      const auto at_factor = [&](const jacobian_sample& s, double factor) -> matrix {
        return derivative_at(changed(s.state, factor));
      };
      for (const jacobian_sample& s : samples_) {
        const matrix nothing = at_factor(s, 0), opposite = at_factor(s, -1);
        const matrix summand = part == 0   ? nothing
                               : part == 1 ? matrix((s.exact - opposite) / 2)
                                           : matrix((s.exact + opposite) / 2 - nothing);
        std::erase_if(alive, [&](const auto& pair) {
          const auto& [change, at] = pair;
          double factor = change->second;
          const matrix term = of(summand, *at);
          if (std::isnan(factor)) {
            factor = coefficient(of(s.written, *at) - of(s.exact, *at), term);
            factor = std::abs(factor) <= most_condition ? factor : 0; // round-off of zero
            const matrix all = of(s.exact, *at);
            if (s.is_wrong &&
                largest_entry(term - coefficient(term, all) * all) > 1e-6 * largest_entry(term)) {
              is_all[std::size_t(at - scopes_.data())] = false;
            }
          }
          // The part of an even function is what is left of a difference.
          const double round_off = 4e-16 * std::abs(factor) * largest_entry(s.exact) /
                                   std::max(largest_entry(s.written), largest_entry(s.exact));
          return !fits(s, *at, of(s.exact, *at) + factor * term, 1e-9 + round_off);
        });
        if (alive.empty()) {
          break;
        }
      }
      const bool is_multiple = std::any_of(alive.begin(), alive.end(), [](const auto& pair) {
        return !std::isnan(pair.first->second);
      });
      for (const auto& [change, at] : alive) {
        if (std::isnan(change->second) &&
            (is_multiple || is_all[std::size_t(at - scopes_.data())])) {
          continue;
        }
        accept(message(change->first, " one summand: the part ",
                       part == 0   ? "that does not depend on "
                       : part == 1 ? "that is odd in "
                                   : "that is even in ",
                       argument),
               at->name);
      }
    }
  }

  /// Properties of an input, by which right and wrong samples may be distinguished.
  struct feature {
    std::string name; ///< as "angle of q", "length of p", "sign of t" or "commuting"
    double value;
  };

  [[nodiscard]] std::vector<feature> features_of(const jacobian_sample& s) const {
    std::vector<feature> list;
    std::vector<Eigen::Vector3d> axes;
    const auto add = [&](const std::vector<jacobian_part>& parts, const vector& state) {
      for (const jacobian_part& p : parts) {
        if (p.is_motion()) {
          const quaternion<double> q = rotation_at(p, state);
          const Eigen::Vector3d v(q.x(), q.y(), q.z());
          list.push_back({"angle of " + p.name, 2 * std::atan2(v.norm(), std::abs(q.w()))});
          axes.push_back(v);
        }
        if (p.vector_state() >= 0) {
          const Eigen::Vector3d v = state.segment<3>(p.vector_state());
          list.push_back({"length of " + p.name, v.norm()});
          axes.push_back(v);
        } else if (p.type == kind::vector && p.dimension == 6) {
          list.push_back({"length of " + p.name + "[3..5]", state.segment<3>(p.state + 3).norm()});
        } else if (p.type == kind::number) {
          list.push_back({"size of " + p.name, std::abs(state[p.state])});
          list.push_back({"sign of " + p.name, state[p.state]});
        }
      }
    };
    add(inputs_, s.state);
    add(problem_.results, s.truth.value);
    for (const motion& m : motions()) {
      if (m.other != nullptr) {
        const quaternion<double> q =
            conj(rotation_at(*m.other, s.state)) * rotation_at(*m.part, s.state);
        list.push_back({"angle of " + m.name,
                        2 * std::atan2(std::hypot(q.x(), q.y(), q.z()), std::abs(q.w()))});
      }
    }
    double apart = 0;
    for (std::size_t i = 0; i < axes.size(); ++i) {
      for (std::size_t k = i + 1; k < axes.size(); ++k) {
        apart = std::max(apart, axes[i].cross(axes[k]).norm());
      }
    }
    if (axes.size() > 1) {
      list.push_back({"commuting", apart});
    }
    return list;
  }

  /// True if what is written is right wherever it is wrong, with the opposite quaternion.
  [[nodiscard]] bool is_of_one_sheet(const jacobian_part& a) const {
    return std::all_of(samples_.begin(), samples_.end(), [&](const jacobian_sample& s) {
      if (!s.is_wrong) {
        return true;
      }
      vector x = s.state;
      x.segment<4>(a.state) *= -1;
      const matrix there = to_tangent(problem_, x, problem_.written(x));
      return largest_entry(there - derivative_at(x)) <= 10 * s.allowed;
    });
  }

  /// Names that describe two slips as well, if these vanish there: listed beside others only.
  std::vector<jacobian_slip> weak_;

  /// Regions of wrong inputs: a branch for small angles or near a half turn, one sheet of the
  /// double cover, everywhere but at the identity or for commuting rotations.
  void try_regions() {
    const scope& block = scopes_.front();
    // Two slips may vanish at the same inputs, so that one block must contain all that is wrong.
    if (block.argument == nullptr || block.result == nullptr) {
      return;
    }
    std::vector<std::vector<feature>> features;
    std::vector<bool> counts; // no slip shows where the block is zero
    for (const jacobian_sample& s : samples_) {
      features.push_back(features_of(s));
      counts.push_back(s.is_wrong ||
                       largest_entry(of(s.exact, block)) > 1e-3 * largest_entry(samples_[0].exact));
    }
    const double pi = constant::pi<double>();
    for (const jacobian_part& a : inputs_) {
      if (a.is_motion() && is_of_one_sheet(a)) {
        accept(message("right on one sheet of the double cover only: of ", a.name), block.name);
      }
    }
    for (std::size_t f = 0; f < features[0].size(); ++f) {
      double least[2] = {INFINITY, INFINITY}, most[2] = {-INFINITY, -INFINITY};
      for (std::size_t n = 0; n < samples_.size(); ++n) {
        if (!counts[n]) {
          continue;
        }
        const std::size_t w = samples_[n].is_wrong ? 1 : 0;
        least[w] = std::min(least[w], features[n][f].value);
        most[w] = std::max(most[w], features[n][f].value);
      }
      double above = INFINITY, below = -INFINITY; // right ones beyond the wrong ones
      bool has_between = false;
      for (std::size_t n = 0; n < samples_.size(); ++n) {
        const double x = features[n][f].value;
        if (!samples_[n].is_wrong && counts[n]) {
          above = x > most[1] ? std::min(above, x) : above;
          below = x < least[1] ? std::max(below, x) : below;
          // Errors may vanish with the value itself.
          has_between = has_between || (x <= most[1] && x >= std::max(least[1], .1 * most[1]));
        }
      }
      const std::string& about = features[0][f].name;
      const bool is_commuting = about == "commuting", has_branches = !is_commuting && !has_between;
      const bool is_only_at_zero = most[0] < least[1] && most[0] < 1e-3;
      if (most[0] == -INFINITY) {
        continue;
      }
      if (about.starts_with("sign of ")) {
        if ((most[1] < 0 && least[0] >= 0) || (least[1] > 0 && most[0] <= 0)) {
          accept(message("right for one sign only of ", about, most[1] < 0 ? " < 0" : " > 0",
                         " is wrong"),
                 block.name);
        }
      } else if (has_branches && most[1] < .5 && above < INFINITY) {
        accept(message("only in the branch of small values: ", about, " up to ",
                       to_text(float(most[1])), " wrong, from ", to_text(float(above)), " right"),
               block.name);
      } else if (has_branches && least[1] > pi - .5 && most[1] < pi + 1e-6 && below > -INFINITY) {
        accept(message("only in the branch beside a half turn: ", about, " from ",
                       to_text(float(least[1])), " wrong, up to ", to_text(float(below)), " right"),
               block.name);
      } else if (is_only_at_zero && about.starts_with("angle")) {
        weak_.push_back(
            {message("right only at the identity: ", about, " up to ", to_text(float(most[0]))),
             block.name});
      } else if (is_only_at_zero && is_commuting) {
        weak_.push_back(
            {"right only for commuting rotations: where all axes are parallel", block.name});
      }
    }
  }
};

DUET_ABI_END
} // namespace duet::detail
