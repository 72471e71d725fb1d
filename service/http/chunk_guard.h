#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace afterglow {

struct ChunkLimits {
    std::size_t line_bytes = 256;                          ///< one chunk's size with its extensions
    std::size_t extension_bytes = std::size_t{16} << 10U;  ///< extensions of all chunks
    std::size_t trailer_bytes = std::size_t{8} << 10U;     ///< fields after the last chunk
};

/// Looks at a chunked body (RFC 9112 §7.1) as it passes, since the library reads its lines without an end.
/// Thread-safety: none.
class ChunkGuard {
  public:
    explicit ChunkGuard(const ChunkLimits& limits = {}) : limits_(limits) {}

    /// The next bytes of the body. False, for good, once a limit is passed or what should be a chunk is none.
    bool take(std::string_view bytes);

  private:
    enum class Part { size, extension, data, trailer, refused };
    bool take_framing(char byte);
    bool take_size(char byte);
    void begin_chunk();

    ChunkLimits limits_;
    Part part_ = Part::size;
    std::uint64_t size_ = 0;  ///< of the chunk
    std::uint64_t left_ = 0;  ///< of its data, with the line end behind it
    std::size_t line_bytes_ = 0;
    std::size_t extension_bytes_ = 0;
    std::size_t trailer_bytes_ = 0;
};

}  // namespace afterglow
