#include "solver/radiosity/roles.h"

#include <string>
#include <string_view>

#include "solver/base/error.h"

namespace afterglow {

namespace {

void check_size(std::size_t size, std::size_t patches, std::string_view field) {
    if (size != 0 && size != patches)
        throw Error(ErrorKind::invalid_input, std::string(field),
                    "has " + std::to_string(size) + " values for " + std::to_string(patches) + " patches");
}

void check_numbers(std::span<const Index> numbers, std::size_t patches, std::string_view field) {
    check_size(numbers.size(), patches, field);
    for (std::size_t i = 0; i < numbers.size(); ++i)
        if (numbers[i] >= patches)
            throw Error(ErrorKind::invalid_input, std::string(field),
                        "patch " + std::to_string(i) + " has number " + std::to_string(numbers[i]) +
                            ", which must be below the number of patches");
}

}  // namespace

void check(const PatchRoles& roles, std::size_t patches) {
    check_size(roles.seen.size(), patches, "seen patches");
    check_size(roles.moving.size(), patches, "moving patches");
    check_numbers(roles.object, patches, "objects of patches");
    check_numbers(roles.surface, patches, "surfaces of patches");
}

}  // namespace afterglow
