#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "service/base/identity.h"
#include "service/http/access_token.h"
#include "service/http/gate.h"
#include "solver/base/error.h"

namespace afterglow {
namespace {

using testing::HasSubstr;

constexpr const char* viewer = "viewer-token-0123456789";
constexpr const char* submitter = "submitter-token-0123456789";

std::string file_text() {
    return "# who\n\nann viewer " + std::string(viewer) +
           "  # may look\nbob submitter sha256:" + sha256(submitter) + " jobs=3 bytes=1000\n";
}

TEST(TokenList, KnowsItsTokensAndNoOthers) {
    const TokenList list = TokenList::read(file_text(), "tokens");
    EXPECT_EQ(list.size(), 2U);
    EXPECT_EQ(list.find(viewer)->name, "ann");
    EXPECT_EQ(list.find(viewer)->role, Role::viewer);
    const Client bob = list.find(submitter).value();
    EXPECT_EQ(bob.quota.jobs, 3);
    EXPECT_EQ(bob.quota.bytes, 1000);
    EXPECT_EQ(bob.quota.streams, Quota::unlimited);
    for (const std::string& wrong : {std::string(), std::string("viewer-token-012345678"), sha256(submitter)})
        EXPECT_FALSE(list.find(wrong)) << wrong;
}

TEST(TokenList, ALineThatMakesNoSenseIsNamed) {
    for (const char* line : {"ann", "ann viewer", "ann king 0123456789abcdef", "ann viewer short",
                             "ann viewer sha256:12", "ann viewer 0123456789abcdef jobs=x",
                             "ann viewer 0123456789abcdef cars=3", "ann viewer 0123456789abcdef jobs"}) {
        try {
            TokenList::read("# first\n" + std::string(line) + "\n", "tokens");
            FAIL() << line;
        } catch (const Error& e) {
            EXPECT_EQ(e.place(), "tokens:2");
        }
    }
    EXPECT_THROW(TokenList::read("# nobody\n", "tokens"), Error);
}

class GateTest : public testing::Test {
  protected:
    /// The status of the refusal; 0: admitted.
    int ask(const std::string& method, const std::string& path, std::map<std::string, std::string> headers) {
        headers.emplace("host", "127.0.0.1:8080");
        Request request{method, path, {}, std::move(headers), ""};
        const auto refusal = gate_(request);
        client_ = request.client;
        return refusal ? refusal->status : 0;
    }
    void use_tokens() {
        gate_ = make_gate({{}, std::make_shared<const TokenList>(TokenList::read(file_text(), "tokens"))});
    }
    static std::map<std::string, std::string> bearer(const std::string& token) {
        return {{"authorization", "Bearer " + token}};
    }

    Gate gate_ = make_gate({{"Render.Example"}, nullptr});
    Client client_;
};

TEST_F(GateTest, OnlyKnownNamesAreAnswered) {
    for (const char* host :
         {"localhost", "LOCALHOST:8080", "127.0.0.1", "[::1]:8080", "10.1.2.3:80", "render.example:443"})
        EXPECT_EQ(ask("GET", "/healthz", {{"host", host}}), 0) << host;
    for (const char* host : {"evil.example", "127.0.0.1.evil.example", "", "[", "localhost.evil.example:80"})
        EXPECT_EQ(ask("GET", "/healthz", {{"host", host}}), 421) << host;
}

TEST_F(GateTest, PagesOfOtherSitesAreRefused) {
    EXPECT_EQ(ask("POST", "/v1/jobs", {{"origin", "http://127.0.0.1:8080"}}), 0);
    for (const char* origin : {"http://evil.example", "null", "http://127.0.0.1:8081", "http://127.0.0.1"})
        EXPECT_EQ(ask("POST", "/v1/jobs", {{"origin", origin}}), 403) << origin;
    EXPECT_EQ(ask("GET", "/v1/jobs", {{"sec-fetch-site", "cross-site"}}), 403);
    EXPECT_EQ(ask("GET", "/", {{"sec-fetch-site", "cross-site"}, {"sec-fetch-mode", "navigate"}}), 0);
    EXPECT_EQ(ask("POST", "/v1/jobs", {{"sec-fetch-site", "cross-site"}, {"sec-fetch-mode", "navigate"}}),
              403);
    EXPECT_EQ(ask("GET", "/v1/jobs", {{"sec-fetch-site", "same-origin"}}), 0);
}

TEST_F(GateTest, WithoutTokensEverybodyIsTheLocalClient) {
    EXPECT_EQ(ask("DELETE", "/v1/jobs/x", {}), 0);
    EXPECT_EQ(client_.role, Role::admin);
}

TEST_F(GateTest, WithTokensEachMayDoWhatItsRoleSays) {
    use_tokens();
    EXPECT_EQ(ask("GET", "/healthz", {}), 0);
    EXPECT_EQ(ask("GET", "/", {}), 0);
    for (const char* path : {"/v1/jobs", "/metrics", "/v1/openapi.json"})
        EXPECT_EQ(ask("GET", path, {}), 401);
    EXPECT_EQ(ask("POST", "/", {}), 401);
    EXPECT_EQ(ask("GET", "/v1/jobs", bearer("wrong-token-0123456789")), 401);
    EXPECT_EQ(ask("GET", "/v1/jobs", bearer(viewer)), 0);
    EXPECT_EQ(client_.name, "ann");
    EXPECT_EQ(ask("POST", "/v1/jobs", bearer(viewer)), 403);
    EXPECT_EQ(ask("DELETE", "/v1/jobs/x", bearer(viewer)), 403);
    EXPECT_EQ(ask("POST", "/v1/jobs", bearer(submitter)), 0);
    EXPECT_EQ(ask("GET", "/v1/jobs", {{"cookie", "a=b; afterglow_token=" + std::string(viewer) + "; c=d"}}),
              0);
    EXPECT_EQ(ask("GET", "/v1/jobs", {{"cookie", "not_afterglow_token=" + std::string(viewer)}}), 401);
}

TEST(Loopback, IsToldFromTheRest) {
    for (const char* address : {"127.0.0.1", "127.9.8.7", "::1", "localhost"})
        EXPECT_TRUE(is_loopback(address));
    for (const char* address : {"0.0.0.0", "::", "10.0.0.1", "render.example", "128.0.0.1"})
        EXPECT_FALSE(is_loopback(address));
}

}  // namespace
}  // namespace afterglow
