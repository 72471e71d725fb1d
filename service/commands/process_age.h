#pragma once

#include <chrono>

namespace afterglow {

/// Wall time since the system made this process, up to a clock tick (10 ms) too little: unlike any clock of
/// the program's own it covers loading the shared libraries. 0 where /proc cannot be read. Thread-safe.
std::chrono::duration<double> process_age();

}  // namespace afterglow
