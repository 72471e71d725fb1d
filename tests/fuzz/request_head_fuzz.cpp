#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "service/http/request_head.h"

// Any bytes are judged; what passes still passes when its ranges are taken out, and keeps one end.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    const auto length = afterglow::head_length(bytes);
    if (!length) return 0;
    const std::string_view head = bytes.substr(0, *length);
    if (afterglow::problem_of_head(head, {})) return 0;
    const std::string handed_on = afterglow::without_ranges(head);
    if (afterglow::head_length(handed_on) != handed_on.size()) std::abort();
    if (afterglow::problem_of_head(handed_on, {})) std::abort();
    return 0;
}
