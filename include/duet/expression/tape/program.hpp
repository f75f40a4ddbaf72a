// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/batch/vector_sine_cosine.hpp>
#include <duet/core/compiler/type_id.hpp>
#include <duet/core/config.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/core/structure.hpp>
#include <duet/dual/rules/elementary.hpp>
#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/expression/tape/builder.hpp>
#include <duet/expression/tape/recipe.hpp>
#include <duet/expression/tree/bindings.hpp>
#include <duet/expression/tree/held.hpp>
#include <duet/expression/tree/node.hpp>

#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

/// \file
/// Evaluation of formulas: a program of all different nodes, operands first, each evaluated once.
/// Each stage first computes all sines and cosines whose arguments are known, together.
///
/// The program is data. The number of templates grows with that of different operations in it, not
/// with that of nodes.

namespace duet::expression::detail {

/// Symbols and constants, by bits in the order in which a formula holds them: those with real
/// values, if others are of another scalar type, and scalars, vectors and quaternions of dual
/// numbers with lines and motions.
template <bool AreMixed, std::uint64_t Real, std::uint64_t Dual>
struct input_types {
  static constexpr bool are_mixed = AreMixed;
  static constexpr std::uint64_t real = Real, dual = Dual;
};

[[nodiscard]] constexpr bool has_bit(std::uint64_t bits, int i) {
  return 0 <= i && i < 64 && (bits >> i & 1) != 0;
}
[[nodiscard]] constexpr std::uint64_t bit_of(int i) {
  return 0 <= i && i < 64 ? std::uint64_t(1) << i : 0;
}

/// Added to the storage of what is real, if others are not, and of what has dual numbers with lines
/// and motions for scalars.
inline constexpr int real_storage = 64, dual_storage = 128;

[[nodiscard]] constexpr bool is_kind_of_dual(kind k) {
  return k == kind::dual_vector || k == kind::pose;
}

/// A tape with what is evaluated on it.
template <int Capacity, int Roots, int Inputs>
struct tape_program : tape_memory<Capacity> {
  int roots[std::size_t(Roots)] = {};         ///< entries of results
  int inputs[std::size_t(Inputs + 1)] = {};   ///< positions of inputs, −1 if not used
  int storage[std::size_t(Capacity)] = {};    ///< kind of each entry, more if it is real
  int position[std::size_t(Capacity)] = {};   ///< of each entry among values of its storage
  int numbers[std::size_t(Capacity)] = {};    ///< entries of numbers
  int order[std::size_t(Capacity)] = {};      ///< entries of operations; −1 − g, the g-th sines
  int group_ends[std::size_t(Capacity)] = {}; ///< after the pairs of sine and cosine of each group
  int number_count = 0;
  int step_count = 0;
  int groups = 0;
  int kind_count = 0;
  int kinds[64] = {};      ///< storage of the values
  int kind_sizes[64] = {}; ///< numbers of values of each kind
  int sine_argument[std::size_t(Capacity)] = {};
  int sine[std::size_t(Capacity)] = {};
  int cosine[std::size_t(Capacity)] = {};

  /// Sets the storage and the position of an entry.
  constexpr void allot(int i, bool is_real, bool is_dual) {
    const kind kind_of = this->entries[i].kind_of;
    const int k = int(kind_of) + (is_real ? real_storage : 0) +
                  (is_dual && !is_kind_of_dual(kind_of) ? dual_storage : 0);
    int n = 0;
    while (n < kind_count && kinds[n] != k) {
      ++n;
    }
    if (n == kind_count) {
      kinds[kind_count++] = k;
    }
    storage[i] = k;
    position[i] = kind_sizes[n]++;
  }

