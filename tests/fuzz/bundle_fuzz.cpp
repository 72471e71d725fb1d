#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "solver/base/error.h"
#include "solver/scene/bundle.h"

// Any bytes are a bundle that packs to a fixed point, or an Error. Any line of them is a reference that leads
// to one of its files, or an Error.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    static_cast<void>(afterglow::is_plain_path(bytes));
    try {
        const afterglow::Bundle bundle = afterglow::unpack(bytes, "fuzz");
        const std::string packed = afterglow::pack(bundle);
        const afterglow::Bundle again = afterglow::unpack(packed, "fuzz");
        if (again.main != bundle.main || again.files != bundle.files) std::abort();
        static_cast<void>(afterglow::resources_of(bundle)(std::string(bundle.files.begin()->second)));
    } catch (const afterglow::Error&) {
        // The one way out that is allowed.
    }
    return 0;
}
