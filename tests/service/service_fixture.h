#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "client/http.h"
#include "client/json.h"
#include "tests/service/process.h"

namespace afterglow::test {

/// A folder that goes with its content.
class TemporaryFolder {
  public:
    TemporaryFolder();
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

/// What a client command ended with.
struct Outcome {
    int exit = -1;
    std::string out;
    std::string err;
};

/// Each test has a service of its own, on a free port and an empty folder.
class ServiceTest : public testing::Test {
  protected:
    void SetUp() override;
    /// Starts the server, again on the same folder where it ran before, at a new port.
    void start_server();

    /// Runs `afterglow` with these arguments to its end.
    Outcome afterglow(const std::vector<std::string>& arguments);
    /// Starts `afterglow` and leaves it running.
    std::unique_ptr<Process> start_afterglow(const std::vector<std::string>& arguments);
    /// Submits a scene of tests/data with further options and returns the job's id.
    std::string submit(const std::string& scene, const std::vector<std::string>& options);
    /// Uploads a scene of tests/data without the client program and returns its id; submits a job for one.
    /// Errors: std::exception where the server is gone or refuses.
    std::string upload(const std::string& scene);
    std::string submit_quickly(const std::string& scene, const std::string& settings);
    static std::string submit_quickly(const std::string& scene, const std::string& settings,
                                      client::HttpConnection& http);
    /// The job as the service shows it.
    client::Json job(const std::string& id);
    /// All events of an ended job from the first on, each {"event","id","data"} as `watch --json` writes
    /// them.
    std::vector<client::Json> all_events(const std::string& id);

    /// The final pictures of a job so far, as OpenEXR, by frame.
    std::map<int, std::string> finished(const std::string& id);

    /// Options of a job that is small, and of one that outlives any test.
    static std::vector<std::string> small(const std::string& frames);
    static std::vector<std::string> endless();

    TemporaryFolder folder_;
    std::string url_;
    client::Interrupt interrupt_;
    std::unique_ptr<client::HttpConnection> http_;
    std::unique_ptr<Process> server_;
};

/// A file of tests/data.
std::string data_file(const std::string& name);

/// The lines of a text, parsed as JSON each.
std::vector<client::Json> json_lines(const std::string& text);

}  // namespace afterglow::test
