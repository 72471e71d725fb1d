#include "service/commands/process_age.h"

#include <algorithm>
#include <ctime>
#include <fstream>
#include <sstream>
#include <string>
#include <unistd.h>

namespace afterglow {

std::chrono::duration<double> process_age() {
    using Seconds = std::chrono::duration<double>;
    std::ifstream file("/proc/self/stat");
    std::string text;
    std::getline(file, text);
    // The second field is the program's name in brackets, which may itself hold blanks and brackets.
    const auto name_end = text.rfind(')');
    if (name_end == std::string::npos) return Seconds(0);
    std::istringstream fields(text.substr(name_end + 1));
    std::string skipped;
    for (int field = 3; field < 22; ++field) fields >> skipped;
    double ticks_since_boot = 0;  // field 22, see proc(5)
    fields >> ticks_since_boot;
    if (ticks_since_boot <= 0) return Seconds(0);

    timespec now{};
    clock_gettime(CLOCK_BOOTTIME, &now);
    const double since_boot = static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
    // Somewhere within that tick: from its end on, so that no time is counted that was not ours.
    const double began = (ticks_since_boot + 1) / static_cast<double>(sysconf(_SC_CLK_TCK));
    return Seconds(std::max(0.0, since_boot - began));
}

}  // namespace afterglow
