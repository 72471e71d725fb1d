#include <chrono>
#include <csignal>
#include <cstdio>
#include <exception>
#include <iostream>
#include <malloc.h>
#include <new>
#include <span>
#include <string>
#include <string_view>
#include <unistd.h>
#include <variant>

#include "service/base/child_process.h"
#include "service/base/console.h"
#include "service/commands/child_command.h"
#include "service/commands/interrupt.h"
#include "service/commands/process_age.h"
#include "service/commands/render_command.h"
#include "service/commands/render_options.h"
#include "service/commands/serve_command.h"
#include "service/commands/serve_options.h"
#include "solver/base/error.h"

namespace {

using afterglow::Error;
using afterglow::ErrorKind;

constexpr int status_failed = 1;
constexpr int status_bad_input = 2;
constexpr int status_signal = 128;  // plus the signal's number, as shells have it

constexpr std::string_view usage =
    "Afterglow, radiosity that remembers the last frame\n"
    "\n"
    "  afterglowd render SCENE [options]   render frames into a folder\n"
    "  afterglowd serve [options]          offer rendering over HTTP\n"
    "  afterglowd version                  print the version\n"
    "\n"
    "`afterglowd COMMAND --help` lists a command's options.\n";

#if defined(__x86_64__)
/// Refuses processors that lack what the rest of the program is compiled for. Runs before every other
/// initialiser and is itself compiled for any x86-64, since the next instruction might be an illegal one.
__attribute__((constructor(101), target("arch=x86-64"))) void require_processor() {
    __builtin_cpu_init();
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2"))
        return;
    constexpr char message[] =
        "afterglowd: processor: this program is built for x86-64-v3 (AVX2, FMA, BMI2), which this processor "
        "lacks\n";
    if (::write(STDERR_FILENO, message, sizeof message - 1) < 0) ::_exit(status_failed);
    ::_exit(status_failed);
}
#endif

/// Frame after frame asks for what the one before gave back, and pages that went to the system meanwhile come
/// back to be cleared first: a twentieth of a frame's time. Larger blocks, and more than this much, still go.
void keep_freed_memory() {
    constexpr int largest_block_bytes = 32 << 20, most_bytes = 256 << 20;
    ::mallopt(M_MMAP_THRESHOLD, largest_block_bytes);
    ::mallopt(M_TRIM_THRESHOLD, most_bytes);
}

int exit_status(ErrorKind kind, int signal) {
    if (kind == ErrorKind::cancelled) return status_signal + (signal != 0 ? signal : SIGINT);
    return kind == ErrorKind::io ? status_failed : status_bad_input;
}

int complain(std::string_view message, int status) {
    std::fprintf(stderr, "afterglowd: %s\n", afterglow::one_line(message).c_str());
    return status;
}

void run_render(std::span<const char* const> arguments, const afterglow::Interrupt& interrupt,
                std::chrono::steady_clock::time_point started) {
    const auto asked = afterglow::read_render_options(arguments);
    if (const auto* help = std::get_if<afterglow::HelpText>(&asked)) {
        std::cout << help->text;
        return;
    }
    keep_freed_memory();
    afterglow::render_command(std::get<afterglow::RenderOptions>(asked), interrupt.token(), started);
}

int run_serve(std::span<const char* const> arguments, const afterglow::Interrupt& interrupt) {
    const auto asked = afterglow::read_serve_options(arguments);
    if (const auto* help = std::get_if<afterglow::HelpText>(&asked)) {
        std::cout << help->text;
        return 0;
    }
    return afterglow::serve(std::get<afterglow::ServeConfig>(asked), interrupt.token());
}

}  // namespace

int main(int argc, char** argv) {
    const auto started =
        std::chrono::steady_clock::now() -
        std::chrono::duration_cast<std::chrono::steady_clock::duration>(afterglow::process_age());
    const std::span<const char* const> arguments(argv, static_cast<std::size_t>(argc));
    const std::string_view command = argc > 1 ? argv[1] : "";
    try {
        // Before anything else begins: it is a process of few threads with limits of its own.
        if (command == afterglow::child_command_name) return afterglow::child_command(arguments.subspan(2));
    } catch (const std::exception& e) {
        return complain(e.what(), status_bad_input);
    }
    const afterglow::Interrupt interrupt;
    try {
        if (command == "render")
            run_render(arguments.subspan(2), interrupt, started);
        else if (command == "serve")
            return run_serve(arguments.subspan(2), interrupt);
        else if (command == "version" || command == "--version")
            std::cout << "afterglowd " AFTERGLOW_VERSION "\n";
        else if (command == "help" || command == "--help" || command == "-h")
            std::cout << usage;
        else if (command.empty())
            return complain("no command given; see `afterglowd --help`", status_bad_input);
        else
            return complain("there is no command \"" + std::string(command) + "\"; see `afterglowd --help`",
                            status_bad_input);
        return 0;
    } catch (const Error& e) {
        return complain(e.what(), exit_status(e.kind(), interrupt.signal()));
    } catch (const std::bad_alloc&) {
        return complain("out of memory", status_failed);
    } catch (const std::exception& e) {
        return complain(std::string("internal error: ") + e.what(), status_failed);
    }
}
