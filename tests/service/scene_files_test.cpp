#include "tests/service/service_fixture.h"

namespace afterglow::test {
namespace {

using testing::HasSubstr;

using SceneFiles = ServiceTest;

TEST_F(SceneFiles, AreSentAlongAndOnlyOnce) {
    const std::string scene = data_file("examples/study.json");
    const std::vector<std::string> submit{"submit", "--json", scene,       "--frames", "0",
                                          "--size", "32x24",  "--quality", "draft"};
    const Outcome first = afterglow(submit);
    ASSERT_EQ(first.exit, 0) << first.err;
    const auto blobs = folder_.path() / "data/blobs";
    const auto count = [&] {
        return std::distance(std::filesystem::directory_iterator(blobs),
                             std::filesystem::directory_iterator());
    };
    EXPECT_EQ(count(), 3);
    const Outcome again = afterglow(submit);
    ASSERT_EQ(again.exit, 0) << again.err;
    EXPECT_EQ(count(), 3);
    EXPECT_EQ(client::Json::parse(first.out).at("scene"), client::Json::parse(again.out).at("scene"));
    EXPECT_EQ(afterglow({"watch", client::Json::parse(first.out).at("id").get<std::string>()}).exit, 0);
}

TEST_F(SceneFiles, OneThatIsMissingIsNamed) {
    const auto copy = folder_.path() / "study.json";
    std::filesystem::copy_file(data_file("examples/study.json"), copy);
    const Outcome alone = afterglow({"submit", copy.string()});
    EXPECT_EQ(alone.exit, 2);
    EXPECT_THAT(alone.err, HasSubstr("chair.obj"));
    std::filesystem::copy_file(data_file("examples/chair.obj"), folder_.path() / "chair.obj");
    const Outcome without_library = afterglow({"submit", copy.string()});
    EXPECT_EQ(without_library.exit, 2);
    EXPECT_THAT(without_library.err, HasSubstr("chair.mtl"));
}

}  // namespace
}  // namespace afterglow::test
