#include "client/exit_code.h"

#include <array>
#include <string_view>
#include <utility>

namespace afterglow::client {

std::string exit_code_help() {
    constexpr std::array<std::pair<ExitCode, std::string_view>, 8> meanings{{
        {ExitCode::ok, "done; the watched job succeeded"},
        {ExitCode::job_failed, "the watched job failed"},
        {ExitCode::bad_input, "bad usage or bad input"},
        {ExitCode::job_cancelled, "the watched job was cancelled"},
        {ExitCode::not_found, "no such job"},
        {ExitCode::no_server, "the server cannot be reached or was lost for good"},
        {ExitCode::local_failure, "a local file or standard output cannot be written"},
        {ExitCode::interrupted, "interrupted by Ctrl-C; a submitted job goes on"},
    }};
    std::string text = "Exit status:\n";
    for (const auto& [code, meaning] : meanings) {
        std::string number = std::to_string(static_cast<int>(code));
        text += "  " + number + std::string(6 - number.size(), ' ') + std::string(meaning) + "\n";
    }
    return text;
}

}  // namespace afterglow::client
