#include "client/completion.h"

#include <cstdlib>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>

namespace afterglow::client {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Not;

/// What bash offers for the last of these words.
std::vector<std::string> offered(const std::string& words) {
    const std::string folder = testing::TempDir();
    std::ofstream(folder + "completion.sh")
        << bash_completion(command_syntax()) << "COMP_WORDS=(" << words
        << ")\nCOMP_CWORD=$((${#COMP_WORDS[@]} - 1))\n_afterglow\nprintf '%s\\n' \"${COMPREPLY[@]}\"\n";
    EXPECT_EQ(std::system(("bash " + folder + "completion.sh >" + folder + "offered").c_str()), 0);
    std::ifstream file(folder + "offered");
    std::vector<std::string> lines;
    for (std::string line; std::getline(file, line);)
        if (!line.empty()) lines.push_back(line);
    return lines;
}

TEST(Completion, OffersCommands) {
    EXPECT_THAT(offered("afterglow wa"), ElementsAre("watch"));
    EXPECT_THAT(offered("afterglow ''"), Contains("doctor"));
}

TEST(Completion, OffersTheOptionsOfTheCommandInHand) {
    EXPECT_THAT(offered("afterglow submit --qu"), ElementsAre("--quality"));
    EXPECT_THAT(offered("afterglow ls --"), Contains("--server"));
    EXPECT_THAT(offered("afterglow ls --"), Not(Contains("--quality")));
    EXPECT_THAT(offered("afterglow rm j1 --d"), ElementsAre("--dry-run"));
}

TEST(Completion, OffersKindsOfEditsFirstAndThenTheirOptions) {
    EXPECT_THAT(offered("afterglow edit li"), ElementsAre("light"));
    EXPECT_THAT(offered("afterglow edit light j1 lamp --sc"), ElementsAre("--scale"));
    EXPECT_THAT(offered("afterglow edit move j1 chair cha"), IsEmpty());
}

TEST(Completion, LeavesFileNamesToTheShell) {
    EXPECT_THAT(offered("afterglow submit roo"), IsEmpty());
}

}  // namespace
}  // namespace afterglow::client
