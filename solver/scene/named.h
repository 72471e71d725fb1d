#pragma once

#include <string>

#include "solver/base/error.h"
#include "solver/base/math.h"

namespace afterglow {

/// The number of the element with a given name, from `first` on. Errors: not_found, listing the names.
template <class Elements>
Index index_named(const Elements& elements, Index first, const std::string& name, const char* kind) {
    std::string names;
    for (Index k = first; k < elements.size(); ++k) {
        if (elements[k].name == name) return k;
        names += (names.empty() ? "" : ", ") + elements[k].name;
    }
    throw Error(ErrorKind::not_found, kind,
                "there is no " + std::string(kind) + " \"" + name + "\"; there are: " + names);
}

}  // namespace afterglow
