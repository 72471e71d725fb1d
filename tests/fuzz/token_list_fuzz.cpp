#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "service/http/access_token.h"
#include "solver/base/error.h"

// Any text is a list of tokens with limits in range, or an Error that names the line; an empty token finds
// nobody.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    try {
        const auto tokens = afterglow::TokenList::read(text, "tokens");
        if (tokens.size() == 0 || tokens.find("")) std::abort();
        if (const auto client = tokens.find(text.substr(0, text.find('\n'))))
            for (const auto& [name, field] : afterglow::quota_fields)
                if (client->quota.*field < 0) std::abort();
    } catch (const afterglow::Error& e) {
        if (!e.place().starts_with("tokens")) std::abort();
    }
    return 0;
}
