#include <fstream>

#include "tests/service/service_fixture.h"
#include "tests/support/picture_error.h"

namespace afterglow::test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

constexpr std::string_view png_signature = "\x89PNG\r\n\x1a\n";

class Pictures : public ServiceTest {
  protected:
    /// Renders some frames, each in a job of its own, and compares them with the reference.
    void compare(const std::string& scene, const std::vector<std::string>& frames, const std::string& quality,
                 double most) {
        std::vector<std::string> ids;
        for (const std::string& frame : frames)
            ids.push_back(
                submit(scene + ".glb", {"--frames", frame, "--size", "256x256", "--quality", quality}));
        for (std::size_t i = 0; i < frames.size(); ++i) {
            const Outcome watch = afterglow({"watch", ids[i]});
            ASSERT_EQ(watch.exit, 0) << watch.err;
            const auto out = folder_.path() / scene;
            ASSERT_EQ(afterglow({"get", ids[i], "-o", out.string(), "--type", "exr"}).exit, 0);
            const std::string number = std::string(4 - frames[i].size(), '0') + frames[i];
            const std::string reference = data_file("reference/" + scene + "_" + number);
            const auto error =
                picture_error(read_picture(out / ("frame_" + number + ".exr")),
                              read_picture(reference + "_1.exr"), read_picture(reference + "_2.exr"));
            RecordProperty(scene + "_" + number, std::to_string(error.relative_rmse));
            std::cout << scene << " frame " << frames[i] << ": relative RMSE " << error.relative_rmse << '\n';
            EXPECT_LT(error.relative_rmse, most) << scene << " frame " << frames[i];
        }
    }
    /// The data of the image event that made a frame final.
    client::Json final_image(const std::string& id, int frame) {
        for (const auto& event : all_events(id))
            if (event.at("event") == "image" && event.at("data").at("frame") == frame &&
                event.at("data").at("final") == true)
                return event.at("data");
        ADD_FAILURE() << "frame " << frame << " has no final picture";
        return nullptr;
    }
};

TEST_F(Pictures, CornellSlideIsNearThePathTracer) {
    compare("cornell-slide", {"0", "12", "36"}, "preview", 0.03);
}

TEST_F(Pictures, LivingRoomIsNearThePathTracer) {
    compare("living-room", {"0", "24", "72"}, "preview", 0.03);
}

TEST_F(Pictures, FinalOnesAreNearer) {
    compare("cornell-slide", {"12"}, "final", 0.010);
    compare("living-room", {"24"}, "final", 0.015);
}

TEST_F(Pictures, AddressesAreImmutableAndTagged) {
    const std::string id = submit("cornell-slide.glb", small("0"));
    ASSERT_EQ(afterglow({"watch", id}).exit, 0);
    const auto image = final_image(id, 0);
    for (const char* kind : {"url", "exr"}) {
        const std::string url = image.at(kind);
        const auto reply = http_->get(url);
        ASSERT_EQ(reply.status, 200) << url;
        EXPECT_THAT(reply.header("Cache-Control"), HasSubstr("immutable"));
        EXPECT_THAT(reply.header("ETag"), StartsWith("\"")) << "a strong tag";
        EXPECT_EQ(http_->head(url).header("Content-Length"), std::to_string(reply.body.size()));
        EXPECT_EQ(http_->get(url, {{"If-None-Match", reply.header("ETag")}}).status, 304);
        EXPECT_EQ(http_->get(url).body, reply.body);
    }
    EXPECT_THAT(http_->get(image.at("url")).body, StartsWith(std::string(png_signature)));
    EXPECT_THAT(http_->get(image.at("exr")).body, StartsWith("\x76\x2f\x31\x01"));
    EXPECT_EQ(http_->get("/v1/jobs/" + id + "/frames/0/image?rev=1").status, 410)
        << "preliminary pictures of a finished frame go";
    EXPECT_EQ(http_->get("/v1/jobs/" + id + "/frames/7/image").status, 404);
}

/// The bodies of the parts of a multipart stream (RFC 2046), each checked for its type and length.
std::vector<std::string> parts_of(const std::string& body, const std::string& boundary) {
    std::vector<std::string> parts;
    const std::string mark = "--" + boundary;
    for (auto at = body.find(mark); at != std::string::npos;) {
        at += mark.size();
        const auto head_end = body.find("\r\n\r\n", at);
        if (head_end == std::string::npos) break;
        const std::string head = body.substr(at, head_end - at);
        EXPECT_THAT(head, HasSubstr("Content-Type: image/png"));
        const auto next = body.find("\r\n" + mark, head_end + 4);
        parts.push_back(body.substr(head_end + 4, next - head_end - 4));
        at = next == std::string::npos ? next : next + 2;
    }
    return parts;
}

TEST_F(Pictures, TheLiveViewIsAStreamOfPngs) {
    const std::string id = submit("cornell-slide.glb", small("0-4"));
    std::string body;
    const auto reply = http_->stream("/v1/jobs/" + id + "/live", {}, [&](std::string_view bytes) {
        body += bytes;
        return client::StreamNext::more;
    });
    ASSERT_EQ(reply.status, 200);
    const std::string type = reply.header("Content-Type");
    ASSERT_THAT(type, StartsWith("multipart/x-mixed-replace"));
    ASSERT_THAT(type, HasSubstr("boundary="));
    const auto parts = parts_of(body, type.substr(type.find("boundary=") + 9));
    ASSERT_FALSE(parts.empty());
    for (const std::string& part : parts) EXPECT_THAT(part, StartsWith(std::string(png_signature)));
    // Newest wins, so how many there are depends on the moment; the last one is the job's last picture.
    EXPECT_EQ(parts.back(), http_->get(final_image(id, 4).at("url")).body);
    EXPECT_EQ(job(id).at("state"), "succeeded") << "the stream ends with the job";
}

}  // namespace
}  // namespace afterglow::test
