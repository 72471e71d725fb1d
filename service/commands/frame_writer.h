#pragma once

#include <filesystem>
#include <future>
#include <utility>

#include "solver/sequence/sequence.h"

namespace afterglow {

/// Encodes and writes the files of one frame while the next is worked on. One thread at a time; whoever
/// destroys it waits.
class FrameWriter {
  public:
    explicit FrameWriter(std::filesystem::path folder) : folder_(std::move(folder)) {}

    /// Begins with a frame once the one before it is written. Errors: those of `finish`.
    void begin(Revision picture);
    /// Waits until all is written. Errors: io; each file is there whole or not at all.
    void finish();

  private:
    std::filesystem::path folder_;
    std::future<void> writing_;
};

}  // namespace afterglow
