#include "client/movie.h"

#include <cerrno>
#include <fcntl.h>
#include <spawn.h>
#include <string>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

#include "client/error.h"

namespace afterglow::client {

namespace {

enum class Voice { heard, silent };

/// Runs ffmpeg to its end and returns its exit status; -1 where it cannot be started.
int run_ffmpeg(std::vector<std::string> arguments, Voice voice) {
    arguments.insert(arguments.begin(), "ffmpeg");
    std::vector<char*> pointers;
    for (std::string& argument : arguments) pointers.push_back(argument.data());
    pointers.push_back(nullptr);

    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    // It must not read the terminal, which may be ours to read.
    posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    if (voice == Voice::silent)
        for (const int output : {STDOUT_FILENO, STDERR_FILENO})
            posix_spawn_file_actions_addopen(&files, output, "/dev/null", O_WRONLY, 0);
    pid_t process = 0;
    const int failure = posix_spawnp(&process, "ffmpeg", &files, nullptr, pointers.data(), environ);
    posix_spawn_file_actions_destroy(&files);
    if (failure != 0) return -1;
    int status = 0;
    while (waitpid(process, &status, 0) < 0 && errno == EINTR) {
    }
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/// What ffmpeg reads the frames by; a percent sign of the folder's name stands for itself.
std::string pattern_of(const std::filesystem::path& folder) {
    std::string pattern;
    for (const char c : folder.string()) pattern += c == '%' ? std::string("%%") : std::string(1, c);
    return pattern + "/frame_%04d.png";
}

}  // namespace

MovieMaker find_movie_maker() {
    return run_ffmpeg({"-version"}, Voice::silent) == 0 ? MovieMaker::present : MovieMaker::missing;
}

void make_movie(const MovieFrames& frames, const std::filesystem::path& file) {
    if (find_movie_maker() == MovieMaker::missing)
        throw ClientError(ExitCode::local_failure, "--movie", "needs ffmpeg, which is not there");
    // Written beside its place first, so that a failure leaves an older one as it was.
    auto part = file.parent_path().empty() ? std::filesystem::path(".") : file.parent_path();
    part /= file.stem().string() + ".part" + file.extension().string();
    const int status =
        run_ffmpeg({"-v", "error", "-y", "-framerate", std::to_string(frames.frames_per_second),
                    "-start_number", std::to_string(frames.first_frame), "-i", pattern_of(frames.folder),
                    // Most players want this pixel format, and it wants even sizes.
                    "-pix_fmt", "yuv420p", "-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", part.string()},
                   Voice::heard);
    std::error_code failure;
    if (status == 0) std::filesystem::rename(part, file, failure);
    if (status == 0 && !failure) return;
    std::filesystem::remove(part, failure);
    throw ClientError(ExitCode::local_failure, file.string(), "ffmpeg could not make it");
}

}  // namespace afterglow::client
