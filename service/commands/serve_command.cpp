#include "service/commands/serve_command.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <csignal>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <mutex>
#include <optional>
#include <system_error>
#include <utility>

#include "service/api/service.h"
#include "service/http/gate.h"
#include "service/store/data_lock.h"
#include "solver/base/error.h"
#include "solver/base/file.h"

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

Gate gate_of(const ServeConfig& config) {
    GateConfig gate{config.hosts, nullptr};
    if (!config.token_file.empty()) {
        const std::string place = config.token_file.string();
        gate.tokens = std::make_shared<const TokenList>(TokenList::read(read_file(place), place));
    } else if (!is_loopback(config.address)) {
        throw Error(ErrorKind::invalid_input, "--listen",
                    "others can reach " + config.address + ", so --token-file is needed");
    }
    return make_gate(std::move(gate));
}

}  // namespace

int serve(const ServeConfig& config, const std::stop_token& stop) {
    // Where files may not grow further, writing fails like on a full disk instead of ending the process.
    std::signal(SIGXFSZ, SIG_IGN);
    Gate gate = gate_of(config);
    std::optional<TemporaryFolder> temporary;
    if (config.data_folder.empty()) temporary.emplace();
    const std::filesystem::path data = temporary ? temporary->path() : config.data_folder;
    const DataLock lock(data);
    // Without a folder of its own there is nothing to come back to.
    const auto at_stop = temporary ? ServiceConfig::AtStop::cancel : ServiceConfig::AtStop::keep;
    Service service({data,
                     config.threads,
                     config.max_resident,
                     config.limits,
                     at_stop,
                     config.retention,
                     {},
                     config.job_memory});
    HttpServerConfig http{config.address, config.port, config.max_connections, config.limits.upload_bytes,
                          config.access_log};
    http.max_streams = std::max<std::size_t>(config.max_connections * 3 / 4, 1);
    http.gate = std::move(gate);
    http.body_check = service.body_check();
    HttpServer server(service.router(), std::move(http));
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
