#include "solver/scene/gltf_materials.h"

#include <array>
#include <string>
#include <utility>

namespace afterglow::gltf {

namespace {

struct BaseColour {
    Rgb colour{1};
    double alpha = 1;
    double metallic = 0;
    std::optional<JsonView> texture;
};

Rgb colour_of(const JsonView& view, std::size_t components) {
    const auto numbers = view.as_numbers(components);
    for (const double number : numbers)
        if (number < 0) view.fail("a colour must not be negative");
    return {to_float(view, numbers[0]), to_float(view, numbers[1]), to_float(view, numbers[2])};
}

double factor_or(const JsonView& element, std::string_view key, double otherwise) {
    const auto member = element.find(key);
    return member ? member->as_number_in(0, 1) : otherwise;
}

void read_colour_and_alpha(const std::optional<JsonView>& factor, BaseColour& out) {
    if (!factor) return;
    out.colour = colour_of(*factor, 4);
    out.alpha = factor->as_numbers(4)[3];
}

BaseColour base_colour_of(const JsonView& material) {
    BaseColour out;
    if (const auto specular = extension_of(material, "KHR_materials_pbrSpecularGlossiness")) {
        read_colour_and_alpha(specular->find("diffuseFactor"), out);
        out.texture = specular->find("diffuseTexture");
    } else if (const auto pbr = material.find("pbrMetallicRoughness")) {
        read_colour_and_alpha(pbr->find("baseColorFactor"), out);
        out.texture = pbr->find("baseColorTexture");
        out.metallic = factor_or(*pbr, "metallicFactor", 1);
    } else {
        out.metallic = 1;  // the specification's default
    }
    return out;
}

double transmission_of(const JsonView& material) {
    const auto transmission = extension_of(material, "KHR_materials_transmission");
    return transmission ? factor_or(*transmission, "transmissionFactor", 0) : 0;
}

/// Why a surface lets so much light through that it is better left out; empty where it does not.
std::string reason_for_opening(const JsonView& material, double alpha) {
    if (transmission_of(material) > 0.5) return "transmits more than half of the light";
    const auto mode = material.find("alphaMode");
    const std::string text = mode ? mode->as_string() : "OPAQUE";
    if (text == "OPAQUE") return "";
    if (text == "BLEND") return alpha < 0.5 ? "is more than half transparent" : "";
    if (text == "MASK") return alpha < number_or(material, "alphaCutoff", 0.5) ? "is masked out" : "";
    mode->fail("unknown alpha mode " + in_quotes(text));
}

/// What about a solid material is more than a diffuse surface can show; empty where nothing is.
std::string unshown_traits(const JsonView& material, const BaseColour& base) {
    std::string out;
    const auto add = [&](const std::string& trait) { out += (out.empty() ? "" : ", ") + trait; };
    if (base.metallic > 0) add("metallic");
    if (transmission_of(material) > 0) add("transmissive");
    const auto mode = material.find("alphaMode");
    if (mode && mode->as_string() != "OPAQUE") add("transparent in parts");
    constexpr std::array<std::pair<std::string_view, std::string_view>, 6> extensions{{
        {"KHR_materials_unlit", "unlit"},
        {"KHR_materials_clearcoat", "clear-coated"},
        {"KHR_materials_sheen", "with sheen"},
        {"KHR_materials_iridescence", "iridescent"},
        {"KHR_materials_anisotropy", "anisotropic"},
        {"KHR_materials_pbrSpecularGlossiness", "glossy"},
    }};
    for (const auto& [extension, trait] : extensions)
        if (extension_of(material, extension)) add(std::string(trait));
    return out;
}

Rgb emission_of(const JsonView& material, TextureReader& textures, Warnings& warnings) {
    const auto factor = material.find("emissiveFactor");
    if (!factor) return Rgb(0);
    Rgb emission = colour_of(*factor, 3);
    if (const auto strength = extension_of(material, "KHR_materials_emissive_strength")) {
        const double times = number_or(*strength, "emissiveStrength", 1);
        if (times < 0) strength->fail("the emissive strength must not be negative");
        for (int c = 0; c < 3; ++c) emission[c] = to_float(*strength, double{emission[c]} * times);
    }
    const auto texture = material.find("emissiveTexture");
    if (texture && max_channel(emission) > 0) {
        emission *= textures.mean_colour(*texture);
        warnings.push_back(
            {texture->place(), "emission by a picture: the surface shines evenly in its mean colour"});
    }
    return emission;
}

class MaterialReader {
  public:
    MaterialReader(const Document& document, Scene& scene) : scene_(scene), textures_(document, scene) {}

    Surface read(const JsonView& element, std::size_t position) {
        const BaseColour base = base_colour_of(element);
        Material material;
        material.name = name_of(element, "material", position);
        material.reflectance = base.colour;
        material.emission = emission_of(element, textures_, scene_.warnings);
        const auto double_sided = element.find("doubleSided");
        if (double_sided && double_sided->as_bool()) material.shines = Material::Shines::both;

        Surface surface;
        const std::string opening = reason_for_opening(element, base.alpha);
        // What emits is a lamp before it is a pane: leaving it out could leave a scene dark.
        if (!opening.empty() && max_channel(material.emission) <= 0) {
            surface.kind = Surface::Kind::opening;
            warn(element, material, opening + ": its triangles are left out as openings");
        } else {
            if (base.texture) surface.base_colour = textures_.read(*base.texture);
            if (surface.base_colour) material.texture = surface.base_colour->texture;
            const std::string traits = unshown_traits(element, base);
            if (!traits.empty())
                warn(element, material,
                     "is not diffuse (" + traits + "): shown as a diffuse surface of its base colour");
        }
        scene_.materials.push_back(std::move(material));
        return surface;
    }

  private:
    void warn(const JsonView& element, const Material& material, const std::string& what) {
        scene_.warnings.push_back({element.place(), "the material " + in_quotes(material.name) + " " + what});
    }

    Scene& scene_;
    TextureReader textures_;
};

}  // namespace

std::vector<Surface> read_materials(const Document& document, Scene& scene) {
    MaterialReader reader(document, scene);
    std::vector<Surface> surfaces;
    surfaces.reserve(document.materials.size());
    for (std::size_t i = 0; i < document.materials.size(); ++i)
        surfaces.push_back(reader.read(document.materials[i], i));
    return surfaces;
}

}  // namespace afterglow::gltf
