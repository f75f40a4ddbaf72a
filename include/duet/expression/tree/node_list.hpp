// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiler/types.hpp>

/// \file
/// Lists of nodes and the indices of nodes in them.

namespace duet::expression::detail {

/// Index of the first value that is true, or -1.
[[nodiscard]] constexpr int index_of_true(const bool* all, int count) {
  for (int i = 0; i < count; ++i) {
    if (all[i]) {
      return i;
    }
  }
  return -1;
}

/// Ordered list of nodes.
template <class... Nodes>
class node_list {
  static constexpr int count = int(sizeof...(Nodes));
  // The comparison of types is built into compilers: it is faster than deducing a base class and,
  // unlike a comparison of addresses, constant under sanitizers, too. The last entry avoids an
  // empty array.
  template <class Node>
  static constexpr bool is_it[] = {DUET_IS_SAME(Nodes, Node)..., false};

public:
  /// Index of a node, or -1 if it is not in the list.
  template <class Node>
  static constexpr int index = index_of_true(is_it<Node>, count);
};

} // namespace duet::expression::detail
