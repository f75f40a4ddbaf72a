// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: inside another one with the same tag.*give it a separate tag: derivative<struct my_tag>

#include <duet/derivative/derivative.hpp>

// The n-th derivative of x³ by recursion through one function type: the levels cannot be
// distinguished.
#ifdef DUET_MUST_FAIL
struct slope {
  template <class T>
  auto operator()(const T& x) const {
    if constexpr (duet::scalar_traits<T>::order == 2) {
      return x * x * x;
    } else {
      return duet::derivative(*this, x).derivative;
    }
  }
};
#else
template <int N>
struct level;
struct slope {
  template <class T>
  auto operator()(const T& x) const {
    if constexpr (duet::scalar_traits<T>::order == 2) {
      return x * x * x;
    } else {
      return duet::derivative<level<duet::scalar_traits<T>::order>>(*this, x).derivative;
    }
  }
};
#endif

int main() { return slope()(2.0) == 12 ? 0 : 1; }