  /// Orders what the roots need.
  template <class Types>
  constexpr void schedule() {
    const tape_builder tape(*this);
    bool is_needed[std::size_t(Capacity)] = {};
    bool is_real[std::size_t(Capacity)] = {};
    bool is_dual[std::size_t(Capacity)] = {};
    int stage[std::size_t(Capacity)] = {};
    int pair[std::size_t(Capacity)] = {}; // sines and cosines of an argument
    for (int root : roots) {
      is_needed[root] = true;
    }
    mark_operands(tape, is_needed, tape.size() - 1);
    for (int& i : inputs) {
      i = -1;
    }
    int last_stage = 0;
    for (int i = 0; i < tape.size(); ++i) {
      if (!is_needed[i]) {
        continue;
      }
      const tape_entry& e = tape[i];
      if (e.code <= tape_code::input) {
        const int input = e.parameter < 0 ? -1 - e.parameter : e.parameter;
        const bool is_input = e.code == tape_code::input;
        is_real[i] = Types::are_mixed && (!is_input || has_bit(Types::real, input));
        is_dual[i] = is_input && has_bit(Types::dual, input);
        allot(i, is_real[i], is_dual[i]);
        is_dual[i] = is_dual[i] || is_kind_of_dual(e.kind_of);
        if (e.code == tape_code::input) {
          inputs[input] = position[i];
        } else if (e.kind_of == kind::scalar) {
          numbers[number_count++] = i;
        } else {
          order[step_count++] = i;
        }
        continue;
      }
      const int* x = tape.operands(i);
      int s = 1;
      is_real[i] = Types::are_mixed;
      for (int k = 0; k < e.count; ++k) {
        is_real[i] = is_real[i] && is_real[x[k]];
        is_dual[i] = is_dual[i] || is_dual[x[k]];
        s = stage[x[k]] > s ? stage[x[k]] : s;
      }
      is_dual[i] = is_dual[i] && !(e.code == tape_code::other && e.operation->drops_dual) &&
                   e.kind_of != kind::condition;
      s += is_sine(e.code);
      stage[i] = s;
      last_stage = s > last_stage ? s : last_stage;
    }
    // The entries of a stage as lists: its sines and cosines, and what else there is.
    int next[std::size_t(Capacity)] = {};
    int first_sine[std::size_t(Capacity)] = {}, first_other[std::size_t(Capacity)] = {};
    for (int i = tape.size() - 1; i > 0; --i) {
      if (stage[i] > 0) {
        int& first = (is_sine(tape.code(i)) ? first_sine : first_other)[stage[i]];
        next[i] = first;
        first = i;
      }
    }
    int pairs = 0;
    for (int s = 1; s <= last_stage; ++s) {
      const int first_pair = pairs;
      for (int i = first_sine[s]; i > 0; i = next[i]) {
        const int x = tape.operand(i, 0);
        if (pair[x] == 0) {
          pair[x] = ++pairs;
          sine_argument[pairs - 1] = x;
          sine[pairs - 1] = cosine[pairs - 1] = -1;
        }
        allot(i, is_real[i], is_dual[i]);
        (tape.code(i) == tape_code::sine ? sine : cosine)[pair[x] - 1] = position[i];
      }
      if (pairs > first_pair) {
        group_ends[++groups] = pairs;
        order[step_count++] = -groups;
      }
      for (int i = first_other[s]; i > 0; i = next[i]) {
        order[step_count++] = i;
        allot(i, is_real[i], is_dual[i]);
      }
    }
  }
  static constexpr bool is_sine(tape_code code) {
    return code == tape_code::sine || code == tape_code::cosine;
  }

