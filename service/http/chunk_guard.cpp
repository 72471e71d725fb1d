#include "service/http/chunk_guard.h"

#include <algorithm>

namespace afterglow {

namespace {

int hex_digit(char byte) {
    if (byte >= '0' && byte <= '9') return byte - '0';
    if (byte >= 'a' && byte <= 'f') return byte - 'a' + 10;
    if (byte >= 'A' && byte <= 'F') return byte - 'A' + 10;
    return -1;
}

}  // namespace

bool ChunkGuard::take(std::string_view bytes) {
    while (!bytes.empty() && part_ != Part::refused) {
        if (part_ == Part::data) {
            const auto taken = std::min<std::uint64_t>(left_, bytes.size());
            bytes.remove_prefix(static_cast<std::size_t>(taken));
            left_ -= taken;
            if (left_ == 0) begin_chunk();
        } else {
            if (!take_framing(bytes.front())) part_ = Part::refused;
            bytes.remove_prefix(1);
        }
    }
    return part_ != Part::refused;
}

void ChunkGuard::begin_chunk() {
    part_ = Part::size;
    size_ = 0;
    line_bytes_ = 0;
}

/// A byte that is no data: of a chunk's first line, or behind the last chunk.
bool ChunkGuard::take_framing(char byte) {
    if (part_ == Part::trailer) return ++trailer_bytes_ <= limits_.trailer_bytes;
    if (++line_bytes_ > limits_.line_bytes) return false;
    if (byte == '\n') {
        constexpr std::uint64_t line_end = 2;
        part_ = size_ == 0 ? Part::trailer : Part::data;
        left_ = size_ + line_end;
        return line_bytes_ > 1;
    }
    if (part_ == Part::size) return take_size(byte);
    return ++extension_bytes_ <= limits_.extension_bytes;
}

bool ChunkGuard::take_size(char byte) {
    if (const int digit = hex_digit(byte); digit >= 0) {
        if (size_ >> 56U != 0) return false;
        size_ = size_ * 16 + static_cast<std::uint64_t>(digit);
        return true;
    }
    part_ = Part::extension;
    return line_bytes_ > 1 && (byte == ';' || byte == ' ' || byte == '\t' || byte == '\r');
}

}  // namespace afterglow
