#include "service/commands/serve_options.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "solver/base/error.h"

namespace afterglow {
namespace {

ServeConfig read(std::vector<const char*> arguments) {
    return std::get<ServeConfig>(read_serve_options(arguments));
}

TEST(ServeOptions, DefaultsAreThoseOfTheService) {
    const ServeConfig config = read({});
    EXPECT_EQ(config.address, "127.0.0.1");
    EXPECT_EQ(config.port, 8080);
    EXPECT_TRUE(config.data_folder.empty());
    EXPECT_EQ(config.access_log, AccessLog::off);
}

TEST(ServeOptions, EveryOptionReachesItsField) {
    const ServeConfig config =
        read({"--listen", "0.0.0.0:0", "--data", "d", "--threads", "3", "--resident-jobs", "2",
              "--connections", "9", "--access-log", "--keep-frames-for", "7d", "--keep-at-most", "20GB",
              "--keep-uploads-for", "30d"});
    EXPECT_EQ(config.address, "0.0.0.0");
    EXPECT_EQ(config.port, 0);
    EXPECT_EQ(config.data_folder, "d");
    EXPECT_EQ(config.threads, 3);
    EXPECT_EQ(config.max_resident, 2U);
    EXPECT_EQ(config.max_connections, 9U);
    EXPECT_EQ(config.retention.keep_for, std::chrono::hours(7 * 24));
    EXPECT_EQ(config.retention.keep_at_most, 20'000'000'000U);
    EXPECT_EQ(config.retention.keep_uploads_for, std::chrono::hours(30 * 24));
    EXPECT_EQ(config.access_log, AccessLog::on);
}

TEST(ServeOptions, AddressesMayBeNamesOrBracketed) {
    EXPECT_EQ(read({"--listen", "localhost:80"}).address, "localhost");
    const ServeConfig six = read({"--listen", "[::1]:65535"});
    EXPECT_EQ(six.address, "::1");
    EXPECT_EQ(six.port, 65535);
}

TEST(ServeOptions, FailuresNameTheOption) {
    for (const auto& [option, value] :
         std::vector<std::pair<const char*, const char*>>{{"--listen", ""},
                                                          {"--listen", "8080"},
                                                          {"--listen", ":8080"},
                                                          {"--listen", "a:65536"},
                                                          {"--listen", "a:-1"},
                                                          {"--listen", "a:"},
                                                          {"--listen", "::1:80"},
                                                          {"--listen", "[]:80"},
                                                          {"--data", ""},
                                                          {"--keep-uploads-for", "9m"},
                                                          {"--keep-uploads-for", "soon"},
                                                          {"--threads", "0"},
                                                          {"--connections", "many"},
                                                          {"--resident-jobs", "0"}}) {
        try {
            read({option, value});
            ADD_FAILURE() << "took " << option << " " << value;
        } catch (const Error& e) {
            EXPECT_EQ(e.kind(), ErrorKind::invalid_input);
            EXPECT_EQ(e.place(), option) << value;
        }
    }
    EXPECT_THROW(read({"extra"}), Error);
}

}  // namespace
}  // namespace afterglow
