// Any text at all, applied as a paths document, must change a scene into a valid one, or leave it as it was
// and give an Error; never a crash.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "solver/scene/load.h"
#include "solver/scene/world.h"

namespace {

constexpr std::string_view scene_text = R"({"afterglow": 1,
    "materials": [{"name": "lamp", "emission": 5}, {"name": "wall"}],
    "nodes": [{"name": "a", "geometry": {"quad": {"size": [1, 1]}, "material": "lamp"}},
              {"name": "b", "parent": "a", "geometry": {"box": {"size": [1, 1, 1]}, "material": "wall"}},
              {"name": "c", "geometry": {"box": {"size": [1, 1, 1]}, "material": "wall"}}],
    "cameras": [{"name": "camera", "position": [0, 1, 5], "look_at": [0, 0, 0]}]})";

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const afterglow::Scene original =
        afterglow::read_scene(scene_text, afterglow::SceneFormat::json, "scene");
    afterglow::Scene scene = original;
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    try {
        afterglow::apply_paths(scene, text, "fuzz.json");
    } catch (const afterglow::Error&) {
        const auto& tracks = scene.tracks;
        const bool unchanged = scene.nodes.size() == original.nodes.size() &&
                               scene.meshes.size() == original.meshes.size() &&
                               scene.materials.size() == original.materials.size() &&
                               tracks.node_translation.empty() && tracks.node_rotation.empty() &&
                               tracks.material_emission.empty() && tracks.material_reflectance.empty();
        if (!unchanged) std::abort();
        return 0;
    }
    try {
        static_cast<void>(afterglow::assemble(scene));
    } catch (const afterglow::Error&) {
        // Motions that are fine one by one may still deform a shape together.
    }
    return 0;
}
