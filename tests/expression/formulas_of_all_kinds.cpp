// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// Random formulas of scalars, vectors, matrices, rotations, dual vectors, poses, conditions and
// special functions. Value, first and second derivative along a direction, forward and in reverse,
// are compared with 50 digits; the text is read again. The environment variables
// DUET_RANDOM_FORMULAS and DUET_RANDOM_FORMULAS_SEED are the number of formulas and the first of
// them; DUET_RANDOM_FORMULAS_C is a folder for the first 1000 in C, each a file with a check.

#include "support/random.hpp"
#include "support/test.hpp"

#include <duet/dual/dual.hpp>
#include <duet/dual/taylor.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/dual_quaternion/screw.hpp>
#include <duet/expression/code/c.hpp>
#include <duet/expression/graph/evaluate.hpp>
#include <duet/expression/graph/formula_graph.hpp>
#include <duet/expression/graph/formula_text.hpp>
#include <duet/expression/graph/read_formula.hpp>
#include <duet/expression/graph/recorded.hpp>
#include <duet/expression/graph/reverse.hpp>
#include <duet/expression/graph/trace.hpp>
#include <duet/interop/multiprecision.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/norm.hpp>
#include <duet/quaternion/rotation.hpp>

#include <Eigen/Core>

#include <cstdlib>
#include <fstream>
#include <iostream>
#include <string_view>

namespace test_expression_formulas_of_all_kinds {
namespace {

using namespace duet::expression;
using duet::recorded;
using wide = duet::real_50;
using Q = duet::quaternion<recorded>;
using V = duet::vector3<recorded>;
using M = duet::matrix3<recorded>;
using D = duet::screw_dual<recorded>;
using L = duet::dual_vector<recorded>;
using P = duet::dual_quaternion<recorded>;

/// A formula that grows by random operations on what it has.
class random_formula {
public:
  formula_graph f;
  std::vector<double> at; ///< the numbers of the inputs

  explicit random_formula(duet_test::random_source& random) : random_(random) {
    add_inputs();
    const int size = random.integer(2, 12);
    for (int k = 0; k < 4 * size && steps_ < size; ++k) {
      add_step();
    }
    add_outputs();
  }

private:
  template <class X>
  static const X& last_or_any(const std::vector<X>& all, duet_test::random_source& random) {
    const int n = int(all.size());
    return all[std::size_t(random.integer(0, 2) == 0 ? random.integer(0, n - 1) : n - 1)];
  }
  const recorded& s() { return last_or_any(scalars_, random_); }
  const V& v() { return last_or_any(vectors_, random_); }
  const M& m() { return last_or_any(matrices_, random_); }
  const Q& q() { return last_or_any(rotations_, random_); }
  const L& l() { return last_or_any(lines_, random_); }
  const P& p() { return last_or_any(poses_, random_); }
  /// A number, as an input: arithmetic of constants alone would be done, and rounded, at once.
  recorded number() {
    const std::string name = "c" + std::to_string(f.inputs().size());
    return input<recorded>(name.c_str(), shape::scalar, 1);
  }

  template <class X>
  X input(const char* name, shape kind, int rows, int columns = 1) {
    const named_value& x =
        f.add_input({.name = name, .kind = kind, .rows = rows, .columns = columns});
    double square = 0;
    for (int k = 0; k < rows * columns; ++k) {
      at.push_back(random_.uniform(-1.5, 1.5));
      square += at.back() * at.back();
    }
    if (kind == shape::quaternion) {
      for (std::size_t k = at.size() - 4; k < at.size(); ++k) {
        at[k] /= std::sqrt(square);
      }
    }
    return detail::recorded_object<X>(f.operations(), x);
  }
  void add_inputs() {
    scalars_.push_back(input<recorded>("x", shape::scalar, 1));
    const int more = random_.integer(0, 15);
    if (more % 2 == 1) {
      scalars_.push_back(input<recorded>("y", shape::scalar, 1));
    }
    const recorded a = scalars_.front(), b = scalars_.back();
    vectors_.push_back(more % 4 < 2 ? input<V>("v", shape::matrix, 3) : V(a, number() * b, b));
    rotations_.push_back(more % 8 < 4 ? input<Q>("q", shape::quaternion, 4)
                                      : Q(duet::exp(V(vectors_[0] * recorded(0.5)))));
    M diagonal = M::Identity();
    diagonal(0, 1) = a;
    diagonal(2, 2) = b;
    matrices_.push_back(more == 3 ? input<M>("m", shape::matrix, 3, 3) : diagonal);
    lines_.push_back(more == 5 ? input<L>("l", shape::dual_vector, 6)
                               : duet::make_dual_vector(vectors_[0], V(b, a, recorded(1))));
    poses_.push_back(duet::pose(rotations_[0], vectors_[0]));
  }

