#include <csignal>
#include <cstdlib>
#include <iostream>
#include <string>
#include <sys/ioctl.h>
#include <unistd.h>
#include <vector>

#include "client/commands.h"
#include "client/error.h"
#include "client/text.h"
#include "client/watch_reporter.h"

namespace {

using namespace afterglow::client;

int terminal_columns() {
    winsize size{};
    constexpr int usual = 80;
    return ::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : usual;
}

std::string from_environment(const char* name) {
    const char* value = std::getenv(name);
    return value == nullptr ? "" : value;
}

ExitCode run(const std::vector<std::string>& arguments) {
    const Options options =
        parse_options(arguments, {from_environment("AFTERGLOW_SERVER"), from_environment("AFTERGLOW_TOKEN")});
    Interrupt interrupt;
    Session session{options, interrupt, std::cout, std::cerr, {}};
    if (::isatty(STDOUT_FILENO) == 1) session.columns = terminal_columns;
    const ExitCode code = run_command(session);
    std::cout.flush();
    check_output(std::cout);
    return code;
}

}  // namespace

int main(int argc, char** argv) {
    // A reader that went away shows as a failed write, which has its own exit code.
    std::signal(SIGPIPE, SIG_IGN);
    try {
        return static_cast<int>(run(std::vector<std::string>(argv + 1, argv + argc)));
    } catch (const ClientError& error) {
        std::cerr << "afterglow: " << one_line(error.what()) << std::endl;
        return static_cast<int>(error.code());
    } catch (const std::exception& error) {
        std::cerr << "afterglow: " << one_line(error.what()) << std::endl;
        return static_cast<int>(ExitCode::local_failure);
    }
}
