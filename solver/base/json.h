#pragma once

// The only place of the solver and the service that includes nlohmann-json: guarded parsing, and typed reads
// that know where they are.

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "solver/base/error.h"
#include "solver/base/math.h"

namespace afterglow {

using Json = nlohmann::ordered_json;

/// Parses JSON text. `source` names it in errors (a file name, or "request body").
/// Errors: invalid_input with the byte offset for malformed text; too_large where it nests deeper than 64
/// levels (no real scene comes near it, and unbounded nesting would exhaust the stack of whoever walks the
/// value).
Json parse_json(std::string_view text, const std::string& source);

/// A JSON value together with its place ("file#/json/pointer"), so that every failed read names the field.
/// A view: the document must outlive it. Thread-safety: const reads of an unchanged document.
class JsonView {
  public:
    JsonView(const Json& value, std::string source) : value_(&value), source_(std::move(source)) {}

    [[nodiscard]] const Json& value() const { return *value_; }
    /// "source#/pointer", or "source" at the root.
    [[nodiscard]] std::string place() const;
    /// The JSON pointer alone (RFC 6901), empty at the root.
    [[nodiscard]] const std::string& pointer() const { return pointer_; }
    /// Throws Error{invalid_input} at this place.
    [[noreturn]] void fail(const std::string& message) const;

    /// The member `key`, or an error that names it.
    [[nodiscard]] JsonView at(std::string_view key) const;
    [[nodiscard]] std::optional<JsonView> find(std::string_view key) const;
    /// The elements of an array, in order.
    [[nodiscard]] std::vector<JsonView> elements() const;
    /// The members of an object, in file order.
    [[nodiscard]] std::vector<std::pair<std::string, JsonView>> members() const;
    /// Fails at the first member whose key is not listed, so that misspelt options are never silently
    /// ignored.
    void allow_only(std::initializer_list<std::string_view> keys) const;

    // Typed reads; each fails with what was expected and what was found.
    [[nodiscard]] std::string as_string() const;
    [[nodiscard]] bool as_bool() const;
    [[nodiscard]] double as_number() const;                            ///< finite
    [[nodiscard]] double as_number_in(double low, double high) const;  ///< low ≤ value ≤ high
    [[nodiscard]] std::int64_t as_integer_in(std::int64_t low, std::int64_t high) const;
    [[nodiscard]] Index as_index(std::size_t size) const;  ///< 0 ≤ value < size
    [[nodiscard]] std::vector<double> as_numbers(
        std::size_t count) const;  ///< an array of exactly `count` finite numbers
    [[nodiscard]] Vec3 as_vec3() const;

  private:
    const Json* value_;
    std::string source_;
    std::string pointer_;
};

}  // namespace afterglow
