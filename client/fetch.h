#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "client/http.h"
#include "client/job.h"
#include "client/options.h"

namespace afterglow::client {

/// "frame_0012.png" for frame 12 and ending "png"; more digits only past 9999.
std::string frame_file_name(int frame, const std::string& ending);

/// Fetches pictures of finished frames into one folder, each file whole or not at all. A file whose length is
/// that of the server's picture is taken as complete and left alone, unless the job has been edited.
class FrameFetcher {
  public:
    /// The connection must outlive the fetcher. The folder is made when the first file is written.
    FrameFetcher(HttpConnection& connection, std::filesystem::path folder, PictureType type);

    /// The files of one frame, fetched or already there. Errors: local_failure; no_server, also where the
    /// server names no path for a picture; not_found.
    std::vector<std::filesystem::path> fetch(const FrameImage& image);

    [[nodiscard]] int fetched() const { return fetched_; }
    [[nodiscard]] int present() const { return present_; }

  private:
    std::filesystem::path fetch_file(const FrameImage& image, const std::string& ending,
                                     const std::string& path);

    HttpConnection& connection_;
    std::filesystem::path folder_;
    PictureType type_;
    int fetched_ = 0;
    int present_ = 0;
};

/// A job's finished frames, in order. Errors: not_found, no_server.
std::vector<FrameImage> finished_frames(HttpConnection& connection, const std::string& job_id);

}  // namespace afterglow::client
