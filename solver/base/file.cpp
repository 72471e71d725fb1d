#include "solver/base/file.h"

#include <cstdio>
#include <fstream>
#include <system_error>
#include <unistd.h>

#include "solver/base/error.h"

namespace afterglow {

std::string read_file(const std::filesystem::path& path, std::size_t max_bytes) {
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    if (!std::filesystem::exists(status)) throw Error(ErrorKind::not_found, path.string(), "no such file");
    if (!std::filesystem::is_regular_file(status))
        throw Error(ErrorKind::io, path.string(), "is not a regular file");
    const auto size = std::filesystem::file_size(path, error);
    if (error) throw Error(ErrorKind::io, path.string(), error.message());
    if (size > max_bytes)
        throw Error(
            ErrorKind::too_large, path.string(),
            "has " + std::to_string(size) + " bytes, more than the limit of " + std::to_string(max_bytes));
    std::string content(static_cast<std::size_t>(size), '\0');
    std::ifstream in(path, std::ios::binary);
    if (!in.read(content.data(), static_cast<std::streamsize>(content.size())) && size > 0)
        throw Error(ErrorKind::io, path.string(), "cannot be read");
    return content;
}

void write_file(const std::filesystem::path& path, std::string_view content) {
    const std::filesystem::path temporary = path.string() + ".part" + std::to_string(::getpid());
    std::error_code ignored;
    {
        std::ofstream out(temporary, std::ios::binary | std::ios::trunc);
        out.write(content.data(), static_cast<std::streamsize>(content.size()));
        out.flush();
        if (!out) {
            std::filesystem::remove(temporary, ignored);
            throw Error(ErrorKind::io, path.string(), "cannot be written");
        }
    }
    std::error_code error;
    std::filesystem::rename(temporary, path, error);
    if (error) {
        std::filesystem::remove(temporary, ignored);
        throw Error(ErrorKind::io, path.string(), error.message());
    }
}

}  // namespace afterglow
