#include "solver/base/other_pictures.h"

#include <dlfcn.h>

#include "solver/base/error.h"

namespace afterglow {

namespace {

/// The module's function, or null and why.
struct Module {
    DecodeOtherPicture* decode = nullptr;
    std::string failure;
};

Module load_module() {
    // Found beside the program, whose run path says so. It stays loaded to the end.
    void* const handle = dlopen("afterglow_other_pictures.so", RTLD_NOW | RTLD_LOCAL);
    if (handle == nullptr) return {nullptr, dlerror()};
    auto* const symbol = dlsym(handle, "afterglow_decode_other_picture");
    if (symbol == nullptr) return {nullptr, dlerror()};
    return {reinterpret_cast<DecodeOtherPicture*>(symbol), ""};
}

}  // namespace

Bytes8 decode_texture(std::string_view bytes, const std::string& place) {
    if (bytes.starts_with("\x89PNG") || bytes.starts_with("\xff\xd8")) return decode_picture(bytes, place);
    static const Module module = load_module();
    if (module.decode == nullptr)
        throw Error(ErrorKind::unsupported, place,
                    "neither PNG nor JPEG, and other formats cannot be read here: " + module.failure);
    Bytes8 out;
    switch (module.decode(bytes, out)) {
        case DecodeFailure::none:
            return out;
        case DecodeFailure::unreadable:
            throw Error(ErrorKind::invalid_input, place, "not a readable picture");
        case DecodeFailure::too_large:
            throw Error(ErrorKind::too_large, place,
                        "the picture is past the limit of 16384 pixels a side and 64 Mi in all");
        case DecodeFailure::damaged:
            break;
    }
    throw Error(ErrorKind::invalid_input, place, "the picture is damaged");
}

}  // namespace afterglow
