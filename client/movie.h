#pragma once

#include <filesystem>

namespace afterglow::client {

/// Pictures that follow each other, as `get` leaves them: frame_NNNN.png from `first_frame` on.
struct MovieFrames {
    std::filesystem::path folder;
    int first_frame = 0;
    double frames_per_second = 24;
};

/// Whether ffmpeg, which makes the movies, can be run.
enum class MovieMaker { present, missing };
MovieMaker find_movie_maker();

/// Makes a movie of the frames; the ending of `file` says of what kind. An older file of that name goes.
/// Errors: local_failure where ffmpeg is missing or fails; what it said is then on standard error.
void make_movie(const MovieFrames& frames, const std::filesystem::path& file);

}  // namespace afterglow::client
