#include "solver/scene/gltf_meshes.h"

#include <numeric>
#include <set>
#include <string>

#include "solver/scene/gltf_accessors.h"

namespace afterglow::gltf {

namespace {

enum class Mode { points, lines, line_loop, line_strip, triangles, strip, fan };

Mode mode_of(const JsonView& primitive) {
    const auto mode = primitive.find("mode");
    return mode ? static_cast<Mode>(mode->as_integer_in(0, 6)) : Mode::triangles;
}

bool has_triangles(Mode mode) {
    return mode == Mode::triangles || mode == Mode::strip || mode == Mode::fan;
}

/// Corner `corner` of triangle `t` as a position in the list of indices.
/// Source: glTF 2.0 specification, section 3.7.2.1: odd triangles of a strip swap two corners to keep facing
/// the same way.
std::size_t corner_position(Mode mode, std::size_t t, std::size_t corner) {
    if (mode == Mode::triangles) return 3 * t + corner;
    if (mode == Mode::fan) return corner == 2 ? 0 : t + 1 + corner;
    if (corner == 0) return t;
    return t % 2 == 0 ? t + corner : t + 3 - corner;
}

class MeshReader {
  public:
    MeshReader(const Document& document, const std::vector<Surface>& surfaces, Scene& scene)
        : document_(document), surfaces_(surfaces), scene_(scene) {}

    void read(const JsonView& element, std::size_t position) {
        Mesh mesh;
        mesh.name = name_of(element, "mesh", position);
        for (const JsonView& primitive : element.at("primitives").elements()) add(primitive, mesh);
        scene_.meshes.push_back(std::move(mesh));
    }

  private:
    void add(const JsonView& primitive, Mesh& mesh) {
        const Mode mode = mode_of(primitive);
        if (!has_triangles(mode)) return warn(primitive, "points and lines have no area and are left out");
        const JsonView attributes = primitive.at("attributes");
        const auto positions = attributes.find("POSITION");
        if (!positions) return warn(primitive, "a primitive without positions is left out");
        const auto reference = primitive.find("material");
        const Index material =
            reference ? reference->as_index(document_.materials.size()) : default_material(primitive);
        if (reference && surfaces_[material].kind == Surface::Kind::opening) return;

        const std::size_t base = mesh.positions.size();
        add_positions(*positions, mesh);
        const std::size_t vertices = mesh.positions.size() - base;
        if (reference && surfaces_[material].base_colour)
            add_coordinates(primitive, attributes, *surfaces_[material].base_colour, base, mesh);
        if (!mesh.texture_coordinates.empty())
            mesh.texture_coordinates.resize(mesh.positions.size(), Vec2(0));
        add_triangles(primitive, mode, base, vertices, material, mesh);

        if (attributes.find("COLOR_0")) warn(primitive, "vertex colours are left out");
        if (attributes.find("JOINTS_0")) warn(primitive, "the skin is shown in its rest pose");
        if (primitive.find("targets")) warn(primitive, "morph targets are left out; the base shape is shown");
    }

    void add_positions(const JsonView& reference, Mesh& mesh) {
        const std::size_t count = element_count(document_, reference);
        if (count > max_vertices - vertices_)
            throw Error(ErrorKind::too_large, reference.place(),
                        "the meshes have more than 16 Mi vertices in all");
        vertices_ += count;
        const std::vector<float> numbers = read_floats(document_, reference, 3);
        for (std::size_t i = 0; i < count; ++i)
            mesh.positions.emplace_back(numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]);
    }

