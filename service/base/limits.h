#pragma once

#include <cstddef>
#include <cstdint>

namespace afterglow {

/// How much a client may ask for.
struct Limits {
    std::size_t upload_bytes = std::size_t{256} << 20U;   ///< largest scene
    std::size_t scene_files = 1000;                       ///< files of one scene
    std::uint64_t blob_bytes = std::uint64_t{4} << 30U;   ///< kept in blobs; the oldest go past it
    std::size_t document_bytes = std::size_t{64} << 20U;  ///< largest paths document
    std::size_t request_bytes = std::size_t{1} << 20U;    ///< largest job request
    std::int64_t pixels = std::int64_t{4096} * 4096;      ///< width × height of a picture
    int frames = 100'000;                                 ///< frames of one job
};

}  // namespace afterglow
