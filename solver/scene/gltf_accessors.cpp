#include "solver/scene/gltf_accessors.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace afterglow::gltf {

static_assert(std::endian::native == std::endian::little, "glTF buffers are little-endian");

namespace {

/// No offset or count of a readable file comes near it, and products with a stride still fit 64 bits.
constexpr std::int64_t max_offset = std::int64_t{1} << 40U;

enum class Component {
    int8 = 5120,
    uint8 = 5121,
    int16 = 5122,
    uint16 = 5123,
    uint32 = 5125,
    float32 = 5126
};

/// What an accessor says about itself.
struct Layout {
    JsonView accessor;
    Component component;
    bool normalised;
    std::size_t components;
    std::size_t count;

    [[nodiscard]] std::size_t element_bytes() const;
};

std::size_t bytes_of(Component component) {
    switch (component) {
        case Component::int8:
        case Component::uint8:
            return 1;
        case Component::int16:
        case Component::uint16:
            return 2;
        case Component::uint32:
        case Component::float32:
            return 4;
    }
    return 4;
}

std::size_t Layout::element_bytes() const {
    return bytes_of(component) * components;
}

std::size_t as_size(const JsonView& view) {
    return static_cast<std::size_t>(view.as_integer_in(0, max_offset));
}

std::size_t size_or(const JsonView& view, std::string_view key, std::size_t otherwise) {
    const auto member = view.find(key);
    return member ? as_size(*member) : otherwise;
}

Component component_of(const JsonView& view) {
    const JsonView type = view.at("componentType");
    const auto number = type.as_integer_in(0, 65535);
    for (const Component known : {Component::int8, Component::uint8, Component::int16, Component::uint16,
                                  Component::uint32, Component::float32})
        if (number == static_cast<std::int64_t>(known)) return known;
    type.fail("unknown component type " + std::to_string(number));
}

std::size_t components_of(const JsonView& accessor) {
    const JsonView type = accessor.at("type");
    const std::string text = type.as_string();
    if (text == "SCALAR") return 1;
    if (text == "VEC2") return 2;
    if (text == "VEC3") return 3;
    if (text == "VEC4" || text == "MAT2") return 4;
    if (text == "MAT3") return 9;
    if (text == "MAT4") return 16;
    type.fail("unknown accessor type " + in_quotes(text));
}

Layout layout_of(const Document& document, const JsonView& reference, std::size_t components) {
    const JsonView& accessor = document.accessors[reference.as_index(document.accessors.size())];
    const auto normalised = accessor.find("normalized");
    Layout layout{accessor, component_of(accessor), normalised && normalised->as_bool(),
                  components_of(accessor), as_size(accessor.at("count"))};
    if (layout.components != components)
        reference.fail("refers to an accessor of " + std::to_string(layout.components) +
                       " numbers an element where " + std::to_string(components) + " are expected");
    if (!accessor.find("bufferView") && layout.count > max_zero_elements)
        throw Error(ErrorKind::too_large, accessor.place(),
                    "an accessor without data has " + std::to_string(layout.count) + " elements");
    return layout;
}

std::size_t stride_of(const JsonView& view, std::size_t element_bytes) {
    const auto field = view.find("byteStride");
    if (!field) return element_bytes;
    const auto stride = static_cast<std::size_t>(field->as_integer_in(0, 65535));
    if (stride < element_bytes)
        field->fail("the stride is smaller than an element of the accessor that uses it");
    return stride;
}

/// Elements at equal distances, known to lie inside their buffer view.
struct Run {
    const char* first;
    std::size_t stride;
    std::size_t count;

    [[nodiscard]] const char* at(std::size_t i) const { return first + i * stride; }
};

/// Finds `count` elements of `element_bytes` through the fields "bufferView" and "byteOffset" of `source`.
Run locate(const Document& document, const JsonView& source, std::size_t count, std::size_t element_bytes) {
    const JsonView reference = source.at("bufferView");
    const std::string_view bytes = buffer_view_bytes(document, reference);
    const JsonView& view = document.buffer_views[reference.as_index(document.buffer_views.size())];
    const std::size_t stride = stride_of(view, element_bytes);
    const std::size_t offset = size_or(source, "byteOffset", 0);
    // All three factors are bounded (2^40, 2^40, 2^16), so nothing here can wrap.
    if (count > 0 && offset + stride * (count - 1) + element_bytes > bytes.size())
        source.fail("the accessor reaches past its buffer view: " + std::to_string(count) +
                    " elements do not fit into " + std::to_string(bytes.size()) + " bytes");
    return {bytes.data() + (count > 0 ? offset : 0), stride, count};
}

template <class T>
T load(const char* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof value);
    return value;
}

