#include "solver/scene/gltf_lights.h"

#include <string>
#include <utility>

namespace afterglow::gltf {

namespace {

constexpr double lumens_per_watt = 683;

Light::Kind kind_of(const JsonView& element) {
    const JsonView type = element.at("type");
    const std::string text = type.as_string();
    if (text == "point") return Light::Kind::point;
    if (text == "spot") return Light::Kind::spot;
    if (text == "directional") return Light::Kind::directional;
    type.fail("unknown kind of light " + in_quotes(text));
}

void read_cone(const JsonView& element, Light& light) {
    const JsonView spot = element.at("spot");
    const double inner = number_or(spot, "innerConeAngle", 0);
    const double outer = number_or(spot, "outerConeAngle", double{pi} / 4);
    // Blender rounds its widest cone to single precision, a little above π/2.
    if (inner < 0 || inner > outer || outer <= 0 || outer > double{pi} / 2 + 1e-6)
        spot.fail("the cone angles must satisfy 0 <= inner <= outer <= pi/2");
    light.inner_cone_angle = static_cast<float>(inner);
    light.outer_cone_angle = static_cast<float>(outer);
}

Light read_light(const JsonView& element, std::size_t position, double divisor) {
    Light light;
    light.name = name_of(element, "light", position);
    light.kind = kind_of(element);
    const auto colour = element.find("color");
    const auto channels = colour ? colour->as_numbers(3) : std::vector<double>{1, 1, 1};
    const double intensity = number_or(element, "intensity", 1) / divisor;
    for (int c = 0; c < 3; ++c) {
        const double value = channels[static_cast<std::size_t>(c)] * intensity;
        if (value < 0) element.fail("a light must not be negative");
        light.intensity[c] = to_float(element, value);
    }
    if (light.kind == Light::Kind::spot) read_cone(element, light);
    return light;
}

bool says_blender(const Document& document) {
    const auto generator = document.root().at("asset").find("generator");
    return generator && generator->as_string().find("Blender") != std::string::npos;
}

}  // namespace

std::vector<Index> read_cameras(const Document& document, Scene& scene) {
    std::vector<Index> places;
    for (std::size_t i = 0; i < document.cameras.size(); ++i) {
        const JsonView& element = document.cameras[i];
        Camera camera;
        camera.name = name_of(element, "camera", i);
        const JsonView type = element.at("type");
        if (type.as_string() == "orthographic") {
            scene.warnings.push_back({element.place(), "the camera " + in_quotes(camera.name) +
                                                           " is orthographic and is left out"});
            places.push_back(no_index);
            continue;
        }
        if (type.as_string() != "perspective")
            type.fail("unknown kind of camera " + in_quotes(type.as_string()));
        const JsonView angle = element.at("perspective").at("yfov");
        camera.vertical_angle = static_cast<float>(angle.as_number());
        if (!(camera.vertical_angle > 0 && camera.vertical_angle < pi))
            angle.fail("the vertical angle must lie between 0 and pi");
        places.push_back(static_cast<Index>(scene.cameras.size()));
        scene.cameras.push_back(std::move(camera));
    }
    return places;
}

void read_lights(const Document& document, LumenScale scale, Scene& scene) {
    const auto extension = extension_of(document.root(), "KHR_lights_punctual");
    if (!extension) return;
    const auto elements = extension->at("lights").elements();
    const bool divide =
        scale == LumenScale::divide || (scale == LumenScale::automatic && says_blender(document));
    if (divide && !elements.empty())
        scene.warnings.push_back({extension->place(),
                                  "punctual lights are divided by 683 lm/W, which Blender's export "
                                  "multiplies them by"});
    for (std::size_t i = 0; i < elements.size(); ++i)
        scene.lights.push_back(read_light(elements[i], i, divide ? lumens_per_watt : 1));
}

}  // namespace afterglow::gltf