  [[nodiscard]] constexpr int operand(int i, int k) const {
    if (i < 0) {
      return 0;
    }
    const tape_entry& e = this->entries[i];
    return k < e.count ? position[this->operands[e.first + k]] : 0;
  }
};

template <class Held>
inline constexpr int items_in = 0;
template <class... Items>
inline constexpr int items_in<held<Items...>> = int(sizeof...(Items));

/// Puts nodes on a tape.
template <class... Roots>
struct build_nodes {
  static constexpr int root_count = int(sizeof...(Roots));
  static constexpr int passes = 1;
  static constexpr int initial_capacity = 128;
  template <class Held, int>
  static constexpr void build(tape_builder& tape, int* roots) {
    static_cast<void>(((*roots++ = recipe<Roots>::template add<tape_use<0>, Held>(tape)), ...));
  }
};

template <class Build, class Held, int Capacity>
using program_of = tape_program<Capacity, Build::root_count, items_in<Held>>;

/// The tape after some passes. Each is a constant of its own: clang limits the steps of one
/// constant expression to a million.
template <class Build, class Held, int Pass, int Capacity>
[[nodiscard]] constexpr auto tape_after();
template <class Build, class Held, int Pass, int Capacity>
inline constexpr auto built_tape = tape_after<Build, Held, Pass, Capacity>();
template <class Build, class Held, int Pass, int Capacity>
[[nodiscard]] constexpr auto tape_after() {
  program_of<Build, Held, Capacity> result;
  if constexpr (Pass > 0) {
    result = built_tape<Build, Held, Pass - 1, Capacity>;
  }
  tape_builder tape(result);
  Build::template build<Held, Pass>(tape, result.roots);
  return result;
}

template <class Build, class Held, class Inputs, int Capacity>
[[nodiscard]] constexpr auto make_program() {
  auto result = built_tape<Build, Held, Build::passes - 1, Capacity>;
  result.template schedule<Inputs>();
  return result;
}

template <class Build, class Held, class Inputs, int Capacity>
struct frozen_program {
  static constexpr auto program = make_program<Build, Held, Inputs, Capacity>();

  // Functions for constant expressions: clang would emit the array if its elements were read.

