// Any text at all, read as a scene in Afterglow's own format, must give a world or an Error; never a crash.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "solver/scene/json_reader.h"
#include "solver/scene/load.h"
#include "solver/scene/simplify.h"
#include "solver/scene/world.h"

namespace {

/// Every model that a document refers to: two small nodes of two materials.
std::string other_file(const std::string& uri) {
    // A picture would go to a library that is not ours to test.
    if (!uri.ends_with(".mtl") && !uri.ends_with(".obj"))
        throw afterglow::Error(afterglow::ErrorKind::not_found, uri, "no such file");
    if (uri.ends_with(".mtl")) return "newmtl a\nKd 1 0 0\nnewmtl b\nKe 1 1 1\n";
    return "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\ng one\nusemtl a\nf 1 2 3\ng two\nusemtl b\nf 1 3 2\n";
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    try {
        auto scene = afterglow::read_json_scene(text, "fuzz.json", other_file, {});
        afterglow::validate(scene);
        afterglow::simplify_tracks(scene.tracks, {});
        const auto world = afterglow::assemble(scene);
        for (afterglow::Index m = 0; m < world.materials.size(); ++m)
            static_cast<void>(afterglow::material_at(world, m, world.duration_s / 2));
    } catch (const afterglow::Error&) {
        // The one way out that is allowed.
    }
    return 0;
}
