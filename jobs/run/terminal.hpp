#pragma once

#include <cstddef>

namespace semigeo::jobs {

/// Returns the number of columns of a terminal: what COLUMNS says, or the terminal behind this
/// descriptor, or 80.
std::size_t terminal_columns(int descriptor);

/// Returns whether lines may be written over each other there: the descriptor is a terminal, and
/// TERM does not call it dumb.
bool is_live_terminal(int descriptor);

}  // namespace semigeo::jobs
