#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>

#include <gtest/gtest.h>

#include "service/api/service.h"
#include "tests/unit/service/fake_solver.h"

// What openapi.json promises against the routes that there are and the problems that the sources name.

namespace afterglow {
namespace {

class OpenapiTest : public testing::Test {
  protected:
    Json document() const {
        const Reply reply = service_.router().handle({"GET", "/v1/openapi.json", {}, {}, ""});
        EXPECT_EQ(reply.content_type, "application/json");
        return parse_json(reply.body, "openapi.json");
    }

    ScratchFolder folder_;
    FakeSolver solver_;
    Service service_{{folder_.path(), 1, 4, {}}, {fake_scene, solver_.factory()}};
};

/// METHOD and path with its parameters as the router writes them.
std::set<std::string> described(const Json& document) {
    std::set<std::string> all;
    const std::regex parameter(R"(\{[^}]*\})");
    for (const auto& [path, item] : document.at("paths").items())
        for (const char* method : {"get", "put", "post", "delete", "patch", "options", "head", "trace"}) {
            if (!item.contains(method)) continue;
            std::string name = method;
            for (char& c : name) c = static_cast<char>(c - 'a' + 'A');
            all.insert(name + " " + std::regex_replace(path, parameter, "{}"));
        }
    return all;
}

TEST_F(OpenapiTest, EveryRouteIsDescribedAndNothingElse) {
    std::set<std::string> routes;
    for (const auto& [method, pattern] : service_.router().routes()) routes.insert(method + " " + pattern);
    EXPECT_GT(routes.size(), 15U);
    EXPECT_EQ(described(document()), routes);
}

TEST_F(OpenapiTest, IsToldOnlyOnceToWhoHasIt) {
    const Reply first = service_.router().handle({"GET", "/v1/openapi.json", {}, {}, ""});
    std::string tag;
    for (const auto& [name, value] : first.headers)
        if (name == "ETag") tag = value;
    const Reply again =
        service_.router().handle({"GET", "/v1/openapi.json", {}, {{"if-none-match", tag}}, ""});
    EXPECT_EQ(again.status, 304);
    EXPECT_EQ(again.body, "");
}

/// `{404, "not_found"` and its like: a status with the code that goes with it.
TEST_F(OpenapiTest, EveryCodeOfAProblemIsNamed) {
    const auto codes =
        document().at("components").at("schemas").at("ProblemCode").at("enum").get<std::set<std::string>>();
    const std::regex problem(R"re([45][0-9][0-9],\s*"([a-z_]+)")re");
    std::set<std::string> used;
    for (const auto& entry :
         std::filesystem::recursive_directory_iterator(std::string(AFTERGLOW_SOURCE_DIR) + "/service")) {
        if (entry.path().extension() != ".cpp") continue;
        std::ifstream file(entry.path());
        const std::string text{std::istreambuf_iterator<char>(file), {}};
        for (std::sregex_iterator at(text.begin(), text.end(), problem), end; at != end; ++at)
            used.insert((*at)[1]);
    }
    EXPECT_GT(used.size(), 20U);
    for (const std::string& code : used) EXPECT_TRUE(codes.contains(code)) << code;
}

}  // namespace
}  // namespace afterglow
