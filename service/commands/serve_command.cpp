#include "service/commands/serve_command.h"

#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <iostream>
#include <mutex>
#include <optional>
#include <system_error>

#include "service/api/service.h"
#include "solver/base/error.h"

namespace afterglow {

namespace {

/// A folder of its own in the system's place for such, removed with everything in it at the end.
class TemporaryFolder {
  public:
    TemporaryFolder() {
        std::string name = (std::filesystem::temp_directory_path() / "afterglow-XXXXXX").string();
        if (::mkdtemp(name.data()) == nullptr)
            throw Error(ErrorKind::io, name, "a temporary folder cannot be made");
        path_ = name;
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

/// Until a stop is requested or the server has ended by itself.
void wait_until_over(const HttpServer& server, const std::stop_token& stop) {
    std::mutex mutex;
    std::condition_variable_any never;
    std::unique_lock lock(mutex);
    while (!stop.stop_requested() && server.is_running())
        never.wait_for(lock, stop, std::chrono::seconds(1), [] { return false; });
}

std::string shown_address(const std::string& address) {
    return address.find(':') == std::string::npos ? address : "[" + address + "]";
}

}  // namespace

int serve(const ServeConfig& config, const std::stop_token& stop) {
    std::optional<TemporaryFolder> temporary;
    if (config.data_folder.empty()) temporary.emplace();
    Service service({temporary ? temporary->path() : config.data_folder, config.threads, config.max_resident,
                     config.limits});
    HttpServer server(service.router(), {config.address, config.port, config.max_connections,
                                         config.limits.upload_bytes, config.access_log});
    const int port = server.start();
    std::cout << "listening on http://" << shown_address(config.address) << ":" << port << std::endl;

    wait_until_over(server, stop);
    // First the jobs, so that every open stream is told the end and finishes by itself.
    service.stop();
    server.stop();
    if (!stop.stop_requested()) throw Error(ErrorKind::io, config.address, "the server stopped listening");
    return 0;
}

}  // namespace afterglow