  /// Adds a result, if its numbers are moderate.
  template <class X>
  void keep(std::vector<X>& list, const X& x) {
    detail::add_outputs(f, "", x);
    const std::vector<double> numbers = evaluate(f, at);
    (void)f.take_outputs();
    for (const double y : numbers) {
      if (!(std::abs(y) < 100)) {
        return;
      }
    }
    list.push_back(x);
    ++steps_;
  }

  recorded scalar() {
    const recorded a = s(), b = s();
    const std::function<recorded()> all[] = {
        [&] { return a + b; },
        [&] { return a - b; },
        [&] { return a * b; },
        [&] { return a / b; },
        [&] { return number() * a; },
        [&] { return -a; },
        [&] { return sqrt(1 + a * a); },
        [&] { return cbrt(a); },
        [&] { return exp(a / 4); },
        [&] { return exp2(b); },
        [&] { return expm1(a); },
        [&] { return log(a * a + 0.5); },
        [&] { return log2(2 + sin(a)); },
        [&] { return log10(1 + b * b); },
        [&] { return log1p(a * a); },
        [&] { return sin(a); },
        [&] { return cos(a + b); },
        [&] { return tan(a / 4); },
        [&] { return asin(0.9 * sin(a)); },
        [&] { return acos(0.9 * cos(a)); },
        [&] { return atan(a); },
        [&] { return sinh(a / 2); },
        [&] { return cosh(a / 2); },
        [&] { return tanh(a); },
        [&] { return asinh(a); },
        [&] { return acosh(1.25 + a * a); },
        [&] { return atanh(0.9 * sin(a)); },
        [&] { return erf(a); },
        [&] { return erfc(a); },
        [&] { return abs(a); },
        [&] { return a * floor(b); },
        [&] { return a + ceil(b); },
        [&] { return a - trunc(b) * b; },
        [&] { return a * round(a); },
        [&] { return atan2(a, b); },
        [&] { return hypot(a, b); },
        [&] { return hypot(a, b, recorded(1)); },
        [&] { return pow(1 + a * a, b); },
        [&] { return pow(a, recorded(random_.integer(-16, 16))); },
        [&] { return pow(1.5 + sin(a), number()); },
        [&] { return fmod(a, 2 + b * b); },
        [&] { return remainder(a, 1 + b * b); },
        [&] { return fma(a, b, s()); },
        [&] { return max(a, b); },
        [&] { return min(a, b * b); },
        [&] { return duet::stumpff<2>(recorded(a * a)); },
        [&] { return duet::stumpff<1>(recorded(3 * abs(b))); },
        [&] { return duet::stumpff<3>(recorded(a * a * b * b)); },
        [&] { return duet::arc_ratio(recorded(a * a + 0.01), b); },
        [&] { return v().dot(v()); },
        [&] { return v()[random_.integer(0, 2)]; },
        [&] { return m().trace() + m()(0, 2); },
        [&] { return norm(q()); },
        [&] { return norm(p()).value() + real_part(l()).dot(dual_part(l())); },
        [&] { return condition(a, b); }};
    return all[random_.integer(0, 54)]();
  }
  recorded condition(const recorded& a, const recorded& b) {
    const duet::recorded_condition holds[] = {
        a < b,
        a <= 0.3 * b,
        a < 1 && !(b < 0.1),
        b < -0.5 || a * b < 0.25,
        isfinite(a) && !isnan(b),
        signbit(recorded(a - b)) || !(a <= b),
    };
    return select(
        holds[random_.integer(0, 5)], [&] { return a * b + 2; }, [&] { return b - sin(a); });
  }
  V vector() {
    const std::function<V()> all[] = {[&]() -> V { return v() + v(); },
                                      [&]() -> V { return v() - V(number() * v()); },
                                      [&]() -> V { return s() * v(); },
                                      [&]() -> V { return v() / (1 + s() * s()); },
                                      [&]() -> V { return v().cross(v()); },
                                      [&]() -> V { return duet::rotate(q(), v()); },
                                      [&]() -> V { return m() * v(); },
                                      [&]() -> V { return duet::log(q()).vec(); },
                                      [&]() -> V {
                                        const V a = v() + V(recorded(2), recorded(0), recorded(0));
                                        return a / sqrt(a.dot(a));
                                      },
                                      [&]() -> V { return q().vec(); },
                                      [&]() -> V { return dual_part(l()); },
                                      [&]() -> V { return real_part(l()); },
                                      [&]() -> V { return translation(p()); },
                                      [&]() -> V {
                                        const V a = v(), b = v();
                                        return select(
                                            s() < s(), [&] { return a; }, [&] { return b; });
                                      },
                                      [&]() -> V { return duet::rotation_vector(q()); }};
    return all[random_.integer(0, 14)]();
  }
  M matrix() {
    const std::function<M()> all[] = {[&]() -> M { return m() + m(); },
                                      [&]() -> M { return m() * m(); },
                                      [&]() -> M { return m().transpose(); },
                                      [&]() -> M { return s() * m(); },
                                      [&]() -> M { return v() * v().transpose(); },
                                      [&]() -> M { return duet::rotation_matrix(q()); },
                                      [&]() -> M { return m() - M(number() * M::Identity()); }};
    return all[random_.integer(0, 6)]();
  }
  Q rotation() {
    const std::function<Q()> all[] = {
        [&]() -> Q { return q() * q(); },
        [&]() -> Q { return conj(q()); },
        [&]() -> Q { return inverse(q()); },
        [&]() -> Q { return duet::exp(V(v() * recorded(0.5))); },
        [&]() -> Q { return normalized(q()); },
        [&]() -> Q { return duet::slerp(q(), q(), s()); },
        [&]() -> Q { return duet::slerp(q(), q(), s(), duet::slerp_arc::as_given); },
        [&]() -> Q { return duet::pow(q(), s()); },
        [&]() -> Q { return q() * s() + q(); },
        [&]() -> Q { return real_part(p()); },
        [&]() -> Q { return duet::exp(Q(q() * recorded(0.3))); },
        [&]() -> Q { return duet::from_rotation_vector(v()); }};
    return all[random_.integer(0, 11)]();
  }
  L line() {
    const std::function<L()> all[] = {
        [&]() -> L { return l() + l(); }, [&]() -> L { return duet::make_dual_vector(v(), v()); },
        [&]() -> L { return l().cross(l()); },
        [&]() -> L { return (p() * P(D(recorded(0)), l()[0], l()[1], l()[2]) * conj(p())).vec(); },
        [&]() -> L { return duet::log(p()).vec(); }};
    return all[random_.integer(0, 4)]();
  }
  P pose() {
    const std::function<P()> all[] = {
        [&]() -> P { return p() * p(); },
        [&]() -> P { return conj(p()); },
        [&]() -> P { return duet::exp(L(l() * D(recorded(0.3), recorded(0.1)))); },
        [&]() -> P { return duet::sclerp(p(), p(), s()); },
        [&]() -> P { return duet::pose(normalized(q()), v()); },
        [&]() -> P { return inverse(p()); }};
    return all[random_.integer(0, 5)]();
  }
  void add_step() {
    const int which = random_.integer(0, 11);
    if (which < 5) {
      keep(scalars_, recorded(scalar()));
    } else if (which < 7) {
      keep(vectors_, V(vector()));
    } else if (which < 8) {
      keep(matrices_, M(matrix()));
    } else if (which < 10) {
      keep(rotations_, Q(rotation()));
    } else if (which < 11) {
      keep(lines_, L(line()));
    } else {
      keep(poses_, P(pose()));
    }
  }
  void add_outputs() {
    const int which = random_.integer(0, 9);
    const auto add = [&](const auto& y) { detail::add_outputs(f, "", y); };
    if (which < 3) {
      add(scalars_.back());
    } else if (which < 5) {
      add(std::pair(vectors_.back(), scalars_.back()));
    } else if (which < 6) {
      add(matrices_.back());
    } else if (which < 8) {
      add(rotations_.back());
    } else if (which < 9) {
      add(std::pair(lines_.back(), scalars_.back()));
    } else {
      add(poses_.back());
    }
  }

