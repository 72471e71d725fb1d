#include "client/fetch.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <system_error>
#include <utility>

#include "client/file.h"
#include "client/problem.h"
#include "client/text.h"

namespace afterglow::client {

std::string frame_file_name(int frame, const std::string& ending) {
    std::array<char, 32> stem{};
    std::snprintf(stem.data(), stem.size(), "frame_%04d.", frame);
    return stem.data() + ending;
}

FrameFetcher::FrameFetcher(HttpConnection& connection, std::filesystem::path folder, PictureType type)
    : connection_(connection), folder_(std::move(folder)), type_(type) {}

std::vector<std::filesystem::path> FrameFetcher::fetch(const FrameImage& image) {
    std::vector<std::filesystem::path> files;
    if (type_ != PictureType::exr) files.push_back(fetch_file(image, "png", image.png));
    if (type_ != PictureType::png) files.push_back(fetch_file(image, "exr", image.exr));
    return files;
}

std::filesystem::path FrameFetcher::fetch_file(const FrameImage& image, const std::string& ending,
                                               const std::string& path) {
    // Only a path on this server: what it sends must not make us ask another.
    if (!path.starts_with('/') || path.starts_with("//"))
        throw ClientError(ExitCode::no_server, connection_.server(),
                          "names no path for the " + ending + " of frame " + std::to_string(image.frame));
    auto file = folder_ / frame_file_name(image.frame, ending);
    std::error_code missing;
    const auto size = std::filesystem::file_size(file, missing);
    // An edit may leave a picture as long as it was.
    if (!missing && image.job_revision == 0 &&
        connection_.head(path).header("Content-Length") == std::to_string(size)) {
        ++present_;
        return file;
    }
    const HttpReply reply = connection_.get(path);
    if (reply.status != 200) throw error_of(reply, connection_.server(), NotFound::not_found);
    write_output(file, reply.body);
    ++fetched_;
    return file;
}

std::vector<FrameImage> finished_frames(HttpConnection& connection, const std::string& job_id) {
    const Json body =
        json_reply(connection.get("/v1/jobs/" + percent_encode(job_id) + "/frames"), connection.server());
    std::vector<FrameImage> finished;
    const Json& frames = find_member(body, "frames");
    if (!frames.is_array())
        throw ClientError(ExitCode::no_server, connection.server(), "sent a reply without \"frames\"");
    for (const Json& entry : frames) {
        FrameImage image = read_frame_image(entry, connection.server());
        if (image.stage == FrameImage::Stage::final) finished.push_back(std::move(image));
    }
    std::sort(finished.begin(), finished.end(),
              [](const FrameImage& a, const FrameImage& b) { return a.frame < b.frame; });
    return finished;
}

}  // namespace afterglow::client
