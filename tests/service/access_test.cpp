#include <fstream>

#include "tests/service/service_fixture.h"

namespace afterglow::test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

TEST_F(ServiceTest, ASecondServerIsToldWhoHoldsTheFolder) {
    Process second({AFTERGLOW_BIN_DIR "/afterglowd", "serve", "--listen", "127.0.0.1:0", "--data",
                    (folder_.path() / "data").string()});
    EXPECT_EQ(second.wait(), 1);
    EXPECT_THAT(second.err(), HasSubstr("in use by process "));
    EXPECT_EQ(second.out(), "");
}

TEST_F(ServiceTest, AServerThatOthersCanReachNeedsTokens) {
    const std::vector<std::string> serve{AFTERGLOW_BIN_DIR "/afterglowd", "serve", "--listen", "0.0.0.0:0"};
    Process open(serve);
    EXPECT_EQ(open.wait(), 2);
    EXPECT_THAT(open.err(), HasSubstr("--token-file"));

    const std::string file = (folder_.path() / "tokens").string();
    std::ofstream(file) << "ann submitter a-token-that-is-long\n";
    std::vector<std::string> guarded = serve;
    guarded.insert(guarded.end(), {"--token-file", file});
    Process closed(guarded);
    const auto is_ready = [](const std::string& out) { return out.find('\n') != std::string::npos; };
    ASSERT_TRUE(closed.wait_for_output(is_ready)) << closed.err();
    const std::string out = closed.out();
    const std::string port = out.substr(out.rfind(':') + 1);
    client::HttpConnection http("http://127.0.0.1:" + port.substr(0, port.size() - 1), interrupt_);
    EXPECT_EQ(http.get("/healthz").status, 200);
    EXPECT_EQ(http.get("/v1/jobs").status, 401);
    EXPECT_EQ(http.get("/v1/jobs", {{"Authorization", "Bearer a-token-that-is-long"}}).status, 200);
}

TEST_F(ServiceTest, OtherNamesAndSitesAreRefusedOnLoopbackToo) {
    EXPECT_EQ(http_->get("/v1/jobs", {{"Host", "evil.example"}}).status, 421);
    EXPECT_EQ(http_->get("/v1/jobs", {{"Origin", "http://evil.example"}}).status, 403);
    EXPECT_EQ(http_->get("/v1/jobs").status, 200);
}

}  // namespace
}  // namespace afterglow::test
