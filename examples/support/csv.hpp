// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/csv.hpp>

/// \file
/// Tables in files, as the library reads and writes them.

namespace example {

using duet::csv_file;
using duet::csv_line;
using duet::csv_row;
using duet::file_error;
using duet::write_file;

} // namespace example
