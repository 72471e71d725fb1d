#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "service/base/zip_archive.h"
#include "solver/base/error.h"

// Any bytes are an archive whose files keep to the limits, or an Error that names it; never a crash.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    constexpr afterglow::ZipLimits limits{8, 100'000};
    try {
        const auto files =
            afterglow::read_zip({reinterpret_cast<const char*>(data), size}, limits, "archive");
        std::size_t bytes = 0;
        for (const auto& [name, content] : files) bytes += content.size();
        if (files.size() > limits.files || bytes > limits.bytes) std::abort();
    } catch (const afterglow::Error& e) {
        if (!e.place().starts_with("archive")) std::abort();
    }
    return 0;
}