    /// Called when the positions of the primitive are already in the mesh.
    void add_coordinates(const JsonView& primitive, const JsonView& attributes, const TextureUse& use,
                         std::size_t base, Mesh& mesh) {
        const std::string attribute = "TEXCOORD_" + std::to_string(use.coordinates);
        const auto reference = attributes.find(attribute);
        if (!reference)
            return warn(primitive, "a textured primitive has no " + attribute + "; its corner texel is used");
        const std::size_t count = element_count(document_, *reference);
        if (count != mesh.positions.size() - base)
            reference->fail("there must be as many texture coordinates as positions");
        const std::vector<float> numbers = read_floats(document_, *reference, 2);
        mesh.texture_coordinates.resize(base, Vec2(0));
        bool inside = true;
        for (std::size_t i = 0; i < count; ++i) {
            const Vec2 uv = use.transformed({numbers[2 * i], numbers[2 * i + 1]});
            if (!is_finite({uv, 0})) reference->fail("a transformed texture coordinate is not finite");
            inside = inside && uv.x >= 0 && uv.x <= 1 && uv.y >= 0 && uv.y <= 1;
            mesh.texture_coordinates.push_back(uv);
        }
        if (!use.repeats && !inside)
            warn(primitive, "its texture is repeated where the file asks for clamping or mirroring");
    }

    void add_triangles(const JsonView& primitive, Mode mode, std::size_t base, std::size_t vertices,
                       Index material, Mesh& mesh) {
        const std::vector<Index> indices = indices_of(primitive, vertices);
        if (mode == Mode::triangles && indices.size() % 3 != 0)
            primitive.fail(std::to_string(indices.size()) + " corners do not make whole triangles");
        const std::size_t count =
            mode == Mode::triangles ? indices.size() / 3 : (indices.size() < 3 ? 0 : indices.size() - 2);
        if (count > max_triangles - triangles_)
            throw Error(ErrorKind::too_large, primitive.place(),
                        "the meshes have more than 16 Mi triangles in all");
        triangles_ += count;
        for (std::size_t t = 0; t < count; ++t) {
            Triangle triangle;
            triangle.material = material;
            for (std::size_t corner = 0; corner < 3; ++corner)
                triangle.vertices[corner] =
                    static_cast<Index>(base + indices[corner_position(mode, t, corner)]);
            mesh.triangles.push_back(triangle);
        }
    }

    /// The primitive's indices, each known to be below `vertices`; all vertices in turn where it has none.
    std::vector<Index> indices_of(const JsonView& primitive, std::size_t vertices) const {
        const auto reference = primitive.find("indices");
        if (!reference) {
            std::vector<Index> all(vertices);
            std::iota(all.begin(), all.end(), Index{0});
            return all;
        }
        if (element_count(document_, *reference) > 3 * max_triangles)
            throw Error(ErrorKind::too_large, reference->place(), "more than 16 Mi triangles");
        std::vector<Index> indices = read_indices(document_, *reference);
        for (std::size_t i = 0; i < indices.size(); ++i)
            if (indices[i] >= vertices)
                reference->fail("index " + std::to_string(indices[i]) + " at position " + std::to_string(i) +
                                " is out of range: there are " + std::to_string(vertices) + " vertices");
        return indices;
    }

    Index default_material(const JsonView& primitive) {
        if (scene_.materials.size() == document_.materials.size()) {
            scene_.materials.push_back({.name = "default", .reflectance = Rgb(default_reflectance)});
            warn(primitive, "there is geometry without a material; it reflects 0.8 of the light");
        }
        return static_cast<Index>(document_.materials.size());
    }

    /// One warning of a kind is enough: files have thousands of primitives.
    void warn(const JsonView& primitive, const std::string& message) {
        if (!said_.insert(message).second) return;
        scene_.warnings.push_back({primitive.place(), message});
    }

    const Document& document_;
    const std::vector<Surface>& surfaces_;
    Scene& scene_;
    std::set<std::string> said_;
    std::size_t vertices_ = 0;   ///< in all meshes so far
    std::size_t triangles_ = 0;  ///< in all meshes so far
};

}  // namespace

void read_meshes(const Document& document, const std::vector<Surface>& surfaces, Scene& scene) {
    MeshReader reader(document, surfaces, scene);
    for (std::size_t i = 0; i < document.meshes.size(); ++i) reader.read(document.meshes[i], i);
}

}  // namespace afterglow::gltf
