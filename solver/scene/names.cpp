#include "solver/scene/names.h"

#include <algorithm>
#include <numeric>

#include "solver/scene/resources.h"

namespace afterglow {

namespace {

constexpr std::size_t shown = 5;

std::string list_of(const std::vector<std::string>& names) {
    std::string out;
    for (std::size_t k = 0; k < std::min(shown, names.size()); ++k)
        out += (k == 0 ? "" : ", ") + in_quotes(names[k]);
    return out;
}

}  // namespace

int edit_distance(std::string_view a, std::string_view b) {
    a = a.substr(0, 64);
    b = b.substr(0, 64);
    std::vector<int> row(b.size() + 1);
    std::iota(row.begin(), row.end(), 0);
    for (std::size_t i = 0; i < a.size(); ++i) {
        int diagonal = row[0]++;
        for (std::size_t j = 0; j < b.size(); ++j) {
            const int replaced = diagonal + (a[i] == b[j] ? 0 : 1);
            diagonal = row[j + 1];
            row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
        }
    }
    return row.back();
}

std::string suggestion(std::string_view name, const std::vector<std::string>& names) {
    if (names.empty()) return "";
    const int furthest = std::max(2, static_cast<int>(std::min<std::size_t>(name.size(), 64)) / 3);
    std::vector<std::pair<int, std::string>> near;
    for (const auto& other : names)
        if (const int distance = edit_distance(name, other); distance <= furthest)
            near.emplace_back(distance, other);
    std::stable_sort(near.begin(), near.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    if (near.empty()) return "; there are " + list_of(names) + (names.size() > shown ? " and others" : "");
    std::vector<std::string> likely;
    likely.reserve(near.size());
    for (auto& [distance, other] : near) likely.push_back(std::move(other));
    return "; did you mean " + list_of(likely) + "?";
}

void Names::add(const std::string& name) {
    const auto index = static_cast<Index>(names_.size());
    names_.push_back(name);
    const auto [known, is_new] = places_.try_emplace(name, Place{index, no_index});
    if (!is_new && known->second.second == no_index) known->second.second = index;
}

Index Names::find(const JsonView& view) const {
    const std::string name = view.as_string();
    const auto place = places_.find(name);
    if (place == places_.end())
        view.fail("there is no " + kind_ + " " + in_quotes(name) + suggestion(name, names_));
    const auto [first, second] = place->second;
    if (second != no_index)
        view.fail("more than one " + kind_ + " is named " + in_quotes(name) + ": numbers " +
                  std::to_string(first) + " and " + std::to_string(second) +
                  "; give them names of their own");
    return first;
}

}  // namespace afterglow
