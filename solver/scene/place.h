#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "solver/scene/resources.h"

namespace afterglow {

/// How errors and warnings name an element of a scene: mesh "chair", or mesh 3 where it has no name.
inline std::string place_of(std::string_view kind, std::string_view name, std::size_t index) {
    std::string out(kind);
    return name.empty() ? out + " " + std::to_string(index) : out + " " + in_quotes(name);
}

}  // namespace afterglow
