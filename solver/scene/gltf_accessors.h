#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "solver/scene/gltf_document.h"

namespace afterglow::gltf {

/// The bytes of the buffer view that `reference` (an index in the file) names.
/// Errors: invalid_input where the view reaches past its buffer.
std::string_view buffer_view_bytes(const Document& document, const JsonView& reference);

/// Number of elements of the accessor that `reference` names, before any of them is read.
std::size_t element_count(const Document& document, const JsonView& reference);

/// All elements of an accessor of `components` numbers each (1 to 4), one after another. Normalised integers
/// become fractions, other integers keep their value; sparse entries are applied.
/// Errors: invalid_input for an accessor of another shape, one that reaches past its buffer view, or a number
/// that is NaN or infinite; too_large for more than max_zero_elements without data.
std::vector<float> read_floats(const Document& document, const JsonView& reference, std::size_t components);

/// All elements of an accessor of unsigned integers (8, 16 or 32 bits). Errors: as read_floats.
std::vector<Index> read_indices(const Document& document, const JsonView& reference);

}  // namespace afterglow::gltf
