#include "solver/scene/gltf_textures.h"

#include <cmath>
#include <utility>

#include "solver/base/pixels.h"
#include "solver/scene/gltf_accessors.h"
#include "solver/scene/texture.h"

namespace afterglow::gltf {

namespace {

constexpr std::int64_t max_coordinate_sets = 64;
constexpr std::int64_t repeat = 10497;  // GL_REPEAT

Vec2 vec2_or(const JsonView& element, std::string_view key, const Vec2& otherwise) {
    const auto member = element.find(key);
    if (!member) return otherwise;
    const auto numbers = member->as_numbers(2);
    return {to_float(*member, numbers[0]), to_float(*member, numbers[1])};
}

bool repeats(const Document& document, const JsonView& texture) {
    const auto reference = texture.find("sampler");
    if (!reference) return true;
    const JsonView& sampler = document.samplers[reference->as_index(document.samplers.size())];
    return number_or(sampler, "wrapS", repeat) == repeat && number_or(sampler, "wrapT", repeat) == repeat;
}

Index coordinate_set(const JsonView& element, Index otherwise) {
    const auto set = element.find("texCoord");
    return set ? static_cast<Index>(set->as_integer_in(0, max_coordinate_sets)) : otherwise;
}

void read_transform(const JsonView& texture_info, TextureUse& use) {
    const auto transform = extension_of(texture_info, "KHR_texture_transform");
    if (!transform) return;
    use.offset = vec2_or(*transform, "offset", use.offset);
    use.scale = vec2_or(*transform, "scale", use.scale);
    use.rotation = to_float(*transform, number_or(*transform, "rotation", 0));
    use.coordinates = coordinate_set(*transform, use.coordinates);
}

}  // namespace

Vec2 TextureUse::transformed(const Vec2& uv) const {
    // The matrix of KHR_texture_transform: v points down, so a counter-clockwise turn has its sines swapped.
    const Vec2 scaled = scale * uv;
    const float c = std::cos(rotation);
    const float s = std::sin(rotation);
    return offset + Vec2(c * scaled.x + s * scaled.y, -s * scaled.x + c * scaled.y);
}

std::optional<Index> TextureReader::picture_of(const JsonView& texture_info) {
    const JsonView& texture =
        document_.textures[texture_info.at("index").as_index(document_.textures.size())];
    if (const auto source = texture.find("source")) return source->as_index(document_.images.size());
    scene_.warnings.push_back(
        {texture_info.place(), "the texture has no PNG or JPEG picture; the plain colour is used"});
    return std::nullopt;
}

Texture TextureReader::decode(Index picture) {
    const JsonView& image = document_.images[picture];
    std::string content;
    std::string_view bytes;
    if (const auto view = image.find("bufferView")) {
        bytes = buffer_view_bytes(document_, *view);
    } else {
        content = resolve_uri(document_, image.at("uri"));
        bytes = content;
    }
    Bytes8 pixels = decode_picture(bytes, image.place());
    texels_ += pixels.rgba.size() / 4;
    if (texels_ > max_texels)
        throw Error(ErrorKind::too_large, image.place(), "the textures have more than 128 Mi pixels in all");
    return {name_of(image, "picture", picture), pixels.width, pixels.height, std::move(pixels.rgba)};
}

std::optional<TextureUse> TextureReader::read(const JsonView& texture_info) {
    const auto picture = picture_of(texture_info);
    if (!picture) return std::nullopt;
    auto known = decoded_.find(*picture);
    if (known == decoded_.end()) {
        scene_.textures.push_back(decode(*picture));
        known = decoded_.emplace(*picture, static_cast<Index>(scene_.textures.size() - 1)).first;
    }
    TextureUse use;
    use.texture = known->second;
    use.coordinates = coordinate_set(texture_info, 0);
    use.repeats =
        repeats(document_, document_.textures[texture_info.at("index").as_index(document_.textures.size())]);
    read_transform(texture_info, use);
    return use;
}

Rgb TextureReader::mean_colour(const JsonView& texture_info) {
    const auto picture = picture_of(texture_info);
    if (!picture) return Rgb(1);
    const auto known = means_.find(*picture);
    if (known != means_.end()) return known->second;
    const Rgb mean = afterglow::mean_colour(decode(*picture));
    means_.emplace(*picture, mean);
    return mean;
}

}  // namespace afterglow::gltf