  duet_test::random_source& random_;
  int steps_ = 0;
  std::vector<recorded> scalars_;
  std::vector<V> vectors_;
  std::vector<M> matrices_;
  std::vector<Q> rotations_;
  std::vector<L> lines_;
  std::vector<P> poses_;
};

/// The outputs in double precision, and of each the condition: the sum over all operations of what
/// a relative change of each changes.
class judged_values {
public:
  std::vector<double> values, conditions;
  /// False where a choice or a step is within round-off of the other side, or a sum is round-off.
  bool is_clear = true;

  judged_values(const formula_graph& f, const std::vector<double>& at) : g_(f.operations()) {
    const std::vector<bool> needed = f.needed();
    const detail::node_values<double> x(g_, needed, at);
    const std::size_t size = needed.size();
    std::vector<std::array<double, 3>> slopes(size);
    for (std::size_t i = 0; i < size; ++i) {
      if (needed[i]) {
        slopes[i] = slopes_at(int(i), x);
      }
    }
    std::vector<double> adjoints(size);
    for (const named_value& y : f.outputs()) {
      for (const int root : y.nodes) {
        std::fill(adjoints.begin(), adjoints.end(), 0);
        adjoints[std::size_t(root)] = 1;
        double condition = 0;
        for (int i = root; i >= 0; --i) {
          const double adjoint = adjoints[std::size_t(i)];
          if (adjoint == 0 || !needed[std::size_t(i)]) {
            continue;
          }
          condition += std::abs(adjoint * x[i]);
          for (std::size_t k = 0; k < 3; ++k) {
            const int operand = g_[i].operands[k];
            if (operand >= 0 && !is_condition(g_[operand].what) && !g_.is_number(operand) &&
                slopes[std::size_t(i)][k] != 0) {
              adjoints[std::size_t(operand)] += adjoint * slopes[std::size_t(i)][k];
            }
          }
        }
        values.push_back(x[root]);
        conditions.push_back(condition);
      }
    }
  }

private:
  using three = duet::dual<double, 3>;

