#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace afterglow {

/// A 128-bit content hash (XXH3): finds damage and tells contents apart; no defence against forgery.
struct Hash128 {
    std::uint64_t low = 0, high = 0;
    bool operator==(const Hash128&) const = default;
    [[nodiscard]] std::string hex() const;  ///< 32 lower-case digits
};

/// Hashes a sequence of values as one content. Values are hashed by their bytes, vectors with their length
/// before them.
class Hasher {
  public:
    Hasher();
    Hasher(const Hasher&) = delete;
    Hasher& operator=(const Hasher&) = delete;
    ~Hasher();

    void add_bytes(const void* data, std::size_t bytes);
    void add(std::string_view text) {
        add(std::uint64_t{text.size()});
        add_bytes(text.data(), text.size());
    }
    template <class T>
    requires std::is_trivially_copyable_v<T> &&
        (!std::is_convertible_v<T, std::string_view>)void add(const T& value) {
        add_bytes(&value, sizeof value);
    }
    template <class T>
    void add(const std::vector<T>& values) {
        static_assert(std::is_trivially_copyable_v<T>);
        add(std::uint64_t{values.size()});
        add_bytes(values.data(), values.size() * sizeof(T));
    }
    [[nodiscard]] Hash128 result() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace afterglow
