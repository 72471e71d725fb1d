#pragma once

#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "solver/base/json.h"

namespace afterglow {

/// How many single-letter changes (insert, delete, replace) turn one word into the other; both are cut to 64
/// letters first. Source: Levenshtein 1966.
int edit_distance(std::string_view a, std::string_view b);

/// Up to five of `names` that are like `name`, the nearest first, or the first five where none is like it:
/// "did you mean …?" or "there are …". Empty without names.
std::string suggestion(std::string_view name, const std::vector<std::string>& names);

/// Finds elements by name. A copy of the names at the time it is made.
class Names {
  public:
    /// `kind`: what the elements are, for errors ("node").
    template <class Element>
    Names(const std::vector<Element>& elements, std::string kind) : kind_(std::move(kind)) {
        for (const auto& element : elements) add(element.name);
    }

    /// Counts a further element.
    void add(const std::string& name);

    /// The one element that a document means by the string in `view`.
    /// Errors: invalid_input at the view's place for a name that nothing or more than one element has; the
    /// message lists near names, or the elements that share it.
    [[nodiscard]] Index find(const JsonView& view) const;

    /// True where at least one element has the name.
    [[nodiscard]] bool contains(const std::string& name) const { return places_.count(name) > 0; }

  private:
    struct Place {
        Index first = no_index;
        Index second = no_index;  ///< of another element with the same name
    };
    std::string kind_;
    std::vector<std::string> names_;
    std::unordered_map<std::string, Place> places_;
};

}  // namespace afterglow