  std::array<double, 3> slopes_at(int i, const detail::node_values<double>& x) {
    const graph_node n = g_[i];
    const auto [a, b, c] = n.operands;
    const auto is_close = [](double p, double q) {
      return std::abs(p - q) < 1e-7 * (1 + std::abs(p));
    };
    if (n.what == operation::less || n.what == operation::less_equal) {
      is_clear = is_clear && !is_close(x[a], x[b]);
    } else if (n.what == operation::is_negative) {
      is_clear = is_clear && !is_close(x[a], 0);
    } else if (n.what == operation::fmod || n.what == operation::remainder) {
      const double ratio = 2 * x[a] / x[b];
      is_clear = is_clear && !is_close(ratio, std::round(ratio));
    } else if (n.what >= operation::floor && n.what <= operation::round) {
      is_clear = is_clear && !is_close(2 * x[a], std::round(2 * x[a]));
    }
    if (n.what == operation::sum || n.what == operation::difference) {
      is_clear = is_clear && (std::abs(x[i]) > 1e-9 * std::abs(x[a]) || x[a] == 0 || a == b);
    }
    if (is_condition(n.what) || operand_count(n.what) == 0) {
      return {};
    }
    if (n.what == operation::select) {
      const bool holds = x[i] == x[b] || !(x[i] == x[c]);
      return {0, holds ? 1.0 : 0.0, holds ? 0.0 : 1.0};
    }
    three y;
    const auto of = [&](int node, int k) { return three::variable(x[node], k); };
    if (n.what == operation::fma) {
      y = of(a, 0) * of(b, 1) + of(c, 2);
    } else if (operand_count(n.what) == 2) {
      y = detail::function_value<three>(n.what, of(a, 0), of(b, 1));
    } else {
      y = detail::function_value<three>(n.what, n.index, of(a, 0));
    }
    for (int k = 0; k < operand_count(n.what); ++k) { // an infinite slope
      is_clear =
          is_clear && (std::isfinite(y.partial(k)) || g_.is_number(n.operands[std::size_t(k)]));
    }
    return {y.partial(0), y.partial(1), y.partial(2)};
  }

