#include "client/file.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <system_error>
#include <unistd.h>

#include "client/error.h"

namespace afterglow::client {

namespace fs = std::filesystem;

std::string read_input(const fs::path& path) {
    constexpr std::uintmax_t max_bytes = std::uintmax_t{2} << 30U;
    const auto fail = [&](const std::string& message) {
        throw ClientError(ExitCode::bad_input, path.string(), message);
    };
    std::error_code error;
    const auto status = fs::status(path, error);
    if (!fs::exists(status)) fail("no such file");
    if (!fs::is_regular_file(status)) fail("is not a regular file");
    const auto size = fs::file_size(path, error);
    if (error) fail(error.message());
    if (size > max_bytes) fail("is larger than 2 GiB");
    std::string content(static_cast<std::size_t>(size), '\0');
    std::ifstream in(path, std::ios::binary);
    in.read(content.data(), static_cast<std::streamsize>(content.size()));
    if (!in || static_cast<std::uintmax_t>(in.gcount()) != size) fail("cannot be read");
    return content;
}

void write_output(const fs::path& path, std::string_view content) {
    std::error_code ignored;
    std::error_code error;
    if (path.has_parent_path()) fs::create_directories(path.parent_path(), error);
    if (error) throw ClientError(ExitCode::local_failure, path.parent_path().string(), error.message());
    const fs::path temporary = path.string() + ".part" + std::to_string(::getpid());
    {
        std::ofstream out(temporary, std::ios::binary | std::ios::trunc);
        out.write(content.data(), static_cast<std::streamsize>(content.size()));
        out.flush();
        if (!out) {
            fs::remove(temporary, ignored);
            throw ClientError(ExitCode::local_failure, path.string(), "cannot be written");
        }
    }
    fs::rename(temporary, path, error);
    if (error) {
        fs::remove(temporary, ignored);
        throw ClientError(ExitCode::local_failure, path.string(), error.message());
    }
}

std::string scene_content_type(const fs::path& path) {
    std::string ending = path.extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (ending == ".glb") return "model/gltf-binary";
    if (ending == ".gltf") return "model/gltf+json";
    if (ending == ".obj") return "model/obj";
    if (ending == ".json") return "application/json";
    throw ClientError(ExitCode::bad_input, path.string(), "is none of .glb, .gltf, .obj, .json");
}

}  // namespace afterglow::client
