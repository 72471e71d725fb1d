#include "solver/base/hash.h"

#include <array>
#include <cstdio>

#include <xxhash.h>

namespace afterglow {

struct Hasher::State {
    XXH3_state_t* xxh = XXH3_createState();
};

Hasher::Hasher() : state_(std::make_unique<State>()) {
    XXH3_128bits_reset(state_->xxh);
}
Hasher::~Hasher() {
    XXH3_freeState(state_->xxh);
}

void Hasher::add_bytes(const void* data, std::size_t bytes) {
    if (bytes > 0) XXH3_128bits_update(state_->xxh, data, bytes);
}

Hash128 Hasher::result() const {
    const XXH128_hash_t digest = XXH3_128bits_digest(state_->xxh);
    return {digest.low64, digest.high64};
}

std::string Hash128::hex() const {
    std::array<char, 33> text{};
    std::snprintf(text.data(), text.size(), "%016llx%016llx", static_cast<unsigned long long>(high),
                  static_cast<unsigned long long>(low));
    return text.data();
}

}  // namespace afterglow