  const graph& g_;
};

/// Largest errors of each route, in ulp of the condition.
struct worst_errors {
  double value = 0, forward = 0, second = 0, reverse = 0, reverse_second = 0;
  int count = 0, skipped = 0, read = 0;
  std::string formula;
  double highest = 0;
};

constexpr double infinite = 1e300;

double ulps(double computed, const wide& exact, double condition) {
  const wide difference = abs(wide(computed) - exact);
  const double scale = condition + std::abs(double(exact));
  const bool vanishes = difference < 1e-300; // below the normal numbers
  const double result = vanishes ? 0 : double(difference) / (scale * 0x1p-53);
  return result < infinite ? result : infinite; // also of NaN
}

/// The numbers of all outputs over taylor numbers along a direction: values, then slopes, then
/// second derivatives.
template <class S>
std::vector<S> along(const formula_graph& f, const std::vector<S>& at,
                     const std::vector<S>& direction) {
  using moving = duet::taylor<S, 2>;
  std::vector<moving> inputs;
  for (std::size_t i = 0; i < at.size(); ++i) {
    inputs.push_back(duet::detail::is_structural_zero(direction[i])
                         ? moving(at[i])
                         : at[i] + direction[i] * moving::variable(S(0)));
  }
  const std::vector<moving> y = evaluate(f, inputs);
  std::vector<S> result;
  for (int k = 0; k <= 2; ++k) {
    for (const moving& each : y) {
      result.push_back(each.derivative(k));
    }
  }
  return result;
}

std::vector<recorded> variables_of(formula_graph& to, const formula_graph& f) {
  std::vector<recorded> result;
  for (const named_value& x : f.inputs()) {
    for (const int node : to.add_input(x).nodes) {
      result.emplace_back(to.operations(), node);
    }
  }
  return result;
}

/// A column of further inputs.
std::vector<recorded> column(formula_graph& f, const char* name, std::size_t size) {
  std::vector<recorded> result;
  const named_value& x = f.add_input({.name = name, .kind = shape::matrix, .rows = int(size)});
  for (const int node : x.nodes) {
    result.emplace_back(f.operations(), node);
  }
  return result;
}
/// Σ w_k y_k of the numbers of the outputs, with the weights w as inputs behind.
formula_graph weighted(const formula_graph& f) {
  formula_graph result;
  const std::vector<recorded> y = evaluate(f, variables_of(result, f));
  const std::vector<recorded> weights = column(result, "weights", y.size());
  recorded sum(0);
  for (std::size_t k = 0; k < y.size(); ++k) {
    sum = sum + weights[k] * y[k];
  }
  result.add_output({.name = "value", .nodes = {sum.node_in(result.operations())}});
  return result;
}
/// g·d and dᵀ H d of a formula with the outputs value, gradient and hessian, with d as an input.
formula_graph directional(formula_graph f, std::size_t size) {
  const std::vector<named_value> outputs = f.take_outputs();
  const std::vector<recorded> d = column(f, "direction", size);
  graph& g = f.operations();
  recorded first(0), second(0);
  for (std::size_t i = 0; i < size; ++i) {
    recorded row(0);
    for (std::size_t j = 0; j < size; ++j) {
      row = row + d[j] * recorded(g, outputs[2].nodes[i + j * size]);
    }
    first = first + d[i] * recorded(g, outputs[1].nodes[i]);
    second = second + d[i] * row;
  }
  f.add_output({.name = "first", .nodes = {first.node_in(g)}});
  f.add_output({.name = "second", .nodes = {second.node_in(g)}});
  return f;
}

bool can_be_text(const std::vector<named_value>& values) {
  return std::all_of(values.begin(), values.end(), [](const named_value& x) {
    return x.kind == shape::scalar || x.kind == shape::quaternion ||
           (x.kind == shape::matrix && x.rows == 3 && x.columns == 1);
  });
}

/// A file with the formula in C and a function that counts wrong results.
void write_c(const std::string& folder, int k, const formula_graph& f, const judged_values& y,
             const std::vector<double>& at) {
  const std::string name = "f" + std::to_string(k);
  std::ofstream file(folder + "/" + name + ".c");
  file.precision(17);
  file << to_c(f, name, {.is_row_major = false}) << "\nint check_" << name
       << "(void)\n{\n  double y[64];\n  const double x[" << at.size() << "] = {";
  for (const double x : at) {
    file << x << ", ";
  }
  file << "};\n  int wrong = 0;\n  " << name << "(";
  int next = 0;
  for (const named_value& x : f.inputs()) {
    file << (x.kind == shape::scalar ? "x[" : "x + ") << next
         << (x.kind == shape::scalar ? "], " : ", ");
    next += x.rows * x.columns;
  }
  next = 0;
  for (const named_value& x : f.outputs()) {
    file << (next == 0 ? "" : ", ") << "y + " << next;
    next += x.rows * x.columns;
  }
  file << ");\n";
  for (std::size_t i = 0; i < y.values.size(); ++i) {
    file << "  wrong += !(fabs(y[" << i << "] - (" << y.values[i]
         << ")) <= " << 64 * 0x1p-53 * (y.conditions[i] + std::abs(y.values[i])) << ");\n";
  }
  file << "  return wrong;\n}\n";
}

/// The operations of a formula with their values.
std::string listing(const formula_graph& f, const std::vector<double>& at) {
  const graph& g = f.operations();
  const std::vector<bool> needed = f.needed();
  const detail::node_values<double> x(g, needed, at);
  std::ostringstream text;
  for (int i = 0; i < g.size(); ++i) {
    if (needed[std::size_t(i)]) {
      const std::string_view name = detail::function_name_of(g[i].what);
      text << "  " << i << " = " << (name.empty() ? "operation " : std::string(name) + " ")
           << int(g[i].what) << " of";
      for (const int operand : g[i].operands) {
        text << " " << operand;
      }
      text << " (" << g[i].index << ") = " << x[i] << "\n";
    }
  }
  return text.str();
}

void examine(int seed, worst_errors& worst, const char* folder) {
  duet_test::random_source random{std::uint64_t(seed)};
  const random_formula made(random);
  const formula_graph& f = made.f;
  const std::vector<double>& at = made.at;
  // along a direction in one or two inputs
  std::vector<double> direction(at.size(), 0), part;
  std::vector<std::string> names;
  int next = 0;
  const std::size_t chosen = std::size_t(random.integer(0, int(f.inputs().size()) - 1));
  for (std::size_t k = 0; k < f.inputs().size(); ++k) {
    const named_value& x = f.inputs()[k];
    const int size = x.rows * x.columns;
    if (k == chosen || (k == 0 && random.integer(0, 1) == 0)) {
      names.push_back(x.name);
      for (int i = 0; i < size; ++i) {
        part.push_back(random.uniform(-1, 1));
        direction[std::size_t(next + i)] = part.back();
      }
    }
    next += size;
  }
  const judged_values value(f, at);
  const auto joined = [](std::vector<double> all, const std::vector<double>& more) {
    all.insert(all.end(), more.begin(), more.end());
    return all;
  };
  formula_graph forward;
  {
    const std::vector<recorded> inputs = variables_of(forward, f);
    const std::vector<recorded> d = column(forward, "direction", part.size());
    std::vector<recorded> moves;
    std::size_t used = 0;
    for (const double each : direction) {
      moves.push_back(each == 0 ? recorded(0) : d[used++]);
    }
    named_value all{.name = "all", .kind = shape::matrix, .rows = 0};
    for (const recorded& y : along<recorded>(f, inputs, moves)) {
      all.nodes.push_back(y.node_in(forward.operations()));
    }
    all.rows = int(all.nodes.size());
    forward.add_output(std::move(all));
  }
  const judged_values moving(forward, joined(at, part));
  std::vector<double> weights;
  for (std::size_t k = 0; k < value.values.size(); ++k) {
    weights.push_back(random.uniform(-1, 1));
  }
  const formula_graph backward = directional(reverse_hessian(weighted(f), names), part.size());
  const judged_values reverse(backward, joined(joined(at, weights), part));
  if (!value.is_clear || !moving.is_clear || !reverse.is_clear) {
    ++worst.skipped;
    return;
  }
  const std::vector<wide> exact =
      along<wide>(f, {at.begin(), at.end()}, {direction.begin(), direction.end()});
  const std::vector<double> by_taylor = along<double>(f, at, direction);
  const std::size_t n = value.values.size();
  std::array<double, 5> errors{};
  wide first = 0, second = 0;
  for (std::size_t i = 0; i < n; ++i) {
    errors[0] = std::max(errors[0], ulps(value.values[i], exact[i], value.conditions[i]));
    for (std::size_t k = 0; k < 3; ++k) {
      const double condition = moving.conditions[i + k * n];
      errors[k] = std::max({errors[k], ulps(moving.values[i + k * n], exact[i + k * n], condition),
                            ulps(by_taylor[i + k * n], exact[i + k * n], condition)});
    }
    first += weights[i] * exact[i + n];
    second += weights[i] * exact[i + 2 * n];
  }
  errors[3] = ulps(reverse.values[0], first, reverse.conditions[0]);
  errors[4] = ulps(reverse.values[1], second, reverse.conditions[1]);
  ++worst.count;
  const std::array<double*, 5> largest{&worst.value, &worst.forward, &worst.second, &worst.reverse,
                                       &worst.reverse_second};
  for (std::size_t k = 0; k < 5; ++k) {
    *largest[k] = std::max(*largest[k], errors[k]);
  }
  const double highest = *std::max_element(errors.begin(), errors.end());
  if (highest > worst.highest) {
    worst.highest = highest;
    worst.formula = std::to_string(seed);
  }
  CAPTURE(seed);
  const bool is_right = highest <= 64;
  if (!is_right) {
    std::cout << "formula " << seed << ":";
    for (const double error : errors) {
      std::cout << " " << error;
    }
    std::cout << "\n" << listing(f, at);
    for (std::size_t i = 0; i < exact.size(); ++i) {
      std::cout << "  exact " << double(exact[i]) << " recorded " << moving.values[i] << " direct "
                << by_taylor[i] << " condition " << moving.conditions[i] << "\n";
    }
  }
  CHECK(is_right);
  if (can_be_text(f.inputs()) && can_be_text(f.outputs())) {
    const std::vector<double> again = evaluate(read_formula(to_text(f)), at);
    for (std::size_t i = 0; i < n; ++i) {
      CHECK(again[i] == value.values[i]);
    }
    ++worst.read;
  }
  if (folder != nullptr && worst.count <= 1000) {
    write_c(folder, worst.count, f, value, at);
  }
}

int number_of(const char* variable, int otherwise) {
  const char* const text = std::getenv(variable);
  return text == nullptr ? otherwise : std::atoi(text);
}

TEST_CASE("random formulas of all kinds: three routes against 50 digits, and texts") {
  worst_errors worst;
  const int first = number_of("DUET_RANDOM_FORMULAS_SEED", 1);
  const int count = number_of("DUET_RANDOM_FORMULAS", 2000);
  for (int k = 0; k < count; ++k) {
    examine(first + k, worst, std::getenv("DUET_RANDOM_FORMULAS_C"));
  }
  std::cout << worst.count << " formulas, " << worst.skipped << " skipped, " << worst.read
            << " read again; largest error in ulp of the condition: value " << worst.value
            << ", first derivative " << worst.forward << ", second " << worst.second
            << ", in reverse " << worst.reverse << " and " << worst.reverse_second << " (formula "
            << worst.formula << ")\n";
  CHECK(worst.count > count / 2);
}

} // namespace
} // namespace test_expression_formulas_of_all_kinds
