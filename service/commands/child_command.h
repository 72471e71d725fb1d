#pragma once

#include <span>

namespace afterglow {

/// The program as a child of its own service, see ChildProcess: reads a scene or computes a job, as the first
/// message says, and ends with its parent. Returns the exit status. Errors: those of become_child.
int child_command(std::span<const char* const> arguments);

}  // namespace afterglow
