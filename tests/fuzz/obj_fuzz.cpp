// Any text at all, read as an .obj that is its own library, must give a world or an Error; never a crash.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "solver/scene/load.h"
#include "solver/scene/obj_reader.h"
#include "solver/scene/world.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    // What follows a line of three dashes stands for every library the text refers to.
    const auto cut = text.find("\n---\n");
    const std::string other(cut == std::string_view::npos ? "" : text.substr(cut + 5));
    const auto fetch = [&](const std::string& file) {
        // A picture that is neither PNG nor JPEG would go to a library that is not ours to test.
        if (!file.ends_with(".mtl") && !other.starts_with("\x89PNG"))
            throw afterglow::Error(afterglow::ErrorKind::not_found, file, "no such file");
        return other;
    };
    try {
        auto scene = afterglow::read_obj(text.substr(0, cut), "fuzz.obj", fetch, {});
        scene.background = afterglow::Rgb(1);
        afterglow::validate(scene);
        static_cast<void>(afterglow::assemble(scene));
    } catch (const afterglow::Error&) {
        // The one way out that is allowed.
    }
    return 0;
}