/// Normalised integers as the glTF 2.0 specification, section 3.6.2.2, maps them: the most negative one is
/// clamped to -1.
template <class T>
float integer(const char* bytes, bool normalised) {
    const auto value = static_cast<float>(load<T>(bytes));
    if (!normalised) return value;
    return std::max(value / static_cast<float>(std::numeric_limits<T>::max()), -1.0F);
}

float number(Component component, bool normalised, const char* bytes) {
    switch (component) {
        case Component::int8:
            return integer<std::int8_t>(bytes, normalised);
        case Component::uint8:
            return integer<std::uint8_t>(bytes, normalised);
        case Component::int16:
            return integer<std::int16_t>(bytes, normalised);
        case Component::uint16:
            return integer<std::uint16_t>(bytes, normalised);
        case Component::uint32:
            return integer<std::uint32_t>(bytes, normalised);
        case Component::float32:
            return load<float>(bytes);
    }
    return 0;
}

Index unsigned_integer(const JsonView& place, Component component, const char* bytes) {
    if (component == Component::uint8) return load<std::uint8_t>(bytes);
    if (component == Component::uint16) return load<std::uint16_t>(bytes);
    if (component == Component::uint32) return load<std::uint32_t>(bytes);
    place.fail("indices must be unsigned integers");
}

/// Positions of the entries that a sparse accessor replaces.
std::vector<Index> sparse_positions(const Document& document, const JsonView& sparse, std::size_t count) {
    const JsonView indices = sparse.at("indices");
    const Component component = component_of(indices);
    const Run run = locate(document, indices, as_size(sparse.at("count")), bytes_of(component));
    std::vector<Index> out(run.count);
    for (std::size_t i = 0; i < run.count; ++i) {
        out[i] = unsigned_integer(indices, component, run.at(i));
        if (out[i] >= count) indices.fail("a sparse index is out of range");
    }
    return out;
}

/// Calls `store(position, bytes)` for every element with data, sparse replacements last. `make_room` is
/// called before, once the size is known to be honest.
template <class MakeRoom, class Store>
void read_elements(const Document& document, const Layout& layout, const MakeRoom& make_room,
                   const Store& store) {
    Run run{};
    if (layout.accessor.find("bufferView"))
        run = locate(document, layout.accessor, layout.count, layout.element_bytes());
    make_room();
    for (std::size_t i = 0; i < run.count; ++i) store(i, run.at(i));
    const auto sparse = layout.accessor.find("sparse");
    if (!sparse) return;
    const std::vector<Index> positions = sparse_positions(document, *sparse, layout.count);
    const Run values = locate(document, sparse->at("values"), positions.size(), layout.element_bytes());
    for (std::size_t i = 0; i < values.count; ++i) store(positions[i], values.at(i));
}

}  // namespace

std::string_view buffer_view_bytes(const Document& document, const JsonView& reference) {
    const JsonView& view = document.buffer_views[reference.as_index(document.buffer_views.size())];
    const std::string_view buffer = document.buffers[view.at("buffer").as_index(document.buffers.size())];
    const std::size_t offset = size_or(view, "byteOffset", 0);
    const std::size_t length = as_size(view.at("byteLength"));
    if (offset + length > buffer.size())
        view.fail("the buffer view reaches past its buffer of " + std::to_string(buffer.size()) + " bytes");
    return buffer.substr(offset, length);
}

std::size_t element_count(const Document& document, const JsonView& reference) {
    const JsonView& accessor = document.accessors[reference.as_index(document.accessors.size())];
    return as_size(accessor.at("count"));
}

std::vector<float> read_floats(const Document& document, const JsonView& reference, std::size_t components) {
    const Layout layout = layout_of(document, reference, components);
    std::vector<float> out;
    const auto store = [&](std::size_t position, const char* bytes) {
        for (std::size_t c = 0; c < components; ++c) {
            const float value =
                number(layout.component, layout.normalised, bytes + c * bytes_of(layout.component));
            if (!std::isfinite(value))
                layout.accessor.fail("element " + std::to_string(position) + " is not a finite number");
            out[position * components + c] = value;
        }
    };
    read_elements(
        document, layout, [&] { out.resize(layout.count * components); }, store);
    return out;
}

std::vector<Index> read_indices(const Document& document, const JsonView& reference) {
    const Layout layout = layout_of(document, reference, 1);
    std::vector<Index> out;
    const auto store = [&](std::size_t position, const char* bytes) {
        out[position] = unsigned_integer(layout.accessor, layout.component, bytes);
    };
    read_elements(
        document, layout, [&] { out.resize(layout.count); }, store);
    return out;
}

}  // namespace afterglow::gltf