  /// Code, number of operands, parameter, and storage of the result and up to three operands; if
  /// there are more, the index of the step instead.
  static consteval std::uint64_t key(int i) {
    const int k = program.order[i];
    if (k < 0) {
      return std::uint64_t(tape_code::sines) | std::uint64_t(1023 - k) << 12;
    }
    const tape_entry& e = program.entries[k];
    std::uint64_t key = std::uint64_t(e.code) | std::uint64_t(e.count) << 5 |
                        std::uint64_t(e.parameter + 1024) << 12 |
                        std::uint64_t(program.storage[k]) << 24;
    if (e.count > 3) {
      return key | std::uint64_t(i) << 32;
    }
    for (int n = 0; n < e.count; ++n) {
      key |= std::uint64_t(program.storage[program.operands[e.first + n]]) << (32 + 8 * n);
    }
    return key;
  }
  /// Positions of the result and up to three operands.
  static consteval std::uint64_t positions(int i) {
    const int k = program.order[i];
    return k < 0 ? 0
                 : std::uint64_t(program.position[k]) | std::uint64_t(program.operand(k, 0)) << 16 |
                       std::uint64_t(program.operand(k, 1)) << 32 |
                       std::uint64_t(program.operand(k, 2)) << 48;
  }
  static consteval const duet::detail::type_mark* id(int i) {
    const int k = program.order[i];
    return k >= 0 && program.entries[k].code == tape_code::other ? program.entries[k].operation->id
                                                                 : nullptr;
  }
  static consteval int operand(int i, int k) { return program.operand(program.order[i], k); }
  static consteval int operand_storage(int i, int k) {
    return program.storage[program.operands[program.entries[program.order[i]].first + k]];
  }
  static consteval double number(int i) { return program.entries[program.numbers[i]].number; }
  static consteval int number_position(int i) { return program.position[program.numbers[i]]; }
  static consteval int kind_at(int i) { return program.kinds[i]; }
  static consteval int kind_size(int i) { return program.kind_sizes[i]; }
  static consteval int group_end(int i) { return program.group_ends[i]; }
  static consteval int argument(int i) { return program.position[program.sine_argument[i]]; }
  static consteval int argument_storage(int i) { return program.storage[program.sine_argument[i]]; }
  static consteval int sine(int i) { return program.sine[i]; }
  static consteval int cosine(int i) { return program.cosine[i]; }
  static consteval int root(int i) { return program.position[program.roots[i]]; }
  static constexpr bool is_zero_root(int i) {
    return program.entries[program.roots[i]].code == tape_code::zero;
  }
  static consteval int root_storage(int i) { return program.storage[program.roots[i]]; }
  static consteval int input(int i) { return program.inputs[i]; }
  template <class Node>
  static consteval int input_storage(int i) {
    return int(Node::kind_of) + (has_bit(Inputs::real, i) ? real_storage : 0) +
           (has_bit(Inputs::dual, i) ? dual_storage : 0);
  }
};

/// The program with the memory that it needs.
template <class Build, class Held, class Inputs, int Capacity = Build::initial_capacity>
[[nodiscard]] constexpr auto fitting_program() {
  static_assert(Capacity <= 1 << 15, "duet: a formula of too many operations for the compiler; "
                                     "trace(f, ...) records them at run time");
  using program = frozen_program<Build, Held, Inputs, Capacity>;
  if constexpr (Capacity <= 1 << 15 && program::program.is_full) {
    return fitting_program<Build, Held, Inputs, 2 * Capacity>();
  } else {
    return program();
  }
}

// Values, in one array for each kind.

template <class S, kind K>
struct tape_value {
  using type = decltype(leaf<zero_node<K>, numbers_as<S>>::value({}));
};
template <class S>
struct tape_value<S, kind::scalar> {
  using type = S;
};
template <class S>
struct tape_value<S, kind::condition> {
  using type = std::remove_cvref_t<decltype(innermost(std::declval<const S&>()) <
                                            innermost(std::declval<const S&>()))>;
};
template <class S, bool IsDual>
using dual_if = std::conditional_t<IsDual, screw_dual<S>, S>;
template <class S, class Real, int Storage>
using stored_value =
    typename tape_value<dual_if<std::conditional_t<(Storage & real_storage) != 0, Real, S>,
                                (Storage & dual_storage) != 0>,
                        kind(Storage % real_storage)>::type;
template <class T, int Storage, int Size>
struct tape_array {
  T values[std::size_t(Size)];
};
template <class S, class Real, class Program, class Indices>
struct tape_values;
template <class S, class Real, class Program, int... I>
struct tape_values<S, Real, Program, std::integer_sequence<int, I...>>
    : tape_array<stored_value<S, Real, Program::kind_at(I)>, Program::kind_at(I),
                 Program::kind_size(I)>... {
  using scalar = S;
  using real = Real;
};
template <int Storage, class T, int Size>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr T* values_of(tape_array<T, Storage, Size>& v) {
  return v.values;
}

template <class T>
inline constexpr bool is_quaternion_value = false;
template <class T>
inline constexpr bool is_quaternion_value<quaternion<T>> = true;
/// Eigen matrix, as distinguished from other values of formulas.
template <class T>
concept EigenMatrix = requires {
  T::SizeAtCompileTime;
};

/// A value over other scalars.
template <class T, class X>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr T converted(const X& x) {
  if constexpr (std::is_same_v<T, X>) {
    return x;
  } else if constexpr (is_screw_dual<T> && is_screw_dual<X>) {
    return x.zip([](const auto& part) { return converted<scalar_of_t<T>>(part); });
  } else if constexpr (EigenMatrix<T>) {
    return T(map_scalars([](const auto& part) { return converted<typename T::Scalar>(part); }, x));
  } else if constexpr (is_quaternion_value<T>) {
    using scalar = typename structure<T>::scalar;
    return T(map_scalars([](const auto& part) { return converted<scalar>(part); }, x));
  } else {
    return T(x);
  }
}

template <class S>
DUET_ALWAYS_INLINE constexpr void set_pair(S* s, int sine, int cosine, const S& y, const S& z) {
  if (sine >= 0) {
    s[sine] = y;
  }
  if (cosine >= 0) {
    s[cosine] = z;
  }
}
template <class S>
DUET_ALWAYS_INLINE constexpr void take_sine(S* s, int argument, int sine, int cosine) {
  const S& x = s[argument];
  if (cosine < 0) {
    s[sine] = duet::rule::sin{}.value(x);
  } else if (sine < 0) {
    s[cosine] = duet::rule::cos{}.value(x);
  } else {
    const auto y = duet::detail::sine_and_cosine_of(x);
    s[sine] = y.sine;
    s[cosine] = y.cosine;
  }
}
template <class Program, int First, bool AtOnce, class Values, int... I>
DUET_ALWAYS_INLINE constexpr void take_sines_on_tape(Values& v, std::integer_sequence<int, I...>) {
  if constexpr (AtOnce && duet::detail::takes_sines_at_once<std::remove_pointer_t<
                              decltype(values_of<Program::argument_storage(First + I)>(v))>...>) {
    if (!std::is_constant_evaluated()) {
      const duet::detail::sines_at_once<sizeof...(I)> y(
          values_of<Program::argument_storage(First + I)>(v)[Program::argument(First + I)]...);
      (set_pair(values_of<Program::argument_storage(First + I)>(v), Program::sine(First + I),
                Program::cosine(First + I), y.sine(I), y.cosine(I)),
       ...);
      return;
    }
  }
  (take_sine(values_of<Program::argument_storage(First + I)>(v), Program::argument(First + I),
             Program::sine(First + I), Program::cosine(First + I)),
   ...);
}

template <tape_code Code, const duet::detail::type_mark* Id, int Parameter, kind K>
struct operation_of_step : operation_of_code<Code, Parameter, K> {};
template <const duet::detail::type_mark* Id, int Parameter, kind K>
struct operation_of_step<tape_code::other, Id, Parameter, K> {
  using type = duet::detail::type_of_id<Id>;
};
template <tape_code Code, const duet::detail::type_mark* Id, int Parameter, kind K, class Real,
          class... X>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr auto operate(const X&... x) {
  if constexpr (Code == tape_code::zero) {
    return leaf<zero_node<K>, numbers_as<Real>>::value({});
  } else if constexpr (Code == tape_code::unit_vector) {
    return leaf<unit_vector_node<K, Parameter>, numbers_as<Real>>::value({});
  } else {
    using operation = typename operation_of_step<Code, Id, Parameter, K>::type;
    if constexpr (sizeof...(X) == 0) {
      return leaf<operation, numbers_as<Real>>::value({});
    } else {
      return operation::value(x...);
    }
  }
}
template <class Program, tape_code Code, const duet::detail::type_mark* Id, int Parameter, int Step,
          kind Kind, class Values, int... K>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr auto operate_on_many(Values& v,
                                                                std::integer_sequence<int, K...>) {
  return operate<Code, Id, Parameter, Kind, typename Values::real>(
      values_of<Program::operand_storage(Step, K)>(v)[Program::operand(Step, K)]...);
}

template <class Program, std::uint64_t Key, const duet::detail::type_mark* Id, bool AtOnce,
          class Values>
DUET_ALWAYS_INLINE constexpr void run_on_tape(Values& v, std::uint64_t positions) {
  constexpr auto code = tape_code(Key % 32);
  constexpr int count = int(Key >> 5 & 127);
  constexpr int n = int(Key >> 12 & 4095) - 1024;
  if constexpr (code == tape_code::sines) {
    constexpr int first = Program::group_end(n);
    constexpr int end = Program::group_end(n + 1);
    take_sines_on_tape<Program, first, AtOnce>(v, std::make_integer_sequence<int, end - first>{});
  } else {
    auto& result = values_of<int(Key >> 24 & 255)>(v)[std::uint16_t(positions)];
    using R = std::remove_reference_t<decltype(result)>;
    using real = typename Values::real;
    constexpr kind k = kind(Key >> 24 & 63);
    constexpr int a = Key >> 32 & 255, b = Key >> 40 & 255, c = Key >> 48 & 255;
    const auto i = std::uint16_t(positions >> 16), j = std::uint16_t(positions >> 32),
               l = std::uint16_t(positions >> 48);
    if constexpr (count == 0) {
      result = converted<R>(operate<code, Id, n, k, real>());
    } else if constexpr (count == 1) {
      result = converted<R>(operate<code, Id, n, k, real>(values_of<a>(v)[i]));
    } else if constexpr (count == 2) {
      result = converted<R>(operate<code, Id, n, k, real>(values_of<a>(v)[i], values_of<b>(v)[j]));
    } else if constexpr (count == 3) {
      result = converted<R>(operate<code, Id, n, k, real>(values_of<a>(v)[i], values_of<b>(v)[j],
                                                          values_of<c>(v)[l]));
    } else {
      result = converted<R>(operate_on_many<Program, code, Id, n, int(Key >> 32), k>(
          v, std::make_integer_sequence<int, count>{}));
    }
  }
}

template <int Storage, int I>
DUET_ALWAYS_INLINE constexpr void load_input(auto& v, const auto& x) {
  if constexpr (I >= 0) {
    auto& to = values_of<Storage>(v)[I];
    to = converted<std::remove_reference_t<decltype(to)>>(x);
  }
}
template <class Program, class Held, class Item>
DUET_ALWAYS_INLINE constexpr void load_constant(auto& v, const auto& b) {
  if constexpr (!std::is_empty_v<holding<Item>>) {
    using node = typename item_node<Item>::type;
    constexpr int i = item_index<node, Held>;
    load_input<Program::template input_storage<node>(i), Program::input(i)>(v, value_in<node>(b));
  }
}
template <class Program, class Held, class... Items>
DUET_ALWAYS_INLINE constexpr void load_constants(auto& v, const auto& b, held<Items...>) {
  (load_constant<Program, Held, Items>(v, b), ...);
}

/// Values of a program, of which those of the roots are accessible.
template <class Values, class Program>
struct root_values : Values {
  using program = Program;
  template <int K>
  [[nodiscard]] DUET_ALWAYS_INLINE constexpr auto& get() {
    return values_of<Program::root_storage(K)>(*this)[Program::root(K)];
  }
  /// Calls f for Count of the accessible values, from the First-th on.
  template <int First, int Count, class F>
  DUET_ALWAYS_INLINE constexpr void each(const F& f) {
    [&]<int... K>(std::integer_sequence<int, K...>) DUET_INLINE_LAMBDA {
      // An array, as clang limits fold expressions to 256 operands.
      [[maybe_unused]] const bool done[] = {true, (f(get<First + K>()), true)...};
    }
    (std::make_integer_sequence<int, Count>{});
  }
};

template <class Program, class S, class Held, class... Arguments, int... Kind, int... I,
          int... Number>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr auto
run_program(const bindings<Held, Arguments...>& b, const auto& use,
            std::integer_sequence<int, Kind...>, std::integer_sequence<int, I...>,
            std::integer_sequence<int, Number...>) {
  using values = bindings<Held, Arguments...>;
  using real = typename values::real;
  [[maybe_unused]] constexpr int storage_of_numbers = std::is_same_v<S, real> ? 0 : real_storage;
  root_values<tape_values<S, real, Program, std::integer_sequence<int, Kind...>>, Program> v;
  (load_input<Program::template input_storage<typename Arguments::symbol_type>(
                  item_index<typename Arguments::symbol_type, Held>),
              Program::input(item_index<typename Arguments::symbol_type, Held>)>(
       v, static_cast<const Arguments&>(b).value),
   ...);
  if constexpr (!std::is_empty_v<Held>) {
    load_constants<Program, Held>(v, b, Held{});
  }
  [[maybe_unused]] const bool are_loaded[] = {
      true, (values_of<storage_of_numbers>(v)[Program::number_position(Number)] =
                 static_cast<real>(Program::number(Number)),
             true)...};
  [[maybe_unused]] const bool done[] = {
      true, (run_on_tape<Program, Program::key(I), Program::id(I), !values::has_library_sines>(
                 v, Program::positions(I)),
             true)...};
  return use(v);
}

/// Common scalar type of the arguments and of constants that are not numbers, such as dual numbers.
template <class Real, class Item>
struct scalar_of_item {
  using type = Real;
};
template <class Real, class Node, class T>
struct scalar_of_item<Real, held_constant<Node, T>> {
  using scalar = scalar_of_t<T>;
  using type = std::conditional_t<std::is_floating_point_v<scalar>, Real, scalar>;
};
template <class Bindings, class Held>
struct scalar_of_program;
template <class Bindings, class... Items>
struct scalar_of_program<Bindings, held<Items...>> {
  using real = typename Bindings::real;
  using type =
      common_scalar_t<typename Bindings::scalar, typename scalar_of_item<real, Items>::type...>;
};

/// True for scalars, vectors and quaternions of dual numbers with lines and motions.
template <class T, kind K>
inline constexpr bool is_dual_input =
    !is_kind_of_dual(K) && is_screw_dual<typename structure<T>::scalar>;

/// Bits of the arguments and constants for which f of type and kind is true.
template <class Held, class... Arguments, class... Items>
[[nodiscard]] constexpr std::uint64_t input_bits(const held<Items...>*, const auto& f) {
  std::uint64_t bits = 0;
  int i = 0;
  static_cast<void>(((bits |= f(static_cast<Arguments*>(nullptr))
                                  ? bit_of(item_index<typename Arguments::symbol_type, Held>)
                                  : 0),
                     ...));
  static_cast<void>(((bits |= f(static_cast<holding<Items>*>(nullptr)) ? bit_of(i) : 0, ++i), ...));
  return bits;
}
template <class Real>
struct is_real_input {
  template <class Symbol, class T>
  constexpr bool operator()(const argument<Symbol, T>*) const {
    return std::is_same_v<scalar_of_t<T>, Real>;
  }
  template <class Node, class T>
  constexpr bool operator()(const holding<held_constant<Node, T>>*) const {
    return std::is_floating_point_v<scalar_of_t<T>>;
  }
  constexpr bool operator()(const void*) const { return false; }
};
struct is_input_of_duals {
  template <class Symbol, class T>
  constexpr bool operator()(const argument<Symbol, T>*) const {
    return is_dual_input<T, Symbol::kind_of>;
  }
  template <class Node, class T>
  constexpr bool operator()(const holding<held_constant<Node, T>>*) const {
    return is_dual_input<T, Node::kind_of>;
  }
  constexpr bool operator()(const void*) const { return false; }
};

/// Evaluates what `Build` puts on a tape and returns what `use` makes of the values. (They are used
/// in the function that computes them: optimisers take memory that is returned apart only late.)
template <class Build, class Held, class... Arguments>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr auto
evaluated_program(const bindings<Held, Arguments...>& b, const auto& use) {
  using values = bindings<Held, Arguments...>;
  using real = typename values::real;
  using S = typename scalar_of_program<values, Held>::type;
  constexpr bool are_mixed = !std::is_same_v<S, real>;
  constexpr const Held* items = nullptr;
  using inputs =
      input_types<are_mixed,
                  are_mixed ? input_bits<Held, Arguments...>(items, is_real_input<real>()) : 0,
                  input_bits<Held, Arguments...>(items, is_input_of_duals())>;
  using program = decltype(fitting_program<Build, Held, inputs>());
  return run_program<program, S>(b, use,
                                 std::make_integer_sequence<int, program::program.kind_count>{},
                                 std::make_integer_sequence<int, program::program.step_count>{},
                                 std::make_integer_sequence<int, program::program.number_count>{});
}

/// Evaluates some nodes and returns what `use` makes of their values.
template <class... Roots, class Bindings>
[[nodiscard]] DUET_ALWAYS_INLINE constexpr auto evaluated_nodes(const Bindings& b,
                                                                const auto& use) {
  return evaluated_program<build_nodes<Roots...>>(b, use);
}

} // namespace duet::expression::detail
